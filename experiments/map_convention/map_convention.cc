// Draws the picture of the map convention in docs/conventions.md, from the
// functions that readers and writers of maps use:
//   cmake --build --preset release --target map_convention
//   build/release/bin/map_convention docs/map_convention.png
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "ibrdf/io/png.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {
namespace {

constexpr int kMapWidth = 960, kMapHeight = 480;
constexpr int kLeft = 190, kTop = 100, kRight = 60, kBottom = 190;
const cv::Scalar kInk(25, 25, 25), kFaint(95, 95, 95), kGrid(255, 255, 255);

void Text(cv::Mat* canvas, const std::string& text, double x, double y,
          double anchor, double scale, const cv::Scalar& colour) {
  int baseline = 0;
  const cv::Size size =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &baseline);
  cv::putText(*canvas, text,
              {static_cast<int>(x - anchor * size.width),
               static_cast<int>(y + 0.5 * size.height)},
              cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

MapGrid Grid() { return MapGrid(MapFrame::kCamera, {kMapWidth, kMapHeight}); }

// Red, green, blue grow with the x, y, z of the direction, in steps that keep
// the file small.
void DrawGradient(cv::Mat* canvas) {
  for (int y = 0; y < kMapHeight; ++y) {
    for (int x = 0; x < kMapWidth; ++x) {
      const Eigen::Vector3d d = *Grid().Direction({x + 0.5, y + 0.5});
      for (int c = 0; c < 3; ++c) {
        canvas->at<cv::Vec3b>(kTop + y, kLeft + x)[c] =
            static_cast<uint8_t>(std::lround(46.0 + 14.0 * d[c]) * 4);
      }
    }
  }
}

void DrawGrid(cv::Mat* canvas) {
  const char* const phi[] = {"-pi", "-pi/2", "0", "pi/2", "pi"};
  const char* const column[] = {"column 0", "W/4", "W/2", "3W/4", "column W"};
  for (int i = 0; i <= 4; ++i) {
    const int x = kLeft + i * kMapWidth / 4;
    cv::line(*canvas, {x, kTop}, {x, kTop + kMapHeight + 8}, kGrid);
    cv::line(*canvas, {x, kTop + kMapHeight}, {x, kTop + kMapHeight + 8},
             kFaint);
    Text(canvas, std::string("phi = ") + phi[i], x, kTop + kMapHeight + 22, 0.5,
         0.5, kInk);
    Text(canvas, column[i], x, kTop + kMapHeight + 44, 0.5, 0.5, kFaint);
  }
  const char* const theta[] = {"0", "pi/4", "pi/2", "3 pi/4", "pi"};
  const char* const row[] = {"row 0", "H/4", "H/2", "3H/4", "row H"};
  for (int i = 0; i <= 4; ++i) {
    const int y = kTop + i * kMapHeight / 4;
    const int lift = i == 4 ? -16 : 0;  // off the labels of the columns
    cv::line(*canvas, {kLeft, y}, {kLeft + kMapWidth, y}, kGrid);
    cv::line(*canvas, {kLeft - 8, y}, {kLeft, y}, kFaint);
    Text(canvas, std::string("theta = ") + theta[i], kLeft - 16, y + lift - 10,
         1.0, 0.5, kInk);
    Text(canvas, row[i], kLeft - 16, y + lift + 12, 1.0, 0.5, kFaint);
  }
}

void MarkAxis(cv::Mat* canvas, const Eigen::Vector3d& direction,
              const std::string& name, const std::string& note) {
  const MapPoint point = Grid().Position(direction);
  const double row = point.row, column = point.column;
  // +z is at both ends of the map; no text leaves the map.
  const bool seam = direction.z() > 0.5;
  for (int copy = 0; copy <= (seam ? 1 : 0); ++copy) {
    const int x = kLeft + static_cast<int>(column) + copy * kMapWidth;
    const int y = kTop + static_cast<int>(row);
    cv::circle(*canvas, {x, y}, 6, kInk, cv::FILLED, cv::LINE_AA);
    const double anchor = !seam ? 0.5 : copy;
    const double inset = !seam ? 0.0 : copy == 0 ? 12.0 : -12.0;
    Text(canvas, name, x + inset, y - 24, anchor, 0.9, kInk);
    Text(canvas, note, x + inset, y + 22, anchor, 0.5, kInk);
  }
}

// The poles are whole rows.
void MarkPoles(cv::Mat* canvas) {
  const double x = kLeft + 0.5 * kMapWidth;
  Text(canvas, "+y: up, the whole first row", x, kTop + 24, 0.5, 0.7, kInk);
  Text(canvas, "-y: down, the whole last row", x, kTop + kMapHeight - 22, 0.5,
       0.7, kInk);
}

cv::Mat Draw() {
  cv::Mat canvas(kTop + kMapHeight + kBottom, kLeft + kMapWidth + kRight,
                 CV_8UC3, cv::Scalar(250, 250, 250));
  DrawGradient(&canvas);
  DrawGrid(&canvas);
  MarkAxis(&canvas, {0, 0, 1}, "+z", "behind the camera");
  MarkAxis(&canvas, {1, 0, 0}, "+x", "right");
  MarkAxis(&canvas, {0, 0, -1}, "-z", "where the camera looks");
  MarkAxis(&canvas, {-1, 0, 0}, "-x", "left");
  MarkPoles(&canvas);
  const double width = canvas.cols;
  Text(&canvas, "Environment map in the frame camera, height H, width W", kLeft,
       34, 0.0, 0.9, kInk);
  Text(&canvas,
       "Where light comes from, seen from the object. Right-handed, y up.",
       kLeft, 68, 0.0, 0.6, kFaint);
  const int below = kTop + kMapHeight + 90;
  Text(&canvas,
       "texel (row r, column c):  theta = pi (r + 0.5) / H,  "
       "phi = 2 pi (c + 0.5) / W - pi",
       kLeft, below, 0.0, 0.62, kInk);
  Text(&canvas,
       "direction = (sin theta sin phi, cos theta, -sin theta cos phi)", kLeft,
       below + 32, 0.0, 0.62, kInk);
  Text(&canvas, "red, green, blue: x, y, z of the direction", width - kRight,
       below + 68, 1.0, 0.5, kFaint);
  return canvas;
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: map_convention OUT.png\n");
    return 2;
  }
  const cv::Mat canvas = ibrdf::Draw();
  ibrdf::Rgb8Image image(canvas.cols, canvas.rows);
  std::memcpy(image.rgb.data(), canvas.data, image.rgb.size());
  const ibrdf::Status status = ibrdf::WritePng(image, argv[1]);
  if (!status.ok())
    std::fprintf(stderr, "error: %s\n", status.message().c_str());
  return status.ExitCode();
}
