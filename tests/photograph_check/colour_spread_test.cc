#include "ibrdf/solvers/photograph_check/colour_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/photograph_check/surfaces.h"

namespace ibrdf {
namespace {

const Eigen::Array3d kGold(0.9, 0.6, 0.25);

// `factor`: of the colour, at a pixel; with 2 % noise.
ColourSpread SpreadOn(const Image& normals,
                      const std::function<Eigen::Array3d(int, int)>& factor) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  const Image image =
      Painted(normals, [&](const Eigen::Vector3d& n, int x, int y) {
        const Eigen::Array3d e(noise(random), noise(random), noise(random));
        return Eigen::Array3d(kGold * (1.2 + n.x()) * e.exp() * factor(x, y));
      });
  return SpreadOfColours(SampleNormals(image, PointsOf(normals)));
}

TEST(ColourSpread, OneMaterialIsNotSaidToBeSeveral) {
  const ColourSpread spread =
      SpreadOn(SurfaceNormals(128, Bumps),
               [](int, int) { return Eigen::Array3d(Eigen::Array3d::Ones()); });
  EXPECT_TRUE(spread.observable);
  EXPECT_GT(spread.share, 0.5);
  EXPECT_LT(spread.excess, 0.01);
  EXPECT_FALSE(SaysSeveralMaterials(spread));
  // Noise of 2 % in three channels, across the own colour.
  EXPECT_NEAR(0.03, spread.near.across, 0.01);
}

TEST(ColourSpread, PaintIsSeen) {
  // Stripes of red and green, 12 % apart.
  const ColourSpread spread =
      SpreadOn(SurfaceNormals(128, Bumps), [](int x, int) {
        return x / 32 % 2 == 0 ? Eigen::Array3d(1.06, 0.94, 1.0)
                               : Eigen::Array3d(0.94, 1.06, 1.0);
      });
  EXPECT_TRUE(SaysSeveralMaterials(spread));
  EXPECT_GT(spread.excess, 0.05);
}

TEST(ColourSpread, BouncesOfTheOwnColourAreNoPaint) {
  // Half of the object lights itself once more: its colour is squared.
  const ColourSpread spread =
      SpreadOn(SurfaceNormals(128, Bumps), [](int x, int) {
        return x < 64 ? Eigen::Array3d(Eigen::Array3d::Ones())
                      : Eigen::Array3d(kGold.pow(0.3));
      });
  EXPECT_TRUE(spread.observable);
  EXPECT_LT(spread.excess, 0.01);
}

TEST(ColourSpread, ASphereTellsNothing) {
  const ColourSpread spread = SpreadOn(SphereNormals(128), [](int x, int y) {
    return (x / 16 + y / 16) % 2 == 0 ? Eigen::Array3d(1.0, 0.5, 1.0)
                                      : Eigen::Array3d(0.5, 1.0, 1.0);
  });
  EXPECT_FALSE(spread.observable);
  EXPECT_FALSE(SaysSeveralMaterials(spread));
}

TEST(ColourSpread, PaintOnAGreyObjectIsSeen) {
  const Image normals = SurfaceNormals(128, Bumps);
  const Image image =
      Painted(normals, [](const Eigen::Vector3d& n, int x, int) {
        const double blue = x / 32 % 2 == 0 ? 1.1 : 0.9;
        return Eigen::Array3d((1.2 + n.x()) * Eigen::Array3d(1, 1, blue));
      });
  EXPECT_TRUE(SaysSeveralMaterials(
      SpreadOfColours(SampleNormals(image, PointsOf(normals)))));
}

TEST(ColourSpread, NoSamplesAreNotObservable) {
  EXPECT_FALSE(SpreadOfColours({}).observable);
}

}  // namespace
}  // namespace ibrdf
