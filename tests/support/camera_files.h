// Small files of calibrated cameras.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "ibrdf/io/calibrated_views.h"

namespace ibrdf {

// Two views of NeRF's layout: from z = 4, and from x = 4 with y up.
inline std::string SmallTransforms() {
  return R"({"camera_angle_x": 0.6911112070083618, "frames": [
 {"file_path": "./train/r_0", "rotation": 0.01, "transform_matrix":
  [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]},
 {"file_path": "./train/r_1", "transform_matrix":
  [[0, 0, 1, 4], [0, 1, 0, 0.5], [-1, 0, 0, 0], [0.0, 0.0, 0.0, 1.0]]}]})";
}

// The same with the focal length in pixels and a centre off the middle.
inline std::string PixelTransforms() {
  return R"({"camera_model": "OPENCV", "fl_x": 120.0, "fl_y": 130, "cx": 81,
 "cy": 59.5, "w": 160, "h": 120, "k1": 0, "frames": [
 {"file_path": "images/a.png", "transform_matrix":
  [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]}]})";
}

// Two views, named in the order b, a; a is turned by half a turn about y
// against b.
inline std::string SmallColmapCameras() {
  return "# Camera list\n# Number of cameras: 2\n"
         "1 SIMPLE_PINHOLE 160 120 130 80 60\n"
         "7 PINHOLE 80 60 65 66 40.5 29\n";
}
inline std::string SmallColmapImages() {
  return "# Image list\n"
         "3 1 0 0 0 0 0 4 7 set/b.png\n"
         "1 2 3 4 5 -1\n"
         "5 0 0 1 0 0.5 0 4 1 set/a.png\n"
         "\n";
}

inline void AppendBytes(const void* data, size_t size, std::string* bytes) {
  bytes->append(static_cast<const char*>(data), size);
}
template <typename Number>
void AppendNumber(Number value, std::string* bytes) {
  AppendBytes(&value, sizeof(value), bytes);
}

// The same model in COLMAP's binary format. `model`: of camera 7.
inline std::string SmallColmapCamerasBinary(uint32_t model = 1) {
  std::string bytes;
  AppendNumber<uint64_t>(2, &bytes);
  const auto camera = [&](uint32_t id, uint32_t type, uint64_t width,
                          uint64_t height, const std::vector<double>& p) {
    AppendNumber(id, &bytes);
    AppendNumber(type, &bytes);
    AppendNumber(width, &bytes);
    AppendNumber(height, &bytes);
    AppendBytes(p.data(), 8 * p.size(), &bytes);
  };
  camera(1, 0, 160, 120, {130, 80, 60});
  camera(7, model, 80, 60, {65, 66, 40.5, 29});
  return bytes;
}
inline std::string SmallColmapImagesBinary() {
  std::string bytes;
  AppendNumber<uint64_t>(2, &bytes);
  const auto image = [&](uint32_t id, const std::vector<double>& pose,
                         uint32_t camera, const std::string& name,
                         uint64_t points) {
    AppendNumber(id, &bytes);
    AppendBytes(pose.data(), 8 * pose.size(), &bytes);
    AppendNumber(camera, &bytes);
    AppendBytes(name.c_str(), name.size() + 1, &bytes);
    AppendNumber(points, &bytes);
    bytes += std::string(24 * points, '\1');
  };
  image(3, {1, 0, 0, 0, 0, 0, 4}, 7, "set/b.png", 2);
  image(5, {0, 0, 1, 0, 0.5, 0, 4}, 1, "set/a.png", 0);
  return bytes;
}

}  // namespace ibrdf
