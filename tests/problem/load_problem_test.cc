#include "ibrdf/solvers/problem/load_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

constexpr int kSilhouetteSize = 64;

// A sphere's image with a mask that is a disc of `radius` about (right, up);
// the sphere's own has radius 1 about 0.
class SilhouetteTest : public ::testing::Test {
 protected:
  StatusOr<InverseProblem> Load(double radius, double right, double up) const {
    Image image(kSilhouetteSize, kSilhouetteSize);
    image.rgb.assign(image.rgb.size(), 0.5f);
    EXPECT_TRUE(WriteExr(image, dir_.File("i.exr")).ok());
    Rgb8Image mask(kSilhouetteSize, kSilhouetteSize);
    for (int y = 0; y < kSilhouetteSize; ++y) {
      for (int x = 0; x < kSilhouetteSize; ++x) {
        const double X = (x + 0.5) / kSilhouetteSize * 2 - 1 - right;
        const double Y = 1 - (y + 0.5) / kSilhouetteSize * 2 - up;
        const uint8_t v = X * X + Y * Y < radius * radius ? 255 : 0;
        for (int c = 0; c < 3; ++c) mask.At(x, y)[c] = v;
      }
    }
    EXPECT_TRUE(WritePng(mask, dir_.File("m.png")).ok());
    const StatusOr<Problem> problem = ParseProblem(
        dir_.File("p.yaml"),
        "problem: illumination\nimage: {file: i.exr, mask: m.png}\n"
        // Where it would be without a mask.
        "geometry: {sphere: {centre: [32, 32], radius: 32}}\n"
        "reflectance: {known: {lambertian: [0.5, 0.5, 0.5]}}\n",
        {});
    EXPECT_TRUE(problem.ok()) << problem.status().message();
    return LoadInverseProblem(*problem, 1, 1);
  }

  const TempDir dir_;
};

TEST_F(SilhouetteTest, OfTheObjectIsNoCauseForAWord) {
  for (const double radius : {1.0, 0.97}) {
    const StatusOr<InverseProblem> loaded = Load(radius, 0.0, 0.0);
    ASSERT_TRUE(loaded.ok()) << loaded.status().message();
    EXPECT_TRUE(loaded->warnings.empty()) << loaded->warnings[0];
  }
}

TEST_F(SilhouetteTest, ThatIsAnotherIsTold) {
  const StatusOr<InverseProblem> loaded = Load(1.0, 0.4, 0.0);
  ASSERT_TRUE(loaded.ok()) << loaded.status().message();
  ASSERT_EQ(size_t{1}, loaded->warnings.size());
  const std::string& warning = loaded->warnings[0];
  EXPECT_NE(std::string::npos, warning.find("m.png: the object covers "))
      << warning;
  EXPECT_NE(std::string::npos, warning.find("overlap 0.")) << warning;
}

TEST_F(SilhouetteTest, ThatIsNearlyAllBesideTheObjectIsRefused) {
  const Status status = Load(0.3, 0.9, 0.9).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("m.png"))
      << status.message();
}

StatusOr<InverseProblem> LoadWithModel(const TempDir& dir) {
  Image image(8, 8);
  image.rgb.assign(image.rgb.size(), 0.5f);
  EXPECT_TRUE(WriteExr(image, dir.File("i.exr")).ok());
  const StatusOr<Problem> problem =
      ParseProblem(dir.File("p.yaml"),
                   "problem: joint\nimage: {file: i.exr}\n"
                   "geometry: {sphere: {centre: [4, 4], radius: 4}}\n"
                   "reflectance: {model: pair}\n",
                   {});
  EXPECT_TRUE(problem.ok()) << problem.status().message();
  return LoadInverseProblem(*problem, 1, 1);
}

TEST(LoadProblem, TakesTwoModelsOfAFolder) {
  const TempDir dir;
  std::filesystem::create_directory(dir.File("pair"));
  ASSERT_TRUE(WriteModel(TinyModel(2), dir.File("pair/default.ibrdf")).ok());
  const Status half = LoadWithModel(dir).status();
  EXPECT_EQ(StatusCode::kInvalidInput, half.code());
  EXPECT_NE(std::string::npos, half.message().find("pair/broad.ibrdf"))
      << half.message();
  ASSERT_TRUE(WriteModel(TinyModel(3), dir.File("pair/broad.ibrdf")).ok());
  const StatusOr<InverseProblem> both = LoadWithModel(dir);
  ASSERT_TRUE(both.ok()) << both.status().message();
  EXPECT_EQ(size_t{6}, both->model->names.size());
  ASSERT_EQ(size_t{1}, both->other_models.size());
  EXPECT_EQ(size_t{9}, both->other_models[0].model->names.size());
}

}  // namespace
}  // namespace ibrdf
