// Reflectance in problem files.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ibrdf/io/problem_json.h"
#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST_F(ProblemFile, PaintLiesOverAKnownReflectance) {
  const auto known = [&](const std::string& keys) {
    return Read(
        "image: {width: 8, height: 8}\ngeometry: {sphere: {}}\n"
        "illumination: {known: {sky: {}}}\nreflectance: {known: {" +
        keys + "}}\n");
  };
  const StatusOr<Problem> table = known("brdf: a.binary, albedo: a.exr");
  ASSERT_TRUE(table.ok()) << table.status().message();
  EXPECT_EQ(dir_.File("a.binary"), table->reflectance.known_file);
  EXPECT_EQ(dir_.File("a.exr"), table->reflectance.paint->albedo);
  EXPECT_EQ(1.0, table->reflectance.paint->unpainted_albedo->minCoeff());
  EXPECT_TRUE(CheckRenderable(*table).ok());
  const std::vector<NamedFile> files = NamedFiles(*table);
  EXPECT_TRUE(std::any_of(files.begin(), files.end(), [](const NamedFile& f) {
    return f.key == "reflectance.known.albedo";
  }));
  const StatusOr<Problem> own =
      known("lambertian: 0.5, albedo: a.exr, unpainted_albedo: auto");
  ASSERT_TRUE(own.ok()) << own.status().message();
  EXPECT_FALSE(own->reflectance.paint->unpainted_albedo.has_value());
  EXPECT_EQ(0.25, known("brdf: a.binary, albedo: a.exr, unpainted_albedo: "
                        "[0.5, 0.25, 1]")
                      ->reflectance.paint->unpainted_albedo.value()[1]);
  EXPECT_FALSE(known("brdf: a.binary")->reflectance.paint.has_value());

  // It is for renders.
  const StatusOr<Problem> solved =
      Read(std::string(kLeast) +
           "problem: illumination\nreflectance: {known: "
           "{lambertian: 0.5, albedo: a.exr}}");
  ASSERT_TRUE(solved.ok()) << solved.status().message();
  EXPECT_NE(std::string::npos,
            CheckSolvable(*solved).message().find(
                "reflectance.known.albedo: expected in a render alone"));
}

TEST_F(ProblemFile, LabelsNeedNoWordOfTheVariation) {
  for (const std::string variation :
       {"", ", variation: auto", ", variation: labels"}) {
    const StatusOr<Problem> problem =
        Read(kLeast + ("reflectance: {labels: l.png" + variation) + "}");
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    EXPECT_EQ(ReflectanceVariation::kLabels, problem->reflectance.variation);
    EXPECT_EQ(dir_.File("l.png"), problem->reflectance.labels);
  }
  const StatusOr<Problem> without =
      Read(kLeast + std::string("reflectance: {variation: labels}"));
  ASSERT_TRUE(without.ok());
  EXPECT_EQ(path_ +
                ": reflectance.labels: expected this key with variation: "
                "labels, found nothing",
            CheckSolvable(*without).message());
}

TEST_F(ProblemFile, LabelsMayBeFound) {
  const std::string of_views =
      "views: [{name: a, file: f}, {name: b, file: f}]\n";
  for (const std::string& views : {std::string(), of_views}) {
    const StatusOr<Problem> problem =
        Read((views.empty() ? kLeast : "geometry: {sphere: {}}\n" + views) +
             std::string("reflectance: {labels: auto}"));
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    EXPECT_EQ(ReflectanceVariation::kLabels, problem->reflectance.variation);
    EXPECT_TRUE(problem->reflectance.finds_labels());
  }
  // A file of that name.
  const StatusOr<Problem> file =
      Read(kLeast + std::string("reflectance: {labels: ./auto}"));
  ASSERT_TRUE(file.ok());
  EXPECT_FALSE(file->reflectance.finds_labels());
}

TEST_F(ProblemFile, ImagesAreOfOneViewUnderSeveralLights) {
  const StatusOr<Problem> problem = Read(
      "images: [a.png, b.png, c.png]\nimage: {mask: m.png}\n"
      "geometry: {sphere: {}}\n");
  ASSERT_TRUE(problem.ok()) << problem.status().message();
  EXPECT_TRUE(CheckSolvable(*problem).ok());
  EXPECT_EQ(dir_.File("a.png"), problem->image.file);
  EXPECT_EQ(dir_.File("m.png"), problem->image.mask);
  EXPECT_EQ(std::vector<std::string>({dir_.File("b.png"), dir_.File("c.png")}),
            problem->image.other_lights);
  EXPECT_EQ(ReflectanceVariation::kAlbedo, problem->reflectance.variation);
  const nlohmann::json json = ProblemToJson(*problem);
  const StatusOr<Problem> again = Read(json.dump());
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));

  const StatusOr<Problem> one =
      Read("images: [a.png]\ngeometry: {sphere: {}}\n");
  ASSERT_TRUE(one.ok()) << one.status().message();
  EXPECT_TRUE(one->image.other_lights.empty());
  EXPECT_EQ(ReflectanceVariation::kAuto, one->reflectance.variation);
}

TEST_F(ProblemFile, ImagesUnderSeveralLightsNeedPaintAndUnknownLight) {
  std::string many = "images: [a";
  for (size_t k = 0; k <= kMaxOtherLights; ++k) many += ", a";
  const std::string two = "images: [a, b]\ngeometry: {sphere: {}}\n";
  for (const Refusal& refusal : std::vector<Refusal>{
           {"images: []\ngeometry: {sphere: {}}\n",
            "images: expected a list of files' names"},
           {many + "]\ngeometry: {sphere: {}}\n",
            "images: expected at most 16 files"},
           {two + "image: {file: a}\n", "images: expected without image.file"},
           {two + "image: {width: 4, height: 4}\n",
            "images: expected without image.file"},
           {two + "views: {colmap: d}\n", "images: expected without views"},
           {two + "problem: reflectance\nillumination: {known: m.hdr}\n",
            "images: several need problem: joint"},
           {two + "image: {response: unknown}\n",
            "images: several need a known image.response"},
           {two + "reflectance: {variation: none}\n",
            "images: several need reflectance.variation: albedo"},
           {two + "reflectance: {labels: l.png}\n",
            "images: several need reflectance.variation: albedo"},
           {two + "solver: {estimator: maximum}\n",
            "reflectance.variation: expected none"}}) {
    EXPECT_NE(std::string::npos, ErrorOf(refusal.text).find(refusal.error))
        << refusal.text << ErrorOf(refusal.text);
  }
}

}  // namespace
}  // namespace ibrdf
