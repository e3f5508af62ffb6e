#include "ibrdf/solvers/report/check_picture.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/drawing/picture.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/photograph_check/check_words.h"
#include "ibrdf/solvers/report/check_panels.h"

namespace ibrdf {
namespace {

constexpr int kWidth = 1560;
constexpr int kPageMargin = 24;
constexpr int kPanelGap = 20;
constexpr int kColumns = 4;
constexpr int kPanel =
    (kWidth - 2 * kPageMargin - (kColumns - 1) * kPanelGap) / kColumns;
constexpr int kBall = 72;     // diameter of the legend's balls
constexpr int kCaption = 48;  // below a panel: two lines
constexpr int kHead = 64;
constexpr double kTitleText = 15.0, kText = 10.0;
constexpr int kLine = 20;
constexpr int kVerdictIndent = 120;
constexpr int kVerdictGap = 6;
constexpr Ink kGreenInk = {20, 130, 50};
constexpr Ink kOutlineInk = {255, 210, 0};

std::string Printable(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return out;
}

// The part of the image that is shown, in pixels.
struct Crop {
  int left = 0, top = 0, width = 0, height = 0;
};

Crop CropOf(const ObjectLook& look) {
  const Mask& object = look.silhouette;
  int left = object.width, top = object.height, right = 0, bottom = 0;
  for (int y = 0; y < object.height; ++y) {
    for (int x = 0; x < object.width; ++x) {
      const size_t i = static_cast<size_t>(y) * object.width + x;
      if (object.inside[i] == 0 && (look.mask.empty() || !look.mask.Holds(i))) {
        continue;
      }
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  }
  const int margin = std::max(2, std::max(right - left, bottom - top) / 25);
  Crop crop;
  crop.left = std::max(0, left - margin);
  crop.top = std::max(0, top - margin);
  crop.width = std::min(object.width, right + margin) - crop.left;
  crop.height = std::min(object.height, bottom + margin) - crop.top;
  return crop;
}

Image Cropped(const Image& image, const Crop& crop) {
  Image out(crop.width, crop.height);
  for (int y = 0; y < crop.height; ++y) {
    std::copy_n(image.At(crop.left, crop.top + y),
                3 * static_cast<size_t>(crop.width), out.At(0, y));
  }
  return out;
}

struct Verdict {
  std::string name;
  std::vector<std::string> lines;
};

// Where a crop lies in a cell.
struct Place {
  double x, y, scale;
  int width, height;
};

Place FitInto(const Crop& crop, double x, double y, int cell_width,
              int cell_height) {
  Place place;
  place.scale = std::min(cell_width / static_cast<double>(crop.width),
                         cell_height / static_cast<double>(crop.height));
  place.width = std::max(1, static_cast<int>(crop.width * place.scale));
  place.height = std::max(1, static_cast<int>(crop.height * place.scale));
  place.x = x;
  place.y = y;
  return place;
}

std::vector<std::string> Wrapped(const std::string& text, double width,
                                 double height) {
  std::vector<std::string> lines(1);
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    std::string* const line = &lines.back();
    const std::string longer = line->empty() ? word : *line + " " + word;
    if (!line->empty() && Picture::TextWidth(longer, height) > width) {
      lines.push_back(word);
    } else {
      *line = longer;
    }
  }
  return lines;
}

void DrawLines(const std::string& text, double x, double y, double width,
               Picture* picture, const Ink& ink = kGreyInk) {
  for (const std::string& line : Wrapped(text, width, kText)) {
    picture->Text(line, x, y, kText, Picture::Align::kLeft, ink);
    y += kLine;
  }
}

// The edges between a mask's pixels and others.
void DrawOutline(const Mask& mask, const Crop& crop, const Place& place,
                 Picture* picture) {
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < mask.width && y < mask.height &&
           mask.inside[static_cast<size_t>(y) * mask.width + x] != 0;
  };
  for (int y = crop.top; y < crop.top + crop.height; ++y) {
    for (int x = crop.left; x < crop.left + crop.width; ++x) {
      const double px = place.x + (x - crop.left) * place.scale;
      const double py = place.y + (y - crop.top) * place.scale;
      if (inside(x, y) != inside(x - 1, y)) {
        picture->Line(px, py, px, py + place.scale, kOutlineInk);
      }
      if (inside(x, y) != inside(x, y - 1)) {
        picture->Line(px, py, px + place.scale, py, kOutlineInk);
      }
    }
  }
}

// A ball as points, to read colours and light by.
Image LegendBall(bool lit) {
  constexpr int kSize = 4 * kBall;
  std::vector<ShadingPoint> points;
  for (int i = 0; i < kSize * kSize; ++i) {
    const float x = 2.0f * (i % kSize + 0.5f) / kSize - 1.0f;
    const float y = 1.0f - 2.0f * (i / kSize + 0.5f) / kSize;
    if (x * x + y * y >= 1.0f) continue;
    ShadingPoint point{};
    point.normal = {x, y, std::sqrt(1.0f - x * x - y * y)};
    point.wo = Eigen::Vector3f::UnitZ();
    point.pixel = i;
    points.push_back(point);
  }
  return lit ? LampLit(points, kSize, kSize)
             : NormalColours(points, Image(kSize, kSize));
}

// Draws a check.
class CheckDrawing {
 public:
  explicit CheckDrawing(const CheckPictureInput& input)
      : input_(input),
        check_(input.look.check),
        crop_(CropOf(input.look)),
        row_(FitInto(crop_, 0, 0, kPanel, kPanel).height),
        photograph_(ExposedPhotograph(input.radiance, input.look.mask)),
        verdicts_(Verdicts()),
        picture_(kWidth, Height()) {}

  Rgb8Image Draw() {
    picture_.Text(Printable(input_.title), kPageMargin, 36, kTitleText);
    DrawShape(kHead);
    DrawPixels(SecondRow());
    DrawVerdicts(SecondRow());
    if (!check_.normals.empty()) DrawHypotheses(ThirdRow());
    return picture_.ToImage();
  }

 private:
  static int Column(int column) {
    return kPageMargin + column * (kPanel + kPanelGap);
  }
  // Beside a flat object the verdicts are higher.
  int SecondHeight() const {
    int height = kLine;
    for (const Verdict& verdict : verdicts_) {
      height += static_cast<int>(verdict.lines.size()) * kLine + kVerdictGap;
    }
    return std::max(row_, height - kCaption);
  }
  int SecondRow() const { return kHead + row_ + kCaption + kPanelGap; }
  int ThirdRow() const {
    return SecondRow() + SecondHeight() + kCaption + kPanelGap;
  }
  static int HypothesisCell() {
    return (kWidth - 2 * kPageMargin - (kNumNormalHypotheses - 1) * kPanelGap) /
           kNumNormalHypotheses;
  }
  int HypothesisHeight() const {
    return FitInto(crop_, 0, 0, HypothesisCell(), HypothesisCell()).height;
  }
  int Height() const {
    if (check_.normals.empty()) return ThirdRow();
    return ThirdRow() + 2 * kLine + HypothesisHeight() + 4 * kLine;
  }

  Place Panel(const Image& image, int column, int top,
              const std::string& caption) {
    const Place place = FitInto(crop_, Column(column), top, kPanel, row_);
    picture_.Photo(Cropped(image, crop_), place.x, place.y, place.width,
                   place.height);
    DrawLines(caption, Column(column), top + row_ + kLine, kPanel, &picture_,
              kBlackInk);
    return place;
  }

  // How many pixels of the object a rectangle of a panel hides.
  int Hides(const Place& place, double left, double top) const {
    const Mask& object = input_.look.silhouette;
    const int size = static_cast<int>(kBall / place.scale);
    const int x0 =
        crop_.left + static_cast<int>((left - place.x) / place.scale);
    const int y0 = crop_.top + static_cast<int>((top - place.y) / place.scale);
    int hidden = 0;
    for (int y = std::max(y0, 0); y < std::min(y0 + size, object.height); ++y) {
      for (int x = std::max(x0, 0); x < std::min(x0 + size, object.width);
           ++x) {
        hidden += object.inside[static_cast<size_t>(y) * object.width + x];
      }
    }
    return hidden;
  }

  // Beside the panel where there is room, else in its emptiest corner.
  void Legend(bool lit, const Place& place) {
    double x = place.x + place.width + 6, y = place.y + place.height - kBall;
    if (place.width + 6 + kBall > kPanel) {
      int least = -1;
      for (const double left :
           {place.x + place.width - kBall - 4.0, place.x + 4.0}) {
        for (const double top :
             {place.y + place.height - kBall - 4.0, place.y + 4.0}) {
          const int hidden = Hides(place, left, top);
          if (least >= 0 && hidden >= least) continue;
          least = hidden;
          x = left;
          y = top;
        }
      }
    }
    picture_.Sphere(LegendBall(lit), x + kBall / 2.0, y + kBall / 2.0, kBall,
                    1.0);
  }

  void DrawShape(int top) {
    const int width = input_.radiance.width, height = input_.radiance.height;
    const Place place =
        Panel(photograph_, 0, top,
              check_.has_mask ? "Photograph and the mask's outline"
                              : "Photograph and the shape's outline (no mask)");
    DrawOutline(check_.has_mask ? input_.look.mask : input_.look.silhouette,
                crop_, place, &picture_);
    Legend(false, Panel(NormalColours(input_.points, photograph_), 1, top,
                        "Normals, in the colours of the ball"));
    Legend(true, Panel(LampLit(input_.points, width, height), 2, top,
                       "The shape, matte, lamp at the upper left"));
    Panel(MaskAndShape(input_.look.mask, input_.look.silhouette), 3, top,
          check_.overlap.has_value()
              ? "Mask and shape overlap by " + Format("%.3f", *check_.overlap) +
                    "; red: mask alone, blue: shape alone"
              : "The shape's silhouette (no mask)");
  }

  void DrawPixels(int top) {
    Panel(MarkedPixels(input_.look, input_.points, photograph_), 0, top, "");
    double x = Column(0), y = top + row_ + kLine;
    picture_.Text("No part:", x, y, kText);
    x += Picture::TextWidth("No part: ", kText) + 8;
    for (int k = 0; k < kNumMarks; ++k) {
      const std::string name = NameOf(static_cast<Mark>(k));
      if (x + 18 + Picture::TextWidth(name, kText) > Column(0) + kPanel) {
        x = Column(0);
        y += kLine;
      }
      float rgb[3];
      ColourOf(static_cast<Mark>(k), rgb);
      picture_.Dot(
          x + 5, y - 5, 5,
          {EncodeSrgb(rgb[0]), EncodeSrgb(rgb[1]), EncodeSrgb(rgb[2])});
      picture_.Text(name, x + 14, y, kText);
      x += 28 + Picture::TextWidth(name, kText);
    }
    Panel(ColourDeviations(check_.like_normals, input_.points,
                           input_.radiance.width, input_.radiance.height),
          1, top,
          "Colour off that of like normals: white 0, red 0.3 (log of a ratio)");
  }

  // What is said of the look, in lines that fit beside a mirror ball.
  std::vector<Verdict> Verdicts() const {
    const int columns = input_.mirror_ball.empty() ? 2 : 1;
    const int width =
        columns * (kPanel + kPanelGap) - kPanelGap - kVerdictIndent;
    std::vector<Verdict> verdicts;
    for (const CheckFinding& finding : CheckFindings(check_)) {
      verdicts.push_back(
          {finding.subject, Wrapped(Printable(finding.text), width, kText)});
    }
    return verdicts;
  }

  void DrawVerdicts(int top) {
    const double x = Column(2);
    double y = top + 14;
    for (const Verdict& verdict : verdicts_) {
      picture_.Text(verdict.name, x, y, kText);
      for (const std::string& line : verdict.lines) {
        picture_.Text(line, x + kVerdictIndent, y, kText, Picture::Align::kLeft,
                      kGreyInk);
        y += kLine;
      }
      y += kVerdictGap;
    }
    if (input_.mirror_ball.empty()) return;
    picture_.Sphere(input_.mirror_ball, Column(3) + row_ / 2.0,
                    top + row_ / 2.0, row_, 1.0);
    DrawLines("The known light in a mirror ball", Column(3), top + row_ + kLine,
              kPanel, &picture_, kBlackInk);
  }

  void DrawHypotheses(int top) {
    picture_.Text(
        "What the normals may be: each as it would look under the lamp, the "
        "most plausible first (framed). Numbers: disagreement with a surface "
        "and its outline, 0 to 1.",
        kPageMargin, top + 12, kText);
    const int cell = HypothesisCell();
    const double y = top + kLine + 8;
    const double least = check_.normals.front().disagreement;
    for (size_t k = 0; k < check_.normals.size(); ++k) {
      const NormalScore& score = check_.normals[k];
      const double x =
          kPageMargin + static_cast<double>(k) * (cell + kPanelGap);
      const Place place = FitInto(crop_, x, y, cell, cell);
      const Image normals =
          UnderHypothesis(input_.look.normal_map, score.hypothesis);
      picture_.Photo(Cropped(LampLit(normals, input_.look.mask), crop_),
                     place.x, place.y, place.width, place.height);
      // More than one are framed where they are not told apart.
      const bool best = score.disagreement - least < kToldApart;
      if (best) {
        picture_.Frame(place.x - 4, place.y - 4, place.width + 8,
                       place.height + 8, 3, kGreenInk);
      }
      const double middle = place.x + place.width / 2.0;
      const double below = y + place.height + kLine + 2;
      picture_.Text(NameOf(score.hypothesis), middle, below, kText,
                    Picture::Align::kCentre, best ? kGreenInk : kBlackInk);
      picture_.Text(Format("%.3f", score.disagreement), middle, below + kLine,
                    kText, Picture::Align::kCentre,
                    best ? kGreenInk : kGreyInk);
    }
  }

  const CheckPictureInput& input_;
  const PhotographCheck& check_;
  Crop crop_;
  int row_;  // height of a panel
  Image photograph_;
  std::vector<Verdict> verdicts_;
  Picture picture_;
};

}  // namespace

Rgb8Image DrawCheck(const CheckPictureInput& input) {
  return CheckDrawing(input).Draw();
}

}  // namespace ibrdf
