#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "ibrdf/solvers/costs/interval_likelihood.h"
#include "ibrdf/solvers/priors/albedo_prior.h"
#include "small_light.h"

namespace ibrdf {
namespace {

// Colours of points, some like others.
Eigen::MatrixX3d SomeChroma(int points) {
  std::vector<double> log_radiance(3 * points);
  for (size_t i = 0; i < log_radiance.size(); ++i) {
    log_radiance[i] = 0.1 * std::sin(2.0 * i) + 0.02 * (i % 3);
  }
  return LogChroma(log_radiance);
}

// Shares from gloss alone to matte alone.
Paint SomePaint(double factor = 1.0, int points = kPoints) {
  Paint paint;
  paint.covariance =
      AlbedoCovariance(AlbedoPrior().Scaled(factor), SomeChroma(points));
  paint.matte_share = Eigen::VectorXd::LinSpaced(3 * points, 0.0, 1.0);
  return paint;
}

LogRadianceData Values(const std::vector<double>& y) { return {y, {}, {}}; }

LogRadianceData SomeIntervals(const std::vector<double>& y) {
  LogRadianceData data = {y, y, y};
  for (size_t i = 0; i < y.size(); i += 2) {
    data.low[i] -= 0.1;
    data.high[i] =
        i % 4 == 0 ? y[i] + 0.2 : std::numeric_limits<double>::infinity();
  }
  return data;
}

TEST(MarginalPaint, GradientMatchesDifferences) {
  ExpectGradientMatches(Values, SomePaint());
  ExpectGradientMatches(Values, SomePaint(5.0));
  ExpectGradientMatches(SomeIntervals, SomePaint());
}

// A mean that is known is as good as an image without it.
TEST(MarginalPaint, OfAMeanIsThatOfAnImageWithoutIt) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  const std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  Paint paint = SomePaint();
  const double without = Cost(Values(y), T, Rough(), nullptr, 0, 0.1, paint);
  std::vector<double> painted = y;
  paint.mean = Eigen::VectorXd(y.size());
  for (size_t i = 0; i < y.size(); ++i) {
    painted[i] += paint.mean[i] = 0.5 * std::sin(3.0 * i);
  }
  EXPECT_NEAR(without,
              Cost(Values(painted), T, Rough(), nullptr, 0, 0.1, paint), 1e-6);
  EXPECT_GT(Cost(Values(painted), T, Rough(), nullptr, 0, 0.1, SomePaint()),
            without + 1.0);
}

// A share u without paint adds log(1 + u (e^a0 - 1)), and the painted share is
// u e^a0 / (1 + u (e^a0 - 1)).
TEST(MarginalPaint, FindsTheShareOfPaintOfAMean) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  std::array<RowMatrix, 3> matte = T;
  for (RowMatrix& m : matte) m *= 0.25;
  const std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  const Eigen::VectorXd mean = Eigen::VectorXd::LinSpaced(y.size(), -2.0, 2.0);
  const MarginalLikelihood likelihood(Values(y), Proper(), kHeight, kWidth, 0,
                                      1, SomePaint().covariance, mean);
  LightMode mode = ZeroMode(likelihood);
  const DataErrors errors =
      likelihood.FindErrors(T, matte, 0.1, Rough(), kTight, &mode);
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const double painted = 0.25 * std::exp(mean[i]);
    EXPECT_NEAR(errors.mean_paint[i], std::log(0.75 + painted), 1e-9);
    EXPECT_NEAR(errors.matte_share[i], painted / (0.75 + painted), 1e-9);
  }
}

TEST(MarginalPaint, OfNoVarianceOrNoMatteIsNone) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  for (size_t i = 0; i < y.size(); ++i) y[i] += 0.2 * std::sin(5.0 * i);
  const double none = Cost(Values(y), T, Rough(), nullptr);
  Paint gloss = SomePaint();
  gloss.matte_share.setZero();
  for (const Paint& paint : {SomePaint(0.0), gloss}) {
    EXPECT_NEAR(none, Cost(Values(y), T, Rough(), nullptr, 0, 0.1, paint),
                1e-9);
  }
  EXPECT_GT(std::abs(none -
                     Cost(Values(y), T, Rough(), nullptr, 0, 0.1, SomePaint())),
            0.1);
}

// Independent paint is noise of its own.
TEST(MarginalPaint, WithoutCorrelationIsNoise) {
  const std::array<RowMatrix, 3> T = Lobes(0.4);
  std::vector<double> y = LogRadiance(T, DrawLight(Proper(), 1.0, 4));
  for (size_t i = 0; i < y.size(); ++i) y[i] += 0.2 * std::sin(5.0 * i);
  Paint paint = SomePaint();
  paint.covariance = 0.09 * Eigen::MatrixXd::Identity(3 * kPoints, 3 * kPoints);
  const MarginalLikelihood likelihood = Likelihood(Values(y), Proper());
  LightMode mode = ZeroMode(likelihood);
  DataErrors errors = Noise(0.1);
  errors.noise += 0.09 * paint.matte_share.cwiseAbs2();
  const MarginalValue noisy =
      likelihood.Evaluate(T, errors, Rough(), kTight, &mode, nullptr);
  EXPECT_NEAR(noisy.cost, Cost(Values(y), T, Rough(), nullptr, 0, 0.1, paint),
              1e-8);
}

// The integral itself, by drawing light and albedo from their priors.
TEST(MarginalPaint, IsTheIntegralWhereLightVariesLittle) {
  const int points = 2;
  const std::array<RowMatrix, 3> T = Lobes(0.8, points);
  const LightProcess process = LittleVariance();
  const double log_amplitude = std::log(0.02), sigma = 0.15;
  const Paint paint = SomePaint(0.5, points);
  const Eigen::MatrixXd factor = paint.covariance.llt().matrixL();
  std::mt19937_64 rng(3);
  std::normal_distribution<double> g;
  const auto draw = [&](uint64_t seed) {
    std::vector<double> y = LogRadiance(T, DrawLight(process, 0.02, seed));
    Eigen::VectorXd white(3 * points);
    for (double& w : white) w = g(rng);
    const Eigen::VectorXd a = factor * white;
    for (size_t i = 0; i < y.size(); ++i) y[i] += paint.matte_share[i] * a[i];
    return y;
  };
  const std::vector<double> y = draw(5);
  const MarginalLikelihood likelihood =
      Likelihood(Values(y), process, 0, paint.covariance);
  LightMode mode = ZeroMode(likelihood);
  DataErrors errors = Noise(sigma, points);
  errors.matte_share = paint.matte_share;
  const MarginalValue value =
      likelihood.Evaluate(T, errors, {log_amplitude}, kTight, &mode, nullptr);
  ASSERT_TRUE(value.ok);
  double sum = 0.0;
  const int count = 40000;
  for (int k = 0; k < count; ++k) {
    const std::vector<double> at = draw(100 + k);
    double log_p = -3 * points * std::log(sigma);
    for (size_t i = 0; i < at.size(); ++i) {
      const double r = (y[i] - at[i]) / sigma;
      log_p -= 0.5 * r * r;
    }
    sum += std::exp(log_p) / count;
  }
  EXPECT_NEAR(std::log(sum), -value.cost, 0.1);
}

// A bright patch of another colour is paint's: the light stays as even as
// without it.
TEST(MarginalPaint, TakesWhatColourTellsFromTheLight) {
  const std::array<RowMatrix, 3> T = Lobes(1.2, 24);
  const Eigen::VectorXd dark = Eigen::VectorXd::Zero(3 * kTexels);
  std::vector<double> y = LogRadiance(T, dark);
  const double shift[3] = {0.8, 0.5, 0.2};
  for (int c = 0; c < 3; ++c) {
    for (int p = 0; p < 12; ++p) y[c * 24 + p] += shift[c];
  }
  Paint paint;
  paint.covariance = AlbedoCovariance(AlbedoPrior(), LogChroma(y));
  paint.matte_share = Eigen::VectorXd::Ones(3 * 24);
  const auto spread_of_light = [&](const Paint& with) {
    const MarginalLikelihood likelihood =
        Likelihood(Values(y), Proper(), 0, with.covariance);
    LightMode mode = ZeroMode(likelihood);
    DataErrors errors = Noise(0.03, 24);
    errors.matte_share = with.matte_share;
    EXPECT_TRUE(likelihood.Evaluate(T, errors, {}, 1e-9, &mode, nullptr).ok);
    const Eigen::ArrayXd l = mode.l.head(kTexels);
    return std::sqrt((l - l.mean()).square().mean());
  };
  EXPECT_LT(spread_of_light(paint), 0.2 * spread_of_light({}));
}

// Normals on an arc, of which neighbours differ by 0.1 radians.
Eigen::MatrixX3d ArcOfNormals(int points) {
  Eigen::MatrixX3d normals(points, 3);
  for (int i = 0; i < points; ++i) {
    normals.row(i) << std::sin(0.1 * i), 0.0, std::cos(0.1 * i);
  }
  return normals;
}

TEST(AlbedoCovariance, LuminanceDriftsWithTheNormals) {
  constexpr int kArc = 30;
  AlbedoPrior prior;
  prior.smooth_luminance = 0.2;
  prior.smooth_length = 0.5;
  const Eigen::MatrixX3d chroma = SomeChroma(kArc);
  const Eigen::MatrixXd without = AlbedoCovariance(prior, chroma);
  const Eigen::MatrixXd drift =
      AlbedoCovariance(prior, chroma, ArcOfNormals(kArc)) - without;
  for (const int q : {0, 1, 5, 29}) {
    const double chord = 2.0 * std::sin(0.05 * q);
    const double expected = 0.04 * std::exp(-2.0 * chord * chord);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(drift(0, c * kArc + q), expected, 1e-15) << c << ' ' << q;
      EXPECT_NEAR(drift(c * kArc + q, 0), expected, 1e-15) << c << ' ' << q;
    }
  }
  EXPECT_GT(drift.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
            -1e-12);
}

TEST(AlbedoCovariance, IsPositiveDefiniteAndOfItsDeviations) {
  const AlbedoPrior prior;
  const Eigen::MatrixX3d chroma = SomeChroma(5);
  const Eigen::MatrixXd K = AlbedoCovariance(prior, chroma);
  EXPECT_GT(K.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
  // Variance of the mean of the channels at a point.
  double mean = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) mean += K(c * 5, d * 5) / 9.0;
  }
  EXPECT_NEAR(mean,
              prior.luminance_std * prior.luminance_std +
                  prior.own_luminance * prior.own_luminance,
              1e-12);
  EXPECT_NEAR(LogChroma({0.1, 0.4, 0.7}).sum(), 0.0, 1e-15);
}

}  // namespace
}  // namespace ibrdf
