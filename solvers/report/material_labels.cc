#include "ibrdf/solvers/report/material_labels.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <system_error>

#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {
namespace {

// Neighbours in the list differ in hue and in lightness.
constexpr LabelColour kColours[kMostLabels] = {
    {"blue", {31, 119, 180}},    {"orange", {255, 160, 60}},
    {"green", {44, 140, 60}},    {"pink", {247, 182, 210}},
    {"red", {200, 40, 40}},      {"light blue", {150, 205, 235}},
    {"brown", {120, 75, 45}},    {"yellow", {240, 220, 70}},
    {"purple", {130, 80, 170}},  {"light green", {160, 220, 140}},
    {"grey", {110, 110, 110}},   {"cyan", {30, 190, 200}},
    {"dark red", {110, 20, 50}}, {"white", {245, 245, 245}},
    {"olive", {130, 130, 30}},   {"violet", {210, 130, 230}}};

}  // namespace

const LabelColour& ColourOfMaterial(int material) { return kColours[material]; }

Rgb8Image LabelPicture(const InverseProblem& inverse) {
  Rgb8Image picture(inverse.image.width, inverse.image.height);
  for (const ShadingPoint& point : inverse.points) {
    std::copy_n(ColourOfMaterial(point.material).srgb, 3,
                &picture.rgb[size_t{3} * point.pixel]);
  }
  return picture;
}

Image LabelImage(const InverseProblem& inverse) {
  const Rgb8Image picture = LabelPicture(inverse);
  Image image(picture.width, picture.height);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<float>(DecodeSrgb(picture.rgb[i] / 255.0));
  }
  return image;
}

std::string MaterialFile(const MaterialLabel& label) {
  return "brdf_" + label.value;
}

std::vector<std::string> FilesOfLabels(const std::string& folder) {
  static const std::regex of_label(R"(brdf_\d+(_\d+_\d+)?\.(binary|json))");
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, of_label)) names.push_back(name);
  }
  return names;
}

Solution OfMaterial(const Solution& solution, int material) {
  Solution one = solution;
  one.reflectance() = solution.materials[material];
  return one;
}

}  // namespace ibrdf
