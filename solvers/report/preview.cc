#include "ibrdf/solvers/report/preview.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/drawing/tone_map.h"

namespace ibrdf {
namespace {

// Pixels of the picture.
constexpr int kMaxWidth = 1440;
constexpr int kMaxPanelHeight = 420;
constexpr int kMargin = 32;
constexpr int kGap = 28;
constexpr int kBarGap = 10;
constexpr int kBarWidth = 18;
constexpr int kBarTotal = 84;    // gap, bar and its numbers
constexpr int kAxesHeight = 25;  // ticks and names below a map
constexpr int kLabelFont = cv::FONT_HERSHEY_SIMPLEX;

const cv::Scalar kPageColour(250, 250, 250);
const cv::Scalar kInk(25, 25, 25);
const cv::Scalar kFaintInk(95, 95, 95);
constexpr uint8_t kNeutralGrey = 176;

struct TextStyle {
  double scale;
  int line_height;
  cv::Scalar colour;
};
const TextStyle kTitleStyle{0.9, 36, kInk};
const TextStyle kLabelStyle{0.55, 22, kInk};
const TextStyle kCaptionStyle{0.45, 19, kFaintInk};

int TextWidth(const std::string& text, const TextStyle& style) {
  int baseline = 0;
  return cv::getTextSize(text, kLabelFont, style.scale, 1, &baseline).width;
}

// Lines no wider than `width` where words allow.
std::vector<std::string> Wrap(const std::string& text, int width,
                              const TextStyle& style) {
  std::vector<std::string> lines;
  std::string line;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && TextWidth(longer, style) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

// `top`: of the line.
void DrawText(cv::Mat* canvas, const std::string& text, int left, int top,
              const TextStyle& style) {
  cv::putText(*canvas, text, {left, top + style.line_height * 3 / 4},
              kLabelFont, style.scale, style.colour, 1, cv::LINE_AA);
}

bool HasColourBar(PreviewPanel::Kind kind) {
  return kind == PreviewPanel::Kind::kSignedResidual ||
         kind == PreviewPanel::Kind::kDeviation;
}

double ChannelMean(const float* rgb) {
  return (static_cast<double>(rgb[0]) + rgb[1] + rgb[2]) / 3.0;
}

double ResidualRange(const PreviewPanel& panel) {
  if (panel.range > 0.0) return panel.range;
  std::vector<double> magnitudes;
  for (size_t i = 0; i < panel.image.num_pixels(); ++i) {
    const double value = std::fabs(ChannelMean(&panel.image.rgb[3 * i]));
    if (panel.mask.Holds(i) && std::isfinite(value)) {
      magnitudes.push_back(value);
    }
  }
  constexpr double kSmallest = 1e-3;  // a finer scale shows rounding
  if (magnitudes.empty()) return kSmallest;
  return std::max(Percentile(std::move(magnitudes), 98.0), kSmallest);
}

// Linear display colours in [0, 1], one per pixel of the image.
cv::Mat DisplayColours(const PreviewPanel& panel, double range) {
  const Image& image = panel.image;
  cv::Mat colours(image.height, image.width, CV_32FC3);
  const auto grey = static_cast<float>(DecodeSrgb(kNeutralGrey / 255.0));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* rgb = image.At(x, y);
      cv::Vec3f& out = colours.at<cv::Vec3f>(y, x);
      const size_t pixel = static_cast<size_t>(y) * image.width + x;
      if (!panel.mask.Holds(pixel) || std::isnan(rgb[0] + rgb[1] + rgb[2])) {
        out = {grey, grey, grey};
      } else if (HasColourBar(panel.kind)) {
        uint8_t bytes[3];
        DivergingColour(ChannelMean(rgb) / range, bytes);
        for (int c = 0; c < 3; ++c) {
          out[c] = static_cast<float>(DecodeSrgb(bytes[c] / 255.0));
        }
      } else {
        for (int c = 0; c < 3; ++c) {
          out[c] =
              static_cast<float>(std::clamp(rgb[c] * panel.exposure, 0.0, 1.0));
        }
      }
    }
  }
  return colours;
}

// The same, by `samples` in each direction one of the picture.
cv::Mat SampledColours(const PreviewPanel& panel, double range) {
  cv::Mat colours = DisplayColours(panel, range);
  if (panel.samples == 1) return colours;
  cv::Mat reduced;
  cv::resize(colours, reduced,
             {colours.cols / panel.samples, colours.rows / panel.samples}, 0, 0,
             cv::INTER_AREA);
  return reduced;
}

// CV_8UC3, red first.
cv::Mat EncodeColours(const cv::Mat& linear) {
  cv::Mat pixels(linear.size(), CV_8UC3);
  for (int y = 0; y < linear.rows; ++y) {
    for (int x = 0; x < linear.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        pixels.at<cv::Vec3b>(y, x)[c] =
            EncodeSrgb(linear.at<cv::Vec3f>(y, x)[c]);
      }
    }
  }
  return pixels;
}

Rgb8Image ToRgb8(const cv::Mat& pixels) {
  Rgb8Image image(pixels.cols, pixels.rows);
  CHECK(pixels.isContinuous());
  std::memcpy(image.rgb.data(), pixels.data, image.rgb.size());
  return image;
}

// A side of `length` pixels after reduction, at least 1.
int Reduced(int length, double factor) {
  return std::max(1, static_cast<int>(length * factor));
}

void CheckPanel(const PreviewPanel& panel) {
  CHECK(!panel.image.empty()) << panel.label;
  CHECK(panel.mask.empty() ||
        panel.mask.inside.size() == panel.image.num_pixels());
  CHECK(panel.samples >= 1 && panel.image.width >= panel.samples &&
        panel.image.height >= panel.samples);
}

// A panel ready to be placed.
struct Placed {
  cv::Mat pixels;  // CV_8UC3, red first
  std::vector<std::string> label, caption;
  PreviewPanel::Kind kind;
  double range = 0.0;
  int width = 0;  // with its colour bar and its text
};

int Widest(const std::vector<std::string>& lines, const TextStyle& style) {
  int width = 0;
  for (const std::string& line : lines) {
    width = std::max(width, TextWidth(line, style));
  }
  return width;
}

// A panel's colours at the size that fits, with what was done in words.
cv::Mat FitColours(const cv::Mat& colours, double fit, std::string* words) {
  // From here on squares are less of a distraction than blur.
  constexpr double kSquares = 3.0;
  cv::Mat fitted;
  const cv::Size size(Reduced(colours.cols, fit), Reduced(colours.rows, fit));
  const std::string from = Format("%d x %d px, ", colours.cols, colours.rows);
  if (fit >= kSquares) {
    const int factor = static_cast<int>(fit);
    cv::resize(colours, fitted, {}, factor, factor, cv::INTER_NEAREST);
    *words = from + Format("shown x%d (nearest)", factor);
    return fitted;
  }
  cv::resize(colours, fitted, size, 0, 0,
             fit > 1.0 ? cv::INTER_LINEAR : cv::INTER_AREA);
  *words = from + Format("shown at %d x %d", size.width, size.height);
  if (size == colours.size())
    *words = Format("%d x %d px", size.width, size.height);
  return fitted;
}

Placed MakePlaced(const PreviewPanel& panel, int max_width) {
  CheckPanel(panel);
  Placed placed;
  placed.kind = panel.kind;
  const bool bar = HasColourBar(panel.kind);
  if (bar) placed.range = ResidualRange(panel);
  const cv::Mat colours = SampledColours(panel, placed.range);
  double fit = std::min(static_cast<double>(max_width) / colours.cols,
                        static_cast<double>(kMaxPanelHeight) / colours.rows);
  if (panel.samples > 1) fit = std::min(fit, 1.0);
  std::string caption;
  placed.pixels = EncodeColours(FitColours(colours, fit, &caption));
  placed.width = placed.pixels.cols + (bar ? kBarTotal : 0);
  const int text_width = std::max(placed.width, max_width / 2);
  placed.label = Wrap(panel.label, text_width, kLabelStyle);
  placed.caption = Wrap(caption, text_width, kCaptionStyle);
  placed.width = std::max({placed.width, Widest(placed.label, kLabelStyle),
                           Widest(placed.caption, kCaptionStyle)});
  return placed;
}

// From -range, or from 0.
void DrawColourBar(cv::Mat* canvas, int left, int top, int height, double range,
                   bool from_zero) {
  for (int y = 0; y < height; ++y) {
    const double share = (y + 0.5) / height;
    uint8_t rgb[3];
    DivergingColour(1.0 - (from_zero ? 1.0 : 2.0) * share, rgb);
    cv::line(*canvas, {left, top + y}, {left + kBarWidth - 1, top + y},
             cv::Scalar(rgb[0], rgb[1], rgb[2]));
  }
  cv::rectangle(*canvas, {left, top, kBarWidth, height}, kFaintInk);
  const int x = left + kBarWidth + 6;
  const int line = kCaptionStyle.line_height;
  DrawText(canvas, Format(from_zero ? "%.2g" : "+%.2g", range), x, top,
           kCaptionStyle);
  if (from_zero) {
    DrawText(canvas, "0", x, top + height - line, kCaptionStyle);
    return;
  }
  DrawText(canvas, "0", x, top + height / 2 - line / 2, kCaptionStyle);
  DrawText(canvas, Format("-%.2g", range), x, top + height - line,
           kCaptionStyle);
}

// Columns where the map looks along an axis; +y is the top, -y the bottom.
void DrawMapAxes(cv::Mat* canvas, int left, int top, int width) {
  const char* const names[] = {"+z", "-x", "-z", "+x", "+z"};
  for (int i = 0; i < 5; ++i) {
    const int x = left + i * (width - 1) / 4;
    cv::line(*canvas, {x, top}, {x, top + 6}, kFaintInk);
    const int text = TextWidth(names[i], kCaptionStyle);
    const int text_left = i == 0 ? x : i == 4 ? x - text : x - text / 2;
    DrawText(canvas, names[i], text_left, top + 6, kCaptionStyle);
  }
}

struct RowLayout {
  std::vector<Placed> panels;
  int label_height = 0;
  int picture_height = 0;
  int caption_height = 0;
  int width = 0;
  int height() const { return label_height + picture_height + caption_height; }
};

RowLayout LayOut(const std::vector<PreviewPanel>& row) {
  CHECK(!row.empty());
  const int count = static_cast<int>(row.size());
  int free_width = kMaxWidth - 2 * kMargin - (count - 1) * kGap;
  for (const PreviewPanel& panel : row) {
    if (HasColourBar(panel.kind)) {
      free_width -= kBarTotal;
    }
  }
  RowLayout layout;
  size_t lines = 0;
  for (const PreviewPanel& panel : row) {
    layout.panels.push_back(MakePlaced(panel, std::max(1, free_width / count)));
    const Placed& placed = layout.panels.back();
    lines = std::max(lines, placed.label.size());
    layout.picture_height = std::max(layout.picture_height, placed.pixels.rows);
    layout.width += placed.width + (layout.panels.size() > 1 ? kGap : 0);
    const int axes = placed.kind == PreviewPanel::Kind::kMap ? kAxesHeight : 0;
    layout.caption_height = std::max(
        layout.caption_height, axes + 2 +
                                   static_cast<int>(placed.caption.size()) *
                                       kCaptionStyle.line_height);
  }
  layout.label_height =
      static_cast<int>(lines) * kLabelStyle.line_height + (lines > 0 ? 4 : 0);
  return layout;
}

// Below each other; returns where they end.
int DrawLines(cv::Mat* canvas, const std::vector<std::string>& lines, int left,
              int top, const TextStyle& style) {
  for (const std::string& line : lines) {
    DrawText(canvas, line, left, top, style);
    top += style.line_height;
  }
  return top;
}

void DrawRow(cv::Mat* canvas, const RowLayout& row, int top) {
  int left = kMargin;
  const int picture_top = top + row.label_height;
  for (const Placed& panel : row.panels) {
    // Labels stand right above their picture.
    const int label_top =
        picture_top - 4 -
        static_cast<int>(panel.label.size()) * kLabelStyle.line_height;
    DrawLines(canvas, panel.label, left, label_top, kLabelStyle);
    const cv::Rect area(left, picture_top, panel.pixels.cols,
                        panel.pixels.rows);
    panel.pixels.copyTo((*canvas)(area));
    int below = area.br().y;
    if (HasColourBar(panel.kind)) {
      DrawColourBar(canvas, area.br().x + kBarGap, picture_top, area.height,
                    panel.range, panel.kind == PreviewPanel::Kind::kDeviation);
    } else if (panel.kind == PreviewPanel::Kind::kMap) {
      DrawMapAxes(canvas, left, below, area.width);
      below += kAxesHeight;
    }
    DrawLines(canvas, panel.caption, left, below + 2, kCaptionStyle);
    left += panel.width + kGap;
  }
}

struct PageLayout {
  std::vector<std::string> title, notes;  // lines
  std::vector<RowLayout> rows;
  int width = 0;  // without margins

  int height() const {
    int height = 2 * kMargin;
    height += static_cast<int>(title.size()) * kTitleStyle.line_height;
    height += static_cast<int>(notes.size()) * kLabelStyle.line_height;
    for (const RowLayout& row : rows) height += row.height() + kGap;
    return notes.empty() ? height - kGap : height;
  }
};

PageLayout LayOutPage(const std::vector<std::vector<PreviewPanel>>& rows,
                      const std::string& title,
                      const std::vector<std::string>& notes) {
  PageLayout page;
  for (const std::vector<PreviewPanel>& row : rows) {
    page.rows.push_back(LayOut(row));
    page.width = std::max(page.width, page.rows.back().width);
  }
  const int text_width = std::max(page.width, kMaxWidth / 2);
  page.title = Wrap(title, text_width, kTitleStyle);
  for (const std::string& note : notes) {
    for (std::string& line : Wrap(note, text_width, kLabelStyle)) {
      page.notes.push_back(std::move(line));
    }
  }
  page.width = std::max({page.width, Widest(page.title, kTitleStyle),
                         Widest(page.notes, kLabelStyle)});
  return page;
}

}  // namespace

PanelPicture DrawPanel(const PreviewPanel& panel, int max_side) {
  CheckPanel(panel);
  CHECK_GT(max_side, 0);
  PanelPicture picture;
  if (HasColourBar(panel.kind)) {
    picture.range = ResidualRange(panel);
  }
  cv::Mat colours = SampledColours(panel, picture.range);
  const double fit =
      static_cast<double>(max_side) / std::max(colours.cols, colours.rows);
  if (fit < 1.0) {
    cv::Mat reduced;
    cv::resize(colours, reduced,
               {Reduced(colours.cols, fit), Reduced(colours.rows, fit)}, 0, 0,
               cv::INTER_AREA);
    colours = reduced;
  }
  picture.pixels = ToRgb8(EncodeColours(colours));
  return picture;
}

Rgb8Image ComposePanels(const std::vector<std::vector<PreviewPanel>>& rows,
                        const std::string& title,
                        const std::vector<std::string>& notes) {
  const PageLayout page = LayOutPage(rows, title, notes);
  cv::Mat canvas(page.height(), page.width + 2 * kMargin, CV_8UC3, kPageColour);
  int top = kMargin - 8;
  top = DrawLines(&canvas, page.title, kMargin, top, kTitleStyle) + 8;
  for (const RowLayout& row : page.rows) {
    DrawRow(&canvas, row, top);
    top += row.height() + kGap;
  }
  DrawLines(&canvas, page.notes, kMargin, top, kLabelStyle);
  return ToRgb8(canvas);
}

}  // namespace ibrdf
