#include "ibrdf/uncertainty/harmonic_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/uncertainty/random_samples.h"

namespace ibrdf {
namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// Harmonics in the frame of a texel.
Eigen::VectorXd Harmonics(int order, const float* w) {
  const HarmonicBasis basis(order);
  Eigen::VectorXd Y(basis.count());
  basis.Evaluate({w[1], w[2], w[0]}, Y.data());
  return Y;
}

double NormalWeight(const TexelSamples& samples, int texel, int view,
                    const HarmonicFitOptions& options) {
  const size_t at = static_cast<size_t>(texel) * samples.num_views + view;
  const double cosine = samples.directions[3 * at + 2];
  if (cosine <= 0.0) return 0.0;
  return samples.weight[at] * std::pow(cosine, options.cosine_power);
}

// Eq. 12 as it stands, by LU in long double.
LongMatrix DenseFit(const TexelSamples& samples, int texel,
                    const HarmonicFitOptions& options) {
  const int count = NumHarmonics(options.order);
  LongMatrix normal = LongMatrix::Zero(count, count);
  LongMatrix right = LongMatrix::Zero(count, kFitValues);
  for (int l = 0; l <= options.order; ++l) {
    for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
      normal(k, k) = options.lambda * std::exp(l);
    }
  }
  normal(0, 0) *= options.constant_penalty;
  for (int view = 0; view < samples.num_views; ++view) {
    const size_t at =
        3 * (static_cast<size_t>(texel) * samples.num_views + view);
    const LongMatrix Y =
        Harmonics(options.order, &samples.directions[at]).cast<long double>();
    const long double w = NormalWeight(samples, texel, view, options);
    normal += w * Y * Y.transpose();
    for (int c = 0; c < 3; ++c) {
      right.col(c) += w * samples.outgoing[at + c] * Y;
      right.col(3 + c) += w * samples.incoming[at + c] * Y;
    }
  }
  return normal.fullPivLu().solve(right);
}

std::vector<double> BatchFit(const TexelSamples& samples,
                             const HarmonicFitOptions& options) {
  const HarmonicFitter fitter(options);
  FitBatch batch;
  GatherBatch(samples, 0, 1.0, &batch);
  HarmonicFitter::Workspace workspace;
  std::vector<double> out(fitter.count() * kFitValues * kFitBatch, -1.0);
  fitter.Fit(batch, &workspace, out.data());
  return out;
}

TexelSamples SomeSamples(int num_texels, int num_views, unsigned seed) {
  std::mt19937 rng(seed);
  TexelSamples samples = EmptySamples(num_texels, num_views);
  RandomDirections(&rng, &samples);
  FillByModel(6, 0.2, 0.7, 0.3, &rng, &samples);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  for (float& w : samples.weight) w = u(rng) < 0.3f ? 0.0f : u(rng);
  return samples;
}

TEST(HarmonicFitter, AgreesWithDenseAlgebraInLongDouble) {
  // Normal matrices have condition numbers up to 3e4 at order 10.
  constexpr double kRounding = 1e-10;
  for (const int order : {1, 2, 5, 10}) {
    for (const double power : {2.0, 1.0}) {
      HarmonicFitOptions options;
      options.order = order;
      options.cosine_power = power;
      // Fewer views than harmonics as well, and texels in part of a batch.
      for (const int views : {3, 40, 150}) {
        const TexelSamples samples = SomeSamples(5, views, 11 + views);
        const std::vector<double> found = BatchFit(samples, options);
        for (int texel = 0; texel < samples.num_texels; ++texel) {
          const LongMatrix expected = DenseFit(samples, texel, options);
          for (int k = 0; k < expected.rows(); ++k) {
            for (int c = 0; c < kFitValues; ++c) {
              EXPECT_NEAR(static_cast<double>(expected(k, c)),
                          found[(k * kFitValues + c) * kFitBatch + texel],
                          kRounding)
                  << order << " " << views;
            }
          }
        }
      }
    }
  }
}

TEST(HarmonicFitter, ZeroWeightsGiveExactlyZero) {
  TexelSamples samples = SomeSamples(16, 30, 3);
  for (int view = 0; view < 30; ++view) samples.weight[7 * 30 + view] = 0.0f;
  const std::vector<double> found = BatchFit(samples, {});
  for (int k = 0; k < 36 * kFitValues; ++k) {
    EXPECT_EQ(0.0, found[k * kFitBatch + 7]);
  }
  EXPECT_NE(0.0, found[6]);
  samples.weight.assign(samples.weight.size(), 0.0f);
  for (const double c : BatchFit(samples, {})) EXPECT_EQ(0.0, c);
}

TEST(HarmonicFitter, WhatIsNoMeasurementDoesNotCount) {
  const TexelSamples samples = SomeSamples(4, 60, 5);
  TexelSamples without = samples, with = samples;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int texel = 0; texel < 4; ++texel) {
    const int at = texel * 60;
    for (int k = 0; k < 4; ++k) without.weight[at + k] = 0.0f;
    with.outgoing[3 * at + 1] = kInfinity;
    with.incoming[3 * at + 5] = -kInfinity;
    with.outgoing[3 * at + 6] = std::nanf("");
    with.directions[3 * at + 11] = std::nanf("");
  }
  EXPECT_EQ(BatchFit(without, {}), BatchFit(with, {}));
}

TEST(SequentialFit, AgreesWithARefit) {
  constexpr double kRounding = 1e-9;
  HarmonicFitOptions options;
  for (const int order : {2, 5, 10}) {
    options.order = order;
    const TexelSamples samples = SomeSamples(1, 80, 17);
    SequentialFit fit(options, kFitValues);
    TexelSamples seen = samples;
    seen.weight.assign(80, 0.0f);
    for (int view = 0; view < 80; ++view) {
      const double w = NormalWeight(samples, 0, view, options);
      Eigen::VectorXd values(kFitValues);
      for (int c = 0; c < 3; ++c) {
        values[c] = samples.outgoing[3 * view + c];
        values[3 + c] = samples.incoming[3 * view + c];
      }
      const Eigen::VectorXd Y = Harmonics(order, &samples.directions[3 * view]);
      const Eigen::MatrixXd expected = fit.CoefficientsWith(Y, w, values);
      fit.Add(Y, w, values);
      EXPECT_EQ(expected, fit.coefficients());
      seen.weight[view] = samples.weight[view];
      if (view % 20 != 19) continue;
      const Eigen::MatrixXd refit = DenseFit(seen, 0, options).cast<double>();
      EXPECT_LT((refit - fit.coefficients()).cwiseAbs().maxCoeff(), kRounding)
          << order << " " << view;
    }
  }
}

TEST(FitPowerSpectra, AreSumsOfSquaresForAnyNumberOfThreads) {
  const TexelSamples samples = SomeSamples(700, 25, 23);
  HarmonicFitOptions options;
  options.order = 3;
  const PowerSpectra one = FitPowerSpectra(samples, options, 2.0, 1);
  const PowerSpectra two = FitPowerSpectra(samples, options, 2.0, 2);
  EXPECT_EQ(one.outgoing, two.outgoing);
  EXPECT_EQ(one.incoming, two.incoming);
  ASSERT_EQ(2100, one.num_signals);
  for (const int texel : {0, 15, 16, 699}) {
    const LongMatrix c = DenseFit(samples, texel, options) / 2.0L;
    for (int l = 0; l <= 3; ++l) {
      for (int channel = 0; channel < 3; ++channel) {
        const int64_t at = l * one.num_signals + channel * 700 + texel;
        const auto power = [&](int column) {
          return static_cast<float>(
              c.col(column).segment(l * l, 2 * l + 1).squaredNorm());
        };
        EXPECT_FLOAT_EQ(power(channel), one.outgoing[at]);
        EXPECT_FLOAT_EQ(power(channel + 3), one.incoming[at]);
      }
    }
  }
}

TEST(HarmonicFitOptions, BadOnesAreNamed) {
  HarmonicFitOptions options;
  EXPECT_TRUE(options.Check().ok());
  options.order = 11;
  EXPECT_NE(std::string::npos, options.Check().message().find("order"));
  options = {};
  options.lambda = 0.0;
  EXPECT_NE(std::string::npos, options.Check().message().find("lambda"));
  options = {};
  options.constant_penalty = 0.0;
  EXPECT_NE(std::string::npos,
            options.Check().message().find("constant_penalty"));
  options = {};
  options.cosine_power = -1.0;
  EXPECT_NE(std::string::npos, options.Check().message().find("cosine_power"));
}

TEST(TexelSamples, BadOnesAreNamed) {
  const TexelSamples good = EmptySamples(2, 3);
  EXPECT_TRUE(good.Check().ok());
  TexelSamples bad = good;
  bad.directions.pop_back();
  EXPECT_NE(std::string::npos, bad.Check().message().find("directions"));
  bad = good;
  bad.weight[1] = 2.0f;
  EXPECT_NE(std::string::npos, bad.Check().message().find("weight"));
  bad = good;
  bad.weight[1] = std::nanf("");
  EXPECT_FALSE(bad.Check().ok());
  bad = good;
  bad.mean_radiance = 0.0;
  EXPECT_NE(std::string::npos, bad.Check().message().find("mean_radiance"));
  bad = good;
  bad.irradiance.assign(4, 1.0f);
  EXPECT_NE(std::string::npos, bad.Check().message().find("irradiance"));
  bad = good;
  bad.prefilter_alpha = -0.1;
  EXPECT_EQ(StatusCode::kInvalidInput, bad.Check().code());
}

}  // namespace
}  // namespace ibrdf
