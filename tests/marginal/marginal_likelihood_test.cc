#include "ibrdf/solvers/marginal/marginal_likelihood.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "tests/marginal/small_light.h"

namespace ibrdf {
namespace {

TEST(MarginalLikelihood, GradientMatchesDifferences) {
  ExpectGradientMatches([](const std::vector<double>& y) {
    return LogRadianceData{y, {}, {}};
  });
}

// How far the mode of the light, of data y [3 * points] under T_c
// [points][sources] with the same noise, is from where the posterior is flat:
// relative to g = J^T D^-1 (y - log L_o), which is K^-1 l there.
double DistanceFromFlat(const std::array<RowMatrix, 3>& T,
                        const std::vector<double>& y, double sigma,
                        const LightMode& mode) {
  const Eigen::Index sources = T[0].cols(), points = T[0].rows();
  const std::vector<double> at =
      LogRadiance(T, (mode.l.array() + mode.level).matrix());
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(3 * sources);
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd L =
        (mode.l.segment(c * sources, sources).array() + mode.level).exp();
    for (Eigen::Index p = 0; p < points; ++p) {
      const Eigen::Index i = c * points + p;
      expected.segment(c * sources, sources) +=
          (y[i] - at[i]) / (sigma * sigma * std::exp(at[i])) *
          T[c].row(p).transpose().cwiseProduct(L);
    }
  }
  return (expected - mode.representers).norm() / expected.norm();
}

TEST(MarginalLikelihood, ModeIsWhereThePosteriorIsFlat) {
  constexpr int kDirectionalLights = 2;
  const std::array<RowMatrix, 3> T = Lobes(0.5, kPoints, kDirectionalLights);
  const std::vector<double> y =
      LogRadiance(T, DrawLight(Proper(), 1.0, 3, kDirectionalLights));
  const MarginalLikelihood likelihood =
      Likelihood({y, {}, {}}, Proper(), kDirectionalLights);
  LightMode mode;
  ASSERT_TRUE(
      likelihood.Evaluate(T, Noise(0.05), {}, kTight, &mode, nullptr).ok);
  EXPECT_LT(DistanceFromFlat(T, y, 0.05, mode), 1e-4);
}

// No light gives such images: seen through wide lobes, points cannot differ so.
// Newton's steps are then of hundreds in log radiance, and hardly anything of
// them can be taken. Without damping 11 of the 20 modes are not found.
TEST(MarginalLikelihood, ModesOfImagesThatNoLightGivesAreFound) {
  const std::array<RowMatrix, 3> T = Lobes(0.5, kPoints);
  std::mt19937_64 random(7);
  std::normal_distribution<double> contrast;
  int found = 0;
  for (int k = 0; k < 20; ++k) {
    std::vector<double> y(3 * kPoints);
    for (double& v : y) v = contrast(random);
    const MarginalLikelihood likelihood = Likelihood({y, {}, {}}, Proper());
    LightMode mode;
    ASSERT_TRUE(
        likelihood.Evaluate(T, Noise(0.01), {}, kTight, &mode, nullptr).ok);
    if (DistanceFromFlat(T, y, 0.01, mode) < 1e-4) ++found;
  }
  EXPECT_GE(found, 17);
}

// The integral itself, by drawing light from the prior.
TEST(MarginalLikelihood, IsTheIntegralWhereLightVariesLittle) {
  const int points = 2, directional_lights = 1;
  const std::array<RowMatrix, 3> T = Lobes(0.8, points, directional_lights);
  LightProcess process = LittleVariance();
  process.directional_light_variance = 0.02;
  process.directional_light_chroma_variance = 0.005;
  const double log_amplitude = std::log(0.02), sigma = 0.15;
  const auto evidence = [&](const std::vector<double>& y) {
    const MarginalLikelihood likelihood({y, {}, {}}, process, kHeight, kWidth,
                                        directional_lights, 1);
    LightMode mode = ZeroMode(likelihood);
    return -likelihood
                .Evaluate(T, Noise(sigma, points), {log_amplitude}, kTight,
                          &mode, nullptr)
                .cost;
  };
  const auto draws = [&](const std::vector<double>& y) {
    double sum = 0.0;
    const int count = 20000;
    for (int k = 0; k < count; ++k) {
      const std::vector<double> at =
          LogRadiance(T, DrawLight(process, 0.02, 100 + k, directional_lights));
      double square = 0.0;
      for (size_t i = 0; i < y.size(); ++i) {
        square += (y[i] - at[i]) * (y[i] - at[i]) / (sigma * sigma);
      }
      sum += std::exp(-0.5 * square) / count;
    }
    return std::log(sum) - y.size() * std::log(sigma);
  };
  const std::vector<double> likely =
      LogRadiance(T, DrawLight(process, 0.02, 5, directional_lights));
  std::vector<double> unlikely = likely;
  unlikely[0] += 0.3;
  unlikely[3] -= 0.2;
  // 20000 draws know the sum to some per cent; Laplace's error is of the order
  // of the light's variance, 0.03.
  EXPECT_NEAR(draws(likely), evidence(likely), 0.1);
  EXPECT_NEAR(draws(unlikely), evidence(unlikely), 0.15);
}

// What the maximum over light and reflectance cannot do: an image made by wide
// lobes is better explained by wide lobes than by narrow ones, which fit it as
// well; and the other way round.
TEST(MarginalLikelihood, TellsMatteFromMirror) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const std::array<RowMatrix, 3> wide = Lobes(0.9, 24);
    const std::array<RowMatrix, 3> narrow = Lobes(0.25, 24);
    const Eigen::VectorXd light = DrawLight(LightProcess(), 1.0, seed);
    const auto cost = [&](const std::array<RowMatrix, 3>& truth,
                          const std::array<RowMatrix, 3>& guess) {
      const MarginalLikelihood likelihood({LogRadiance(truth, light), {}, {}},
                                          LightProcess(), kHeight, kWidth, 0,
                                          1);
      LightMode mode;
      const MarginalValue value =
          likelihood.Evaluate(guess, Noise(0.05, 24), {}, 1e-3, &mode, nullptr);
      EXPECT_TRUE(value.ok);
      return value.cost;
    };
    EXPECT_LT(cost(wide, wide), cost(wide, narrow) - 3.0) << seed;
    EXPECT_LT(cost(narrow, narrow), cost(narrow, wide) - 3.0) << seed;
  }
}

TEST(MarginalLikelihood, StartOfTheModeDoesNotMatter) {
  const std::array<RowMatrix, 3> T = Lobes(0.5);
  const MarginalLikelihood likelihood = Likelihood(
      {LogRadiance(T, DrawLight(Proper(), 4.0, 3)), {}, {}}, Proper());
  LightMode cold, warm;
  const double cost =
      likelihood.Evaluate(T, Noise(0.05), {}, 1e-9, &cold, nullptr).cost;
  const std::array<RowMatrix, 3> other = Lobes(0.9);
  likelihood.Evaluate(other, Noise(0.05), {0.5}, 1e-9, &warm, nullptr);
  warm.level = cold.level;
  EXPECT_NEAR(
      cost, likelihood.Evaluate(T, Noise(0.05), {}, 1e-9, &warm, nullptr).cost,
      1e-4);
}

// What another reflectance's expansion predicts is where the search begins, and
// has no part in what it finds.
TEST(MarginalLikelihood, ExpansionsSayWhatEvaluationsDo) {
  const std::array<RowMatrix, 3> T = Lobes(0.5);
  const MarginalLikelihood likelihood = Likelihood(
      {LogRadiance(T, DrawLight(Proper(), 4.0, 3)), {}, {}}, Proper());
  LightMode cold;
  MarginalGradient gradient;
  const MarginalValue value =
      likelihood.Evaluate(T, Noise(0.05), {}, 1e-9, &cold, &gradient);
  for (const double width : {0.52, 0.9}) {
    LightMode mode;
    std::unique_ptr<const MarginalLikelihood::Expansion> near, at;
    ASSERT_TRUE(likelihood
                    .Expand(Lobes(width), Noise(0.05), {0.5}, 1e-9, nullptr,
                            &mode, &near)
                    .ok);
    mode.level = cold.level;
    EXPECT_NEAR(
        value.cost,
        likelihood.Expand(T, Noise(0.05), {}, 1e-9, near.get(), &mode, &at)
            .cost,
        1e-4);
    const MarginalGradient found = likelihood.Gradient(*at);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT((found.matrices[c] - gradient.matrices[c]).norm(),
                1e-3 * gradient.matrices[c].norm());
    }
    for (size_t k = 0; k < gradient.hyperparameters.size(); ++k) {
      EXPECT_NEAR(gradient.hyperparameters[k], found.hyperparameters[k], 1e-3);
    }
    const RowMatrix G = RowMatrix::Random(T[0].rows() * 3, 2);
    EXPECT_TRUE(likelihood.Information(*at, G).isApprox(
        likelihood.Information(T, Noise(0.05), {}, mode, G), 1e-9));
  }
}

TEST(MarginalLikelihood, WithoutAModeThereIsNoExpansion) {
  std::array<RowMatrix, 3> T = Lobes(0.5);
  const MarginalLikelihood likelihood = Likelihood(
      {LogRadiance(T, DrawLight(Proper(), 4.0, 3)), {}, {}}, Proper());
  for (RowMatrix& matrix : T) matrix.setZero();
  LightMode mode;
  std::unique_ptr<const MarginalLikelihood::Expansion> at;
  EXPECT_FALSE(
      likelihood.Expand(T, Noise(0.05), {}, 1e-9, nullptr, &mode, &at).ok);
  EXPECT_EQ(nullptr, at);
}

TEST(MarginalLikelihood, ExtremesAreFiniteOrRefused) {
  std::array<RowMatrix, 3> T = Lobes(0.3);
  std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 3));
  const auto evaluate = [&](const std::vector<double>& image,
                            const std::array<RowMatrix, 3>& matrices) {
    LightMode mode;
    MarginalGradient gradient;
    const MarginalValue value =
        Likelihood({image, {}, {}}, LightProcess())
            .Evaluate(matrices, Noise(0.03), {}, 1e-3, &mode, &gradient);
    if (!value.ok) return;
    EXPECT_TRUE(std::isfinite(value.cost));
    for (const RowMatrix& m : gradient.matrices) EXPECT_TRUE(m.allFinite());
  };
  std::vector<double> sun = y;
  sun[2] += 14.0;  // a million times
  evaluate(sun, T);
  std::vector<double> dark = y;
  for (double& v : dark) v -= 60.0;
  evaluate(dark, T);
  std::array<RowMatrix, 3> black = T;
  black[1].setZero();
  evaluate(y, black);
  std::array<RowMatrix, 3> bad = T;
  bad[0](1, 1) = std::nan("");
  LightMode mode;
  EXPECT_FALSE(Likelihood({y, {}, {}}, LightProcess())
                   .Evaluate(bad, Noise(0.03), {}, 1e-3, &mode, nullptr)
                   .ok);
}

TEST(MarginalLikelihood, VarianceIsThePriorsWhereNothingIsSeen) {
  std::array<RowMatrix, 3> T = Lobes(0.15);
  // No point sees the first texel's neighbourhood.
  for (RowMatrix& m : T) m.leftCols(kWidth).setZero();
  const MarginalLikelihood likelihood = Likelihood(
      {LogRadiance(T, DrawLight(Proper(), 1.0, 3)), {}, {}}, Proper());
  LightMode mode;
  likelihood.Evaluate(T, Noise(0.02), {}, 1e-6, &mode, nullptr);
  const Eigen::VectorXd variance =
      likelihood.LightVariance(T, Noise(0.02), {}, mode);
  const double prior = Proper().Local()(0, 0) + Proper().Level()(0, 0);
  EXPECT_LE(variance.maxCoeff(), prior + 1e-9);
  EXPECT_GE(variance.minCoeff(), 0.0);
  // A texel in the middle of a lobe is known better than one of the blind row.
  EXPECT_LT(variance.segment(kWidth, 2 * kWidth).minCoeff(),
            0.5 * variance.head(kWidth).minCoeff());
}

TEST(MarginalLikelihood, NoiseGrowsAsLobesShrink) {
  double last = 0.0;
  for (const double width : {1.5, 0.8, 0.4, 0.2}) {
    const std::array<RowMatrix, 3> T = Lobes(width);
    LightMode mode;
    mode.l = Eigen::VectorXd::Zero(3 * kTexels);
    const Eigen::VectorXd noise =
        Likelihood({std::vector<double>(3 * kPoints, 0.0), {}, {}},
                   LightProcess())
            .NoiseVariance(T, 0.03, mode);
    EXPECT_GE(noise.minCoeff(), 0.03 * 0.03);
    EXPECT_GT(noise.mean(), last);
    last = noise.mean();
  }
  EXPECT_LT(last, LightProcess().VarianceWithin(180.0 / kHeight) + 1e-3);
}

}  // namespace
}  // namespace ibrdf
