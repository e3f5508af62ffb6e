#include "ibrdf/solvers/problem/load_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/io/photo_file.h"

namespace ibrdf {
namespace {

// Pixels at a smaller cosine take no part in a search.
constexpr float kMinCosine = 0.2f;  // NormalBinOptions::min_cosine

using Value = std::array<float, 3>;

Value ValueAt(const Image& image, int pixel) {
  const float* rgb = &image.rgb[size_t{3} * pixel];
  return {rgb[0], rgb[1], rgb[2]};
}

std::string NameOf(const Value& value) {
  if (value[0] == value[1] && value[1] == value[2]) {
    return Format("%.9g", value[0]);
  }
  return Format("%.9g_%.9g_%.9g", value[0], value[1], value[2]);
}

bool IsUsable(const ShadingPoint& point, const Image& radiance) {
  const Value value = ValueAt(radiance, point.pixel);
  return point.normal.dot(point.wo) >= kMinCosine &&
         std::all_of(value.begin(), value.end(),
                     [](float v) { return std::isfinite(v) && v > 0.0f; });
}

struct Pixels {
  size_t all = 0, usable = 0;
};

Status CheckValues(const std::string& where, const std::map<Value, Pixels>& of,
                   bool finite) {
  if (!finite) {
    return InvalidInput(where, "expected finite values at the object's pixels");
  }
  if (of.size() <= kMostLabels) return OkStatus();
  return InvalidInput(where, "expected at most " + std::to_string(kMostLabels) +
                                 " values at the object's pixels, found " +
                                 std::to_string(of.size()) +
                                 ": smoothed edges and lossy files make many");
}

}  // namespace

StatusOr<MaterialLabels> LabelPoints(const std::string& path,
                                     const Image& labels, const Image& radiance,
                                     std::vector<ShadingPoint>* points) {
  const std::string where = path + ": reflectance.labels";
  if (labels.width != radiance.width || labels.height != radiance.height) {
    return InvalidInput(where, "expected the image's size " +
                                   SizeName(radiance.width, radiance.height) +
                                   ", found " +
                                   SizeName(labels.width, labels.height));
  }
  std::map<Value, Pixels> found;
  bool finite = true;
  for (const ShadingPoint& point : *points) {
    const Value value = ValueAt(labels, point.pixel);
    finite = finite && std::all_of(value.begin(), value.end(),
                                   [](float v) { return std::isfinite(v); });
    if (!finite) break;  // NaN has no order
    Pixels& pixels = found[value];
    ++pixels.all;
    pixels.usable += IsUsable(point, radiance);
  }
  IBRDF_RETURN_IF_ERROR(CheckValues(where, found, finite));
  const bool none =
      std::all_of(found.begin(), found.end(),
                  [](const auto& label) { return label.second.usable == 0; });
  MaterialLabels out;
  std::map<Value, int> material;
  for (const auto& [value, pixels] : found) {
    if (pixels.usable > 0 || none) {
      material[value] = static_cast<int>(out.labels.size());
      out.labels.push_back({NameOf(value), pixels.all});
      continue;
    }
    out.warnings.push_back(
        where + ": the label " + NameOf(value) + " was left out: none of its " +
        std::to_string(pixels.all) +
        " pixels is away from the limb, finite and positive");
  }
  std::vector<ShadingPoint> kept;
  for (ShadingPoint& point : *points) {
    const auto at = material.find(ValueAt(labels, point.pixel));
    if (at == material.end()) continue;
    point.material = at->second;
    point.index = static_cast<int>(kept.size());
    kept.push_back(point);
  }
  *points = std::move(kept);
  return out;
}

StatusOr<MaterialLabels> LoadLabels(const std::string& path,
                                    const Image& radiance,
                                    std::vector<ShadingPoint>* points) {
  const StatusOr<Photo> photo = ReadPhoto(path);
  if (!photo.ok()) return photo.status();
  return LabelPoints(path, photo->image, radiance, points);
}

int MainMaterial(const std::vector<MaterialLabel>& labels) {
  const auto main =
      std::max_element(labels.begin(), labels.end(),
                       [](const MaterialLabel& a, const MaterialLabel& b) {
                         return a.pixels < b.pixels;
                       });
  return static_cast<int>(main - labels.begin());
}

}  // namespace ibrdf
