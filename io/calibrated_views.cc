#include "ibrdf/io/calibrated_views.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace ibrdf {
namespace {

constexpr size_t kMaxNameBytes = 200;

// "r_3" of "./train/r_3.png".
std::string Stem(const std::string& image) {
  return std::filesystem::path(image).stem().string();
}

// "train_r_3" of the same.
std::string WholeName(const std::string& image) {
  const std::filesystem::path path =
      std::filesystem::path(image).lexically_normal();
  std::string name = (path.parent_path() / path.stem()).string();
  std::replace(name.begin(), name.end(), '/', '_');
  std::replace(name.begin(), name.end(), '\\', '_');
  return name;
}

bool AreNames(const std::vector<CalibratedView>& views) {
  std::set<std::string> names;
  for (const CalibratedView& view : views) {
    if (!ViewNameFault(view.name).empty()) return false;
    if (!names.insert(view.name).second) return false;
  }
  return true;
}

}  // namespace

std::string ViewNameFault(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 && byte != 0x7f && c != '/' && c != '\\';
  });
  if (plain && !name.empty() && name.size() <= kMaxNameBytes && name != "." &&
      name != "..") {
    return "";
  }
  return "expected a name that a file may have";
}

bool NameViews(std::vector<CalibratedView>* views) {
  for (CalibratedView& view : *views) view.name = Stem(view.image);
  if (AreNames(*views)) return true;
  for (CalibratedView& view : *views) view.name = WholeName(view.image);
  return AreNames(*views);
}

StatusOr<Camera> CameraOf(const CalibratedView& view, int width, int height) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.world_from_camera = view.world_from_camera;
  const double scale = width / view.width;
  camera.focal_pixels = scale * view.focal;
  if (view.height > 0.0) {
    if (!(std::abs(view.height * scale - height) <= 1.0)) {
      return InvalidInput(
          "image", "expected the proportions of view " + view.name + ", " +
                       std::to_string(std::lround(view.width)) + " x " +
                       std::to_string(std::lround(view.height)) + ", found " +
                       std::to_string(width) + " x " + std::to_string(height));
    }
    const double down = height / view.height;
    camera.focal_pixels->y() = down * view.focal.y();
    camera.centre_pixels =
        Eigen::Vector2d(scale * view.centre.x(), down * view.centre.y());
  }
  return camera;
}

}  // namespace ibrdf
