// Reflectance in problem files.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

}  // namespace
}  // namespace ibrdf
