#include "ibrdf/solvers/problem/load_object.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr int kObjectSize = 48;

// Normals of the unit sphere, `up` 1 or -1 times their y.
Image Normals(float up) {
  Image normals(kObjectSize, kObjectSize);
  for (int y = 0; y < kObjectSize; ++y) {
    for (int x = 0; x < kObjectSize; ++x) {
      const float u = 2.2f * (x + 0.5f) / kObjectSize - 1.1f;
      const float v = 1.1f - 2.2f * (y + 0.5f) / kObjectSize;
      const float rest = 1.0f - u * u - v * v;
      if (rest <= 0.0f) continue;
      normals.At(x, y)[0] = u;
      normals.At(x, y)[1] = up * v;
      normals.At(x, y)[2] = std::sqrt(rest);
    }
  }
  return normals;
}

class LoadObjectTest : public ::testing::Test {
 protected:
  Problem Parse(const std::string& image_keys) const {
    const StatusOr<Problem> problem =
        ParseProblem(dir_.File("p.yaml"),
                     "problem: illumination\nimage: {file: " + image_keys +
                         "}\ngeometry: {normals: n.exr}\n"
                         "reflectance: {known: {lambertian: 0.5}}\n",
                     {});
    EXPECT_TRUE(problem.ok()) << problem.status().message();
    return *problem;
  }

  const TempDir dir_;
};

TEST_F(LoadObjectTest, CountsWhatAFileOfFloatsHolds) {
  EXPECT_TRUE(WriteExr(Normals(1.0f), dir_.File("n.exr")).ok());
  Image image(kObjectSize, kObjectSize);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    image.rgb[k] = 0.5f + 1e-3f * static_cast<float>(k % 497);
  }
  const int middle = kObjectSize / 2;
  image.At(middle, middle)[0] = 0.0f;
  image.At(middle + 1, middle)[1] = -1.0f;
  image.At(middle + 2, middle)[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(WriteExr(image, dir_.File("i.exr")).ok());
  const StatusOr<PhotographedObject> object =
      LoadPhotographedObject(Parse("i.exr"), 1);
  ASSERT_TRUE(object.ok()) << object.status().message();
  const PhotographCheck& check = object->look->check;
  EXPECT_EQ(object->points.size(), check.counts.object);
  EXPECT_EQ(check.counts.object - 3, check.counts.used);
  EXPECT_EQ(1u, check.counts.zero);
  EXPECT_EQ(1u, check.counts.negative);
  EXPECT_EQ(1u, check.counts.not_finite);
  EXPECT_EQ("linear (the file holds floats)", check.curve);
  EXPECT_FALSE(check.overlap.has_value());
  EXPECT_TRUE(object->look->mask.empty());
  EXPECT_EQ(object->points.size(), object->look->silhouette.CountInside());
}

TEST_F(LoadObjectTest, CountsClippedCodesAndSaysWhichCurve) {
  EXPECT_TRUE(WriteExr(Normals(1.0f), dir_.File("n.exr")).ok());
  Rgb8Image image(kObjectSize, kObjectSize);
  for (uint8_t& v : image.rgb) v = 120;
  image.At(kObjectSize / 2, kObjectSize / 2)[1] = 255;
  EXPECT_TRUE(WritePng(image, dir_.File("i.png")).ok());
  Rgb8Image mask(kObjectSize, kObjectSize);
  for (uint8_t& v : mask.rgb) v = 255;
  EXPECT_TRUE(WritePng(mask, dir_.File("m.png")).ok());
  const StatusOr<PhotographedObject> object = LoadPhotographedObject(
      Parse("i.png, mask: m.png, response: srgb, exposure: 2"), 1);
  ASSERT_TRUE(object.ok()) << object.status().message();
  const PhotographCheck& check = object->look->check;
  EXPECT_EQ(1u, check.counts.clipped);
  EXPECT_EQ("srgb (image.response)", check.curve);
  EXPECT_EQ(2.0, check.exposure);
  EXPECT_EQ(static_cast<size_t>(kObjectSize * kObjectSize), check.mask_pixels);
  ASSERT_TRUE(check.overlap.has_value());
  EXPECT_NEAR(
      static_cast<double>(check.counts.object) / (kObjectSize * kObjectSize),
      *check.overlap, 1e-12);
}

// The look decides only what nobody said, and of what is unknown.
TEST(ChosenVariation, IsWhatIsSaidOrSeen) {
  PhotographCheck plain, painted;
  painted.colours.observable = true;
  painted.colours.excess = 10.0 * kSeveralMaterials;
  ASSERT_TRUE(painted.SeveralMaterials());
  ASSERT_FALSE(plain.SeveralMaterials());
  constexpr auto kNone = ReflectanceVariation::kNone;
  constexpr auto kAlbedo = ReflectanceVariation::kAlbedo;
  Problem problem;
  problem.kind = ProblemKind::kJoint;
  EXPECT_EQ(ReflectanceVariation::kAuto, problem.reflectance.variation);
  EXPECT_EQ(kNone, ChosenVariation(problem, plain));
  EXPECT_EQ(kAlbedo, ChosenVariation(problem, painted));
  // Edges of colour are for the solve to judge, unless like normals have said.
  PhotographCheck edges;
  edges.colour_steps = 2.0 * kMayBePainted;
  EXPECT_EQ(ReflectanceVariation::kAuto, ChosenVariation(problem, edges));
  edges.colours.observable = true;
  EXPECT_EQ(kNone, ChosenVariation(problem, edges));
  // Known light tells of paint that has none.
  problem.kind = ProblemKind::kReflectance;
  EXPECT_EQ(ReflectanceVariation::kAuto, ChosenVariation(problem, plain));
  EXPECT_EQ(kNone, ChosenVariation(problem, edges));
  problem.kind = ProblemKind::kJoint;
  problem.reflectance.variation = kNone;
  EXPECT_EQ(kNone, ChosenVariation(problem, painted));
  problem.reflectance.variation = kAlbedo;
  EXPECT_EQ(kAlbedo, ChosenVariation(problem, plain));
  problem.kind = ProblemKind::kReflectance;
  EXPECT_EQ(kAlbedo, ChosenVariation(problem, plain));
  problem.kind = ProblemKind::kIllumination;
  EXPECT_EQ(kNone, ChosenVariation(problem, painted));
}

TEST_F(LoadObjectTest, WarningsReachTheProblemOfTheSolve) {
  EXPECT_TRUE(WriteExr(Normals(-1.0f), dir_.File("n.exr")).ok());
  Image image(kObjectSize, kObjectSize);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    image.rgb[k] = 0.5f + 1e-3f * static_cast<float>(k % 497);
  }
  EXPECT_TRUE(WriteExr(image, dir_.File("i.exr")).ok());
  const StatusOr<InverseProblem> inverse =
      LoadInverseProblem(Parse("i.exr"), 1, 1);
  ASSERT_TRUE(inverse.ok()) << inverse.status().message();
  ASSERT_NE(nullptr, inverse->look);
  ASSERT_EQ(1u, inverse->warnings.size());
  EXPECT_NE(std::string::npos, inverse->warnings[0].find("\"y flipped\""));
}

}  // namespace
}  // namespace ibrdf
