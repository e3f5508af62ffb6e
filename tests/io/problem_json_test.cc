#include "ibrdf/io/problem_json.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST_F(ProblemFile, JsonHasTheKeysOfTheFileAndReadsBack) {
  const StatusOr<Problem> read = Read(
      kLeast, {"camera={type: perspective, fov_degrees: 40}",
               "effects=[reflectance_map, harmonics, gaussians]",
               "solver.seed=4", "likelihood.scale=0.1", "truth.brdf=b.binary",
               "geometry={mesh: m.obj, fit: none}"});
  ASSERT_TRUE(read.ok()) << read.status().message();
  const nlohmann::json json = ProblemToJson(*read);
  EXPECT_EQ("joint", json["problem"]);
  EXPECT_EQ(0.1, json["likelihood"]["scale"]);
  EXPECT_EQ("auto", json["likelihood"]["epsilon"]);
  EXPECT_EQ(nlohmann::json({"reflectance_map", "harmonics", "gaussians"}),
            json["effects"]);
  EXPECT_EQ(dir_.File("b.binary"), json["truth"]["brdf"]);
  // JSON is YAML: the resolved problem is a problem file.
  const StatusOr<Problem> again = Read(json.dump(2));
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));
}

// Cameras are told as the file has them, though they were turned.
TEST_F(ProblemFile, JsonHasCamerasOfAZUpWorldAsTheyWere) {
  const StatusOr<Problem> read = Read(
      "image: {file: a}\ngeometry: {mesh: m.obj, up: z, fit: none}\n"
      "camera: {type: perspective, from: [1, -4, 2], to: [0, 0, 1], up: [0, 0, "
      "1]}\n");
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(Eigen::Vector3d(1, 2, 4), read->camera.from);
  EXPECT_EQ(Eigen::Vector3d(0, 1, 0), read->camera.up);
  const nlohmann::json json = ProblemToJson(*read);
  EXPECT_EQ("z", json["geometry"]["up"]);
  EXPECT_EQ(nlohmann::json({1.0, -4.0, 2.0}), json["camera"]["from"]);
  EXPECT_EQ(nlohmann::json({0.0, 0.0, 1.0}), json["camera"]["up"]);
  const StatusOr<Problem> again = Read(json.dump(2));
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));
}

TEST_F(ProblemFile, JsonOfABuiltInSceneReadsBack) {
  const StatusOr<Problem> read = Read(
      "image: {width: 8, height: 8}\ngeometry: {sphere: {}}\n"
      "reflectance: {known: {cook_torrance: {}}}\n"
      "illumination: {known: {sky: {clouds: 0.25}}}\n");
  ASSERT_TRUE(read.ok()) << read.status().message();
  const nlohmann::json json = ProblemToJson(*read);
  EXPECT_EQ(0.25, json["illumination"]["known"]["sky"]["clouds"]);
  const StatusOr<Problem> again = Read(json.dump());
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));
}

TEST_F(ProblemFile, SettingsAreTheLeavesByTheNamesThatSetTakes) {
  const StatusOr<Problem> read =
      Read(kLeast, {"effects=[visibility, interreflection]",
                    "geometry={mesh: m.obj}", "solver.seconds=30"});
  ASSERT_TRUE(read.ok()) << read.status().message();
  std::map<std::string, std::string> settings;
  for (const ProblemSetting& setting : ListSettings(*read)) {
    settings[setting.key] = setting.value;
  }
  EXPECT_EQ("joint", settings["problem"]);
  EXPECT_EQ("30.0", settings["solver.seconds"]);
  EXPECT_EQ("auto", settings["likelihood.scale"]);
  EXPECT_EQ(dir_.File("m.obj"), settings["geometry.mesh"]);
  EXPECT_EQ("[\"visibility\",\"interreflection\"]", settings["effects"]);
  EXPECT_EQ(0u, settings.count("geometry"));
}

}  // namespace
}  // namespace ibrdf
