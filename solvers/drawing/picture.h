// A page to draw on: text, lines, dots and pictures with soft edges.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"

namespace ibrdf {

// sRGB bytes.
using Ink = std::array<uint8_t, 3>;
inline constexpr Ink kBlackInk = {25, 25, 25};
inline constexpr Ink kGreyInk = {110, 110, 110};
inline constexpr Ink kFaintInk = {200, 200, 200};
inline constexpr Ink kGroundInk = {250, 250, 250};

// Positions in pixels from the upper left corner; what lies outside is cut.
class Picture {
 public:
  enum class Align { kLeft, kCentre, kRight };

  // On a light ground.
  Picture(int width, int height);
  ~Picture();

  // text: printable ASCII, one line; y of its baseline; height of capitals in
  // pixels. With a rim of the ground's colour, to stand out from lines.
  void Text(const std::string& text, double x, double y, double height,
            Align align = Align::kLeft, const Ink& ink = kBlackInk);
  static double TextWidth(const std::string& text, double height);

  void Line(double x0, double y0, double x1, double y1, const Ink& ink);
  void Dot(double x, double y, double radius, const Ink& ink);

  // A square radiance image that shows a sphere from edge to edge, times
  // exposure, resized in linear light (by area where that is smaller) to a disc
  // of that diameter.
  void Sphere(const Image& image, double x, double y, int diameter,
              double exposure);

  // Linear display colours in [0, 1], resized in linear light to a rectangle:
  // by area where that is smaller, else in squares.
  void Photo(const Image& image, double x, double y, int width, int height);

  // A rectangle's outline, `thickness` pixels inwards.
  void Frame(double x, double y, double width, double height, int thickness,
             const Ink& ink);

  // Pixel by pixel; (left, top) is where its upper left corner goes.
  void Place(const Rgb8Image& image, int left, int top);

  Rgb8Image ToImage() const;

 private:
  struct Canvas;
  std::unique_ptr<Canvas> canvas_;
};

}  // namespace ibrdf
