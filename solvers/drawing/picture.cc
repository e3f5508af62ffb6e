#include "ibrdf/solvers/drawing/picture.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "ibrdf/solvers/drawing/tone_map.h"

namespace ibrdf {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitals = 21.0;  // height of capitals at scale 1, pixels
constexpr int kShift = 4;           // fractional bits of positions
const cv::Scalar kGround(kGroundInk[0], kGroundInk[1], kGroundInk[2]);

cv::Scalar Colour(const Ink& ink) {
  return {ink[0] * 1.0, ink[1] * 1.0, ink[2] * 1.0};
}

cv::Point Fixed(double x, double y) {
  return {static_cast<int>(std::lround(x * (1 << kShift))),
          static_cast<int>(std::lround(y * (1 << kShift)))};
}

}  // namespace

struct Picture::Canvas {
  cv::Mat pixels;  // CV_8UC3, red first
};

Picture::Picture(int width, int height) : canvas_(new Canvas) {
  CHECK(width > 0 && height > 0);
  canvas_->pixels = cv::Mat(height, width, CV_8UC3, kGround);
}

Picture::~Picture() = default;

double Picture::TextWidth(const std::string& text, double height) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, height / kCapitals, 1, &baseline).width;
}

void Picture::Text(const std::string& text, double x, double y, double height,
                   Align align, const Ink& ink) {
  const double width = TextWidth(text, height);
  if (align == Align::kCentre) x -= width / 2;
  if (align == Align::kRight) x -= width;
  const cv::Point at(static_cast<int>(std::lround(x)),
                     static_cast<int>(std::lround(y)));
  const double scale = height / kCapitals;
  cv::putText(canvas_->pixels, text, at, kFont, scale, kGround, 4, cv::LINE_AA);
  cv::putText(canvas_->pixels, text, at, kFont, scale, Colour(ink), 1,
              cv::LINE_AA);
}

void Picture::Line(double x0, double y0, double x1, double y1, const Ink& ink) {
  cv::line(canvas_->pixels, Fixed(x0, y0), Fixed(x1, y1), Colour(ink), 1,
           cv::LINE_AA, kShift);
}

void Picture::Dot(double x, double y, double radius, const Ink& ink) {
  cv::circle(canvas_->pixels, Fixed(x, y),
             static_cast<int>(std::lround(radius * (1 << kShift))), Colour(ink),
             cv::FILLED, cv::LINE_AA, kShift);
}

void Picture::Sphere(const Image& image, double x, double y, int diameter,
                     double exposure) {
  CHECK_EQ(image.width, image.height);
  // Colour times coverage, and coverage; a pixel's centre decides. What is too
  // bright to show is cut before the mean.
  const int n = image.width;
  cv::Mat fine(n, n, CV_32FC4, cv::Scalar::all(0));
  for (int v = 0; v < n; ++v) {
    for (int u = 0; u < n; ++u) {
      const double dx = 2.0 * (u + 0.5) / n - 1.0,
                   dy = 2.0 * (v + 0.5) / n - 1.0;
      if (dx * dx + dy * dy >= 1.0) continue;
      cv::Vec4f& out = fine.at<cv::Vec4f>(v, u);
      for (int c = 0; c < 3; ++c) {
        out[c] = static_cast<float>(
            std::clamp(image.At(u, v)[c] * exposure, 0.0, 1.0));
      }
      out[3] = 1.0f;
    }
  }
  cv::Mat disc;
  cv::resize(fine, disc, {diameter, diameter}, 0, 0,
             diameter < n ? cv::INTER_AREA : cv::INTER_LINEAR);
  const int left = static_cast<int>(std::lround(x - diameter / 2.0));
  const int top = static_cast<int>(std::lround(y - diameter / 2.0));
  for (int v = 0; v < diameter; ++v) {
    for (int u = 0; u < diameter; ++u) {
      const int px = left + u, py = top + v;
      const cv::Vec4f& in = disc.at<cv::Vec4f>(v, u);
      if (in[3] <= 0.0f || px < 0 || py < 0 || px >= canvas_->pixels.cols ||
          py >= canvas_->pixels.rows) {
        continue;
      }
      cv::Vec3b& out = canvas_->pixels.at<cv::Vec3b>(py, px);
      for (int c = 0; c < 3; ++c) {
        out[c] = EncodeSrgb(in[c] + (1.0 - in[3]) * DecodeSrgb(out[c] / 255.0));
      }
    }
  }
}

void Picture::Photo(const Image& image, double x, double y, int width,
                    int height) {
  CHECK(!image.empty() && width > 0 && height > 0);
  const cv::Mat whole(image.height, image.width, CV_32FC3,
                      const_cast<float*>(image.rgb.data()));
  cv::Mat resized;
  cv::resize(whole, resized, {width, height}, 0, 0,
             width < image.width ? cv::INTER_AREA : cv::INTER_NEAREST);
  const int left = static_cast<int>(std::lround(x));
  const int top = static_cast<int>(std::lround(y));
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (left + u < 0 || top + v < 0 || left + u >= canvas_->pixels.cols ||
          top + v >= canvas_->pixels.rows) {
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        canvas_->pixels.at<cv::Vec3b>(top + v, left + u)[c] =
            EncodeSrgb(resized.at<cv::Vec3f>(v, u)[c]);
      }
    }
  }
}

void Picture::Place(const Rgb8Image& image, int left, int top) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int px = left + x, py = top + y;
      if (px < 0 || py < 0 || px >= canvas_->pixels.cols ||
          py >= canvas_->pixels.rows) {
        continue;
      }
      std::copy_n(image.At(x, y), 3, canvas_->pixels.at<cv::Vec3b>(py, px).val);
    }
  }
}

void Picture::Frame(double x, double y, double width, double height,
                    int thickness, const Ink& ink) {
  for (int k = 0; k < thickness; ++k) {
    const double left = x + k, top = y + k;
    const double right = x + width - 1 - k, bottom = y + height - 1 - k;
    Line(left, top, right, top, ink);
    Line(right, top, right, bottom, ink);
    Line(right, bottom, left, bottom, ink);
    Line(left, bottom, left, top, ink);
  }
}

Rgb8Image Picture::ToImage() const {
  const cv::Mat& pixels = canvas_->pixels;
  Rgb8Image image(pixels.cols, pixels.rows);
  CHECK(pixels.isContinuous());
  std::memcpy(image.rgb.data(), pixels.data, image.rgb.size());
  return image;
}

}  // namespace ibrdf
