#include "ibrdf/approximation/harmonics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

std::vector<Eigen::Vector3d> AxesAndRandomDirections(int random) {
  std::vector<Eigen::Vector3d> out = {
      Eigen::Vector3d::UnitX(),
      Eigen::Vector3d::UnitY(),
      Eigen::Vector3d::UnitZ(),
      -Eigen::Vector3d::UnitX(),
      -Eigen::Vector3d::UnitY(),
      -Eigen::Vector3d::UnitZ(),
      Eigen::Vector3d(1e-9, 1.0, -1e-9).normalized()};
  std::mt19937 rng(3);
  std::normal_distribution<double> g;
  for (int k = 0; k < random; ++k) {
    out.push_back(Eigen::Vector3d(g(rng), g(rng), g(rng)).normalized());
  }
  return out;
}

Eigen::VectorXd Evaluate(const HarmonicBasis& basis, const Eigen::Vector3d& u) {
  Eigen::VectorXd Y(basis.count());
  basis.Evaluate(u, Y.data());
  return Y;
}

TEST(HarmonicBasis, FirstOnesAreAsInTheBooks) {
  const HarmonicBasis basis(2);
  for (const Eigen::Vector3d& u : AxesAndRandomDirections(20)) {
    const Eigen::VectorXd Y = Evaluate(basis, u);
    // As polynomials (Ramamoorthi and Hanrahan 2001), whose z is our +y.
    const double x = u.z(), y = u.x(), z = u.y();
    const double a = std::sqrt(3 / (4 * kPi)), b = std::sqrt(15 / (4 * kPi));
    const double expected[] = {std::sqrt(1 / (4 * kPi)),
                               a * y,
                               a * z,
                               a * x,
                               b * x * y,
                               b * y * z,
                               std::sqrt(5 / (16 * kPi)) * (3 * z * z - 1),
                               b * x * z,
                               b / 2 * (x * x - y * y)};
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(expected[k], Y[k], 1e-14) << k;
  }
}

TEST(HarmonicBasis, AdditionTheoremHoldsAtHighDegreesAndPoles) {
  const HarmonicBasis basis(32);
  for (const Eigen::Vector3d& u : AxesAndRandomDirections(20)) {
    const Eigen::VectorXd Y = Evaluate(basis, u);
    for (int l = 0; l <= 32; ++l) {
      EXPECT_NEAR((2 * l + 1) / (4 * kPi),
                  Y.segment(l * l, 2 * l + 1).squaredNorm(), 1e-11);
    }
  }
}

TEST(HarmonicProjection, ConstantMapsHaveOneCoefficientAtAnySize) {
  for (const auto& [height, width] :
       {std::pair(1, 2), std::pair(2, 4), std::pair(16, 32), std::pair(5, 6)}) {
    const HarmonicProjection projection(16, height, width);
    const Image map = ConstantMap(height, width, 2.0f);
    HarmonicColours L = projection.Project(map.rgb.data());
    EXPECT_NEAR(2.0 * std::sqrt(4 * kPi), L(0, 1), 1e-12);
    L.row(0).setZero();
    EXPECT_LT(L.cwiseAbs().maxCoeff(), 1e-12) << height << " " << width;
  }
}

TEST(HarmonicProjection, RecoversAHarmonic) {
  const int order = 6, height = 128, width = 256;
  const HarmonicBasis basis(order);
  for (const int which : {1, 7, 20, 41, 48}) {
    Image map(width, height);
    for (int r = 0; r < height; ++r) {
      for (int c = 0; c < width; ++c) {
        map.At(c, r)[2] = static_cast<float>(Evaluate(
            basis, MapDirection(r + 0.5, c + 0.5, height, width))[which]);
      }
    }
    HarmonicColours L =
        HarmonicProjection(order, height, width).Project(map.rgb.data());
    // Texels of 1.4 degrees: their means differ by l (l + 1) a^2 / 24 < 0.2 %.
    EXPECT_NEAR(1.0, L(which, 2), 2e-3);
    L(which, 2) = 0.0;
    EXPECT_LT(L.cwiseAbs().maxCoeff(), 2e-3);
  }
}

TEST(HarmonicProjection, TransposeAgrees) {
  const HarmonicProjection projection(9, 12, 24);
  const Image map = RandomMap(12, 24, 1);
  const HarmonicColours adjoint = HarmonicColours::Random(NumHarmonics(9), 3);
  std::vector<float> gradient(map.rgb.size());
  projection.Transpose(adjoint, gradient.data());
  double product = 0.0, size = 0.0;
  for (size_t k = 0; k < gradient.size(); ++k) {
    product += double{gradient[k]} * map.rgb[k];
    size += std::abs(double{gradient[k]} * map.rgb[k]);
  }
  EXPECT_NEAR(projection.Project(map.rgb.data()).cwiseProduct(adjoint).sum(),
              product, 1e-7 * size);
  // A texel by itself.
  std::vector<double> texel(NumHarmonics(9));
  projection.Texel(3, 5, texel.data());
  double sum = 0.0;
  for (int k = 0; k < NumHarmonics(9); ++k) sum += texel[k] * adjoint(k, 1);
  EXPECT_NEAR(sum, gradient[3 * (3 * 24 + 5) + 1], 1e-6);
}

TEST(HarmonicRotation, TurnsTheFunction) {
  const int order = 12;
  const HarmonicBasis basis(order);
  const HarmonicRotation rotation(order);
  const HarmonicColours L = HarmonicColours::Random(basis.count(), 3);
  for (const Eigen::Vector3d& pole : AxesAndRandomDirections(6)) {
    const Eigen::Vector3d zero =
        pole.cross(Eigen::Vector3d(0.3, -0.5, 0.9)).normalized();
    HarmonicColours turned = L;
    const HarmonicRotation::Pole at = HarmonicRotation::PoleAt(pole);
    rotation.ToPole(at, &turned);
    rotation.Turn(HarmonicRotation::AngleOf(at, zero), &turned);
    for (const Eigen::Vector3d& u : AxesAndRandomDirections(6)) {
      // Frame axes: +y is the pole, +z has phi = 0.
      const Eigen::Vector3d world =
          u.y() * pole + u.z() * zero + u.x() * pole.cross(zero);
      const Eigen::RowVector3d expected =
          Evaluate(basis, world).transpose() * L;
      const Eigen::RowVector3d found = Evaluate(basis, u).transpose() * turned;
      EXPECT_LT((expected - found).norm(), 1e-9);
    }
    rotation.TurnBack(HarmonicRotation::AngleOf(at, zero), &turned);
    rotation.FromPole(at, &turned);
    EXPECT_LT((turned - L).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace ibrdf
