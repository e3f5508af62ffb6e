#include "tests/hard_cases/case_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <vector>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::json;

// Files of the folder and those below it, as paths from there.
std::vector<std::string> FilesIn(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_directory()) continue;
    files.push_back(fs::relative(entry.path(), folder).string());
  }
  return files;
}

// What has no value for some results.
bool MayBeMissing(const std::string& where) {
  // These are null for an exact image, for estimates without curvature.
  if (where == "result.json/metrics/psnr" ||
      where == "result.json/posterior/condition_number") {
    return true;
  }
  // No labels of more materials were proposed.
  if (where == "result.json/labels_found/gain_of_more_nats") return true;
  // A curve whose evidence has no peak that was found.
  static const std::regex kNoWidth(
      "result\\.json/curves/[0-9]+/log_parameter_std");
  if (std::regex_match(where, kNoWidth)) return true;
  // A view of which no pixel took part.
  static const std::regex kBlind("result\\.json/views/[0-9]+/misfit");
  if (std::regex_match(where, kBlind)) return true;
  // The look before: no mask, no like normals at several places, no outline or
  // curvature of a normal map.
  static const std::regex kNotSeen(
      "(result|check)\\.json/check/(mask_pixels|overlap|"
      "like_normals/(log_(radiance|colour)|misfit_floor)|materials/"
      "colour_spread|"
      "normals/[0-9]+/(away|outline|curl))");
  return std::regex_match(where, kNotSeen);
}

void ExpectFinite(const Json& json, const std::string& where) {
  // NaN and infinities are written as null.
  if (json.is_null()) {
    EXPECT_TRUE(MayBeMissing(where)) << where;
  } else if (json.is_number()) {
    EXPECT_TRUE(std::isfinite(json.get<double>())) << where;
  } else if (json.is_structured()) {
    for (const auto& [key, value] : json.items()) {
      ExpectFinite(value, where + "/" + key);
    }
  }
}

// Numbers of the report's table and texts.
void ExpectNoNan(const std::string& html) {
  static const std::regex kNotANumber("[> ](-?nan|-?inf)[< ]",
                                      std::regex::icase);
  EXPECT_FALSE(std::regex_search(html, kNotANumber));
}

void ExpectWholeFiles(const std::string& folder, Json* result) {
  for (const std::string& file : FilesIn(folder)) {
    const std::string path = folder + "/" + file;
    const std::string extension = fs::path(file).extension().string();
    EXPECT_GT(fs::file_size(path), 0u) << file;
    if (extension == ".exr") {
      const StatusOr<Image> image = ReadExr(path);
      ASSERT_TRUE(image.ok()) << image.status().message();
      EXPECT_TRUE(std::all_of(image->rgb.begin(), image->rgb.end(),
                              [](float v) { return std::isfinite(v); }))
          << file;
    } else if (extension == ".binary") {
      const StatusOr<MerlTable> table = ReadMerl(path);
      EXPECT_TRUE(table.ok()) << table.status().message();
    } else if (extension == ".json") {
      const Json json = Json::parse(ReadBytes(path), nullptr, false);
      ASSERT_FALSE(json.is_discarded()) << file;
      ExpectFinite(json, file);
      if (file == "result.json") *result = json;
    } else {
      EXPECT_TRUE(extension == ".png" || extension == ".html")
          << "left behind: " << file;
      if (extension == ".html") ExpectNoNan(ReadBytes(path));
    }
  }
  for (const char* file : {"result.json", "illumination.exr", "render.exr",
                           "residual.exr", "overview.png", "report.html"}) {
    EXPECT_TRUE(fs::exists(folder + "/" + file)) << file;
  }
}

void ExpectCostNotRisen(const Json& result) {
  const Json start = result.value("/cost/start"_json_pointer, Json());
  const Json end = result.value("/cost/end"_json_pointer, Json());
  ASSERT_TRUE(start.is_number() && end.is_number())
      << result.value("cost", Json());
  EXPECT_LE(end.get<double>(), start.get<double>());
}

void ExpectRange(const std::string& path, const YAML::Node& range) {
  const StatusOr<Image> image = ReadExr(path);
  ASSERT_TRUE(image.ok()) << image.status().message();
  float low = std::numeric_limits<float>::infinity(), high = -low;
  // Beside the object.
  const bool skip_zero = path.find("illumination.exr") == std::string::npos;
  for (const float v : image->rgb) {
    if (skip_zero && v == 0) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  EXPECT_GE(low, range[0].as<double>()) << path;
  EXPECT_LE(high, range[1].as<double>()) << path;
}

// The scene that a painted result's files describe.
std::string SceneOf(const YAML::Node& problem, const std::string& folder,
                    const Image& render) {
  YAML::Node scene;
  scene["image"]["width"] = render.width;
  scene["image"]["height"] = render.height;
  scene["geometry"] = problem["geometry"];
  if (problem["camera"]) scene["camera"] = problem["camera"];
  YAML::Node known = scene["reflectance"]["known"];
  known["brdf"] = folder + "/brdf.binary";
  known["albedo"] = folder + "/albedo.exr";
  known["unpainted_albedo"] = "auto";
  scene["illumination"]["known"] = folder + "/illumination.exr";
  scene["quality"] = "preview";
  return YAML::Dump(scene) + "\n";
}

void ExpectRendersAgain(const YAML::Node& problem, const std::string& folder,
                        double tolerance) {
  const StatusOr<Image> render = ReadExr(folder + "/render.exr");
  ASSERT_TRUE(render.ok()) << render.status().message();
  const StatusOr<Problem> scene =
      ParseProblem(fs::path(folder).parent_path() / "scene.yaml",
                   SceneOf(problem, folder, *render), {});
  ASSERT_TRUE(scene.ok()) << scene.status().message();
  const StatusOr<RenderedScene> again = RenderScene(*scene, {});
  ASSERT_TRUE(again.ok()) << again.status().message();
  double sum = 0.0;
  int count = 0;
  for (size_t k = 0; k < render->rgb.size(); ++k) {
    if (render->rgb[k] == 0.0f || again->image.rgb[k] == 0.0f) continue;
    sum += std::abs(std::log(double{render->rgb[k]} / again->image.rgb[k]));
    ++count;
  }
  ASSERT_GT(count, 0);
  EXPECT_LT(sum / count, tolerance);
}

}  // namespace

void ExpectKnownKeys(const YAML::Node& map,
                     const std::set<std::string>& known) {
  for (const auto& entry : map) {
    ASSERT_EQ(1u, known.count(entry.first.as<std::string>())) << entry.first;
  }
}

void CheckSameBits(const CaseRun& a, const CaseRun& b) {
  EXPECT_EQ(a.exit_status, b.exit_status);
  int compared = 0;
  for (const std::string& file : FilesIn(a.folder)) {
    const std::string extension = fs::path(file).extension().string();
    if (extension != ".exr" && extension != ".binary") continue;
    EXPECT_TRUE(ReadBytes(a.folder + "/" + file) ==
                ReadBytes(b.folder + "/" + file))
        << file;
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

void CheckRun(const YAML::Node& holds, const YAML::Node& problem,
              const CaseRun& run) {
  static const std::set<std::string> kKnown = {"exit",   "says",    "files",
                                               "values", "equals",  "map",
                                               "albedo", "renders", "image"};
  ExpectKnownKeys(holds, kKnown);
  std::vector<int> allowed;
  if (holds["exit"].IsSequence()) {
    allowed = holds["exit"].as<std::vector<int>>();
  } else {
    allowed = {holds["exit"].as<int>()};
  }
  ASSERT_TRUE(std::find(allowed.begin(), allowed.end(), run.exit_status) !=
              allowed.end())
      << "exit status " << run.exit_status << "\n"
      << run.terminal;
  EXPECT_EQ(std::string::npos, run.terminal.find("Sanitizer"));
  EXPECT_EQ(std::string::npos, run.terminal.find("runtime error"))
      << run.terminal;
  for (const YAML::Node& word : holds["says"]) {
    EXPECT_NE(std::string::npos, run.terminal.find(word.as<std::string>()))
        << word << " is not in:\n"
        << run.terminal;
  }
  if (run.exit_status == 2) {
    EXPECT_EQ(0u, run.terminal.find("error: ")) << run.terminal;
    EXPECT_EQ(run.terminal.size() - 1, run.terminal.find('\n'))
        << "not one line:\n"
        << run.terminal;
    for (const std::string& file : FilesIn(run.folder)) {
      // The look before shows what is wrong with a photograph.
      EXPECT_TRUE(file.rfind("check", 0) == 0) << file;
    }
    return;
  }
  if (holds["files"]) {
    std::vector<std::string> found = FilesIn(run.folder);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(holds["files"].as<std::vector<std::string>>(), found);
    return;
  }
  Json result;
  ExpectWholeFiles(run.folder, &result);
  if (testing::Test::HasFatalFailure()) return;
  ExpectCostNotRisen(result);
  for (const auto& entry : holds["values"]) {
    const std::string pointer = entry.first.as<std::string>();
    const Json value = result.value(Json::json_pointer(pointer), Json());
    ASSERT_TRUE(value.is_number()) << pointer << " is " << value;
    EXPECT_GE(value.get<double>(), entry.second[0].as<double>()) << pointer;
    EXPECT_LE(value.get<double>(), entry.second[1].as<double>()) << pointer;
  }
  for (const auto& entry : holds["equals"]) {
    const std::string pointer = entry.first.as<std::string>();
    const Json value = result.value(Json::json_pointer(pointer), Json());
    EXPECT_EQ(entry.second.as<std::string>(),
              value.is_string() ? value.get<std::string>() : value.dump())
        << pointer;
  }
  if (holds["map"]) {
    ExpectRange(run.folder + "/illumination.exr", holds["map"]);
  }
  const std::string albedo = run.folder + "/albedo.exr";
  if (holds["albedo"] && holds["albedo"].IsScalar()) {
    EXPECT_EQ("none", holds["albedo"].as<std::string>());
    EXPECT_FALSE(fs::exists(albedo));
  } else if (holds["albedo"]) {
    ExpectRange(albedo, holds["albedo"]);
  }
  EXPECT_EQ(fs::exists(albedo), fs::exists(run.folder + "/albedo_log_std.exr"));
  if (holds["renders"]) {
    ExpectRendersAgain(problem, run.folder, holds["renders"].as<double>());
  }
  if (holds["image"]) {
    ExpectRange(run.folder + "/render.exr", holds["image"]);
  }
}

}  // namespace ibrdf
