#include "ibrdf/solvers/drawing/map_picture.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/drawing/picture.h"
#include "ibrdf/solvers/drawing/tone_map.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

constexpr double kWhite = 97.0;       // percentile
constexpr double kBlank = 0.45;       // linear grey
constexpr double kTextHeight = 10.0;  // of capitals, pixels
constexpr int kBallSamples = 4;       // a side of a pixel
// An arrow: the tangent of its angle, and the sides of its head, pixels.
constexpr double kArrowLength = 0.55;
constexpr double kHeadLength = 7.0;
constexpr Ink kRightInk = {200, 30, 30};
constexpr Ink kUpInk = {30, 60, 210};

struct Axis {
  const char* name;
  Vector3d direction;
};
const Axis kAxes[] = {{"up", {0, 1, 0}},     {"down", {0, -1, 0}},
                      {"left", {-1, 0, 0}},  {"right", {1, 0, 0}},
                      {"ahead", {0, 0, -1}}, {"behind", {0, 0, 1}}};

MapGrid GridOf(const Image& map, MapFrame frame) {
  return MapGrid(frame, {map.width, map.height});
}

// Linear display colours of the texels, in [0, 1].
cv::Mat DisplayColours(const Image& map, const MapGrid& grid) {
  const std::vector<double> angles = grid.SolidAngles();
  Mask used(map.width, map.height, 0);
  for (size_t t = 0; t < angles.size(); ++t) used.inside[t] = angles[t] > 0.0;
  const double exposure = ExposureOf(map, used, kWhite);
  cv::Mat colours(map.height, map.width, CV_32FC3);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const bool blank = !used.Holds(static_cast<size_t>(y) * map.width + x);
      for (int c = 0; c < 3; ++c) {
        const double value =
            blank ? kBlank : std::clamp(map.At(x, y)[c] * exposure, 0.0, 1.0);
        colours.at<cv::Vec3f>(y, x)[c] = static_cast<float>(value);
      }
    }
  }
  return colours;
}

Rgb8Image Encode(const cv::Mat& colours) {
  Rgb8Image out(colours.cols, colours.rows);
  for (int y = 0; y < colours.rows; ++y) {
    for (int x = 0; x < colours.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        out.At(x, y)[c] = EncodeSrgb(colours.at<cv::Vec3f>(y, x)[c]);
      }
    }
  }
  return out;
}

// Texels stay squares where they are enlarged.
cv::Mat FitTo(const cv::Mat& colours, int max_side) {
  const double fit =
      static_cast<double>(max_side) / std::max(colours.cols, colours.rows);
  const cv::Size size(std::max(1, static_cast<int>(colours.cols * fit)),
                      std::max(1, static_cast<int>(colours.rows * fit)));
  cv::Mat out;
  cv::resize(colours, out, size, 0, 0,
             fit < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  return out;
}

// The map on a page, and where its directions are there.
class AxesPicture {
 public:
  AxesPicture(const MapGrid& grid, const Rgb8Image& pixels)
      : grid_(grid),
        width_(pixels.width),
        height_(pixels.height),
        page_(pixels.width, pixels.height) {
    page_.Place(pixels, 0, 0);
  }

  void MarkAll() {
    for (const Axis& axis : kAxes) Mark(axis);
    const Vector3d ahead(0, 0, -1);
    Arrow(ahead, Vector3d(kArrowLength, 0, -1), kRightInk);
    Arrow(ahead, Vector3d(0, kArrowLength, -1), kUpInk);
  }

  Rgb8Image ToImage() const { return page_.ToImage(); }

 private:
  struct Place {
    double x, y;
  };

  Place At(const Vector3d& direction) const {
    const MapPoint point = grid_.Position(direction);
    return {point.column * width_ / grid_.size().width,
            point.row * height_ / grid_.size().height};
  }

  // A direction on the map's left or right border is on both, a pole is a whole
  // row, and straight backward is the whole rim of a probe.
  void Mark(const Axis& axis) {
    Place place = At(axis.direction);
    if (grid_.latlong().has_value() && axis.direction.y() != 0.0) {
      place.x = 0.5 * width_;
      Name(std::string(axis.name) + " (the whole row)", place);
      return;
    }
    constexpr double kBorder = 1.5;  // pixels
    const bool rim =
        grid_.frame() == MapFrame::kDebevecProbe && axis.direction.z() > 0.0;
    const bool seam = grid_.latlong().has_value() &&
                      (place.x < kBorder || place.x > width_ - kBorder);
    if (rim || seam) {
      Name(axis.name, {0.0, place.y});
      Name(axis.name, {static_cast<double>(width_), place.y});
    } else {
      Name(axis.name, place);
    }
  }

  void Name(const std::string& name, const Place& place) {
    const double half = 0.5 * Picture::TextWidth(name, kTextHeight);
    const double x = std::clamp(place.x, half + 4.0,
                                std::max(half + 4.0, width_ - half - 4.0));
    // Below the dot, where the page goes on there.
    const bool below = place.y + 2.2 * kTextHeight < height_;
    const double y = place.y + (below ? 1.9 : -0.9) * kTextHeight;
    page_.Dot(place.x, place.y, 4.0, kBlackInk);
    page_.Text(name, x, y, kTextHeight, Picture::Align::kCentre);
  }

  void Arrow(const Vector3d& from, const Vector3d& to, const Ink& ink) {
    Place a = At(from);
    const Place b = At(to);
    if (std::abs(b.x - a.x) > 0.5 * width_) a.x += b.x > a.x ? width_ : -width_;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length < 1.0) return;
    const double u = (b.x - a.x) / length, v = (b.y - a.y) / length;
    for (const double shift : {-0.5, 0.0, 0.5}) {  // a line of three
      page_.Line(a.x - shift * v, a.y + shift * u, b.x - shift * v,
                 b.y + shift * u, ink);
    }
    for (const double side : {-0.6, 0.6}) {
      page_.Line(b.x, b.y, b.x - kHeadLength * (u - side * v),
                 b.y - kHeadLength * (v + side * u), ink);
    }
  }

  const MapGrid& grid_;
  const int width_, height_;
  Picture page_;
};

// What a mirror ball shows at a place in [-1, 1]^2 inside the disc.
Vector3d Reflected(double x, double y) {
  const Vector3d n(x, y, std::sqrt(std::max(0.0, 1.0 - x * x - y * y)));
  return 2.0 * n.z() * n - Vector3d(0, 0, 1);
}

// The ball's mean colour in a pixel, and how much of it the ball covers.
std::pair<cv::Vec3d, double> BallPixel(const cv::Mat& colours,
                                       const MapGrid& grid, int px, int py,
                                       int diameter) {
  cv::Vec3d sum(0, 0, 0);
  int inside = 0;
  for (int k = 0; k < kBallSamples * kBallSamples; ++k) {
    const double u = px + (k % kBallSamples + 0.5) / kBallSamples;
    const double v = py + (k / kBallSamples + 0.5) / kBallSamples;
    const double x = 2.0 * u / diameter - 1.0, y = 1.0 - 2.0 * v / diameter;
    if (x * x + y * y >= 1.0) continue;
    const int texel = grid.TexelOf(Reflected(x, y));
    const cv::Vec3f& colour =
        colours.at<cv::Vec3f>(texel / colours.cols, texel % colours.cols);
    sum += cv::Vec3d(colour[0], colour[1], colour[2]);
    ++inside;
  }
  return {sum, inside / static_cast<double>(kBallSamples * kBallSamples)};
}

}  // namespace

Rgb8Image DrawMapAxes(const Image& map, MapFrame frame, int max_side) {
  CHECK_GT(max_side, 0);
  const MapGrid grid = GridOf(map, frame);
  AxesPicture picture(grid, Encode(FitTo(DisplayColours(map, grid), max_side)));
  picture.MarkAll();
  return picture.ToImage();
}

Rgb8Image DrawMirrorBall(const Image& map, MapFrame frame, int diameter) {
  CHECK_GT(diameter, 0);
  const MapGrid grid = GridOf(map, frame);
  const cv::Mat colours = DisplayColours(map, grid);
  Rgb8Image out(diameter, diameter);
  const double ground = DecodeSrgb(kGroundInk[0] / 255.0);
  for (int y = 0; y < diameter; ++y) {
    for (int x = 0; x < diameter; ++x) {
      const auto [sum, cover] = BallPixel(colours, grid, x, y, diameter);
      for (int c = 0; c < 3; ++c) {
        out.At(x, y)[c] = EncodeSrgb(sum[c] / (kBallSamples * kBallSamples) +
                                     (1.0 - cover) * ground);
      }
    }
  }
  return out;
}

Rgb8Image DrawMapFrame(const Image& map, MapFrame frame) {
  constexpr int kMapSide = 320, kBall = 140, kMargin = 12, kTop = 46;
  const Rgb8Image axes = DrawMapAxes(map, frame, kMapSide);
  const Rgb8Image ball = DrawMirrorBall(map, frame, kBall);
  // The captions are as wide as the longest of them.
  const std::string map_caption =
      "the map in its file; arrows point right (red) and up (blue)";
  const std::string ball_caption = "a mirror ball, as the camera sees it";
  const int map_width = std::max<int>(
      axes.width,
      static_cast<int>(Picture::TextWidth(map_caption, kTextHeight)));
  const int ball_width = std::max<int>(
      kBall, static_cast<int>(Picture::TextWidth(ball_caption, kTextHeight)));
  Picture page(map_width + ball_width + 4 * kMargin,
               kTop + std::max(axes.height, kBall) + kMargin);
  page.Text(std::string("frame ") + MapFrameName(frame), kMargin, 18, 12.0);
  page.Text(map_caption, kMargin, kTop - 8, kTextHeight, Picture::Align::kLeft,
            kGreyInk);
  page.Place(axes, kMargin, kTop);
  const int left = map_width + 3 * kMargin;
  page.Text(ball_caption, left, kTop - 8, kTextHeight, Picture::Align::kLeft,
            kGreyInk);
  page.Place(ball, left, kTop);
  return page.ToImage();
}

}  // namespace ibrdf
