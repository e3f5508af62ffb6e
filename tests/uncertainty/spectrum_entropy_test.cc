#include "ibrdf/uncertainty/spectrum_entropy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/uncertainty/random_samples.h"
#include "tests/uncertainty/spoilt_options.h"

namespace ibrdf {
namespace {

// One texel of three channels with the same spectra.
PowerSpectra OneTexel(const std::vector<double>& S_B,
                      const std::vector<double>& S_L) {
  PowerSpectra out;
  out.order = static_cast<int>(S_B.size()) - 1;
  out.num_signals = 3;
  for (size_t l = 0; l < S_B.size(); ++l) {
    out.outgoing.insert(out.outgoing.end(), 3, static_cast<float>(S_B[l]));
    out.incoming.insert(out.incoming.end(), 3, static_cast<float>(S_L[l]));
  }
  return out;
}

// Eq. 1 to 5 as they stand, in double precision.
double PlainEntropy(const std::vector<double>& A, const std::vector<double>& B,
                    const SpectrumOptions& options, double prefilter_alpha) {
  const std::vector<double> filter = FilterTable(options, prefilter_alpha);
  const std::vector<double> factor = FactorTable(options);
  const int degrees = options.fit.order;
  std::vector<double> p;
  double sum = 0.0;
  for (int i = 0; i < options.num_alpha; ++i) {
    for (int j = 0; j < options.num_ks; ++j) {
      double d = 0.0;
      for (int l = 0; l < degrees; ++l) {
        const double r = factor[j] * filter[i * degrees + l] * A[l] - B[l];
        d += r * r;
      }
      const double prior =
          options.prior.empty() ? 1.0 : options.prior[i * options.num_ks + j];
      p.push_back(std::exp(-d) * prior);
      sum += p.back();
    }
  }
  double H = 0.0;
  for (const double x : p) {
    if (x > 0.0) H -= x / sum * std::log(x / sum);
  }
  return H / std::log(double(p.size()));
}

// The setting of Fig. 4: exp(-d / 0.01^2) with the mean over 8 degrees, alpha
// and Ks uniform on 100 x 100 cells, spectra of at least 1e-5. The light's
// spectrum is exp(-(alpha_light l)^2).
double EntropyOfFigure4(double alpha, double Ks, double alpha_light) {
  SpectrumOptions options = SpectrumOptions::Published(1e-4);
  options.unit_exposure = true;
  options.power_per_degree = false;
  options.fit.order = 8;
  options.num_alpha = 100;
  options.num_ks = 100;
  options.alpha_grid = AlphaGrid::kUniformAlpha;
  std::vector<double> S_B{1.0}, S_L{1.0};
  for (int l = 1; l <= 8; ++l) {
    const double light = std::exp(-alpha_light * l * alpha_light * l);
    const double gloss = std::exp(-2.0 * alpha * l * alpha * l);
    S_L.push_back(std::max(1e-5, light));
    S_B.push_back(std::max(1e-5, Ks * Ks * gloss * light));
  }
  return EntropyOfSpectra(OneTexel(S_B, S_L), options, 0.0, 1).entropy[0];
}

TEST(SpectrumEntropy, HasTheValuesOfFigure4) {
  constexpr double kPrinted = 5e-4;
  EXPECT_NEAR(0.2534, EntropyOfFigure4(0.2, 0.8, 0.0), kPrinted);
  EXPECT_NEAR(0.6859, EntropyOfFigure4(0.2, 0.8, 0.8), kPrinted);
  EXPECT_NEAR(0.8719, EntropyOfFigure4(0.2, 0.1, 0.0), kPrinted);
}

TEST(SpectrumEntropy, AgreesWithThePlainSum) {
  constexpr double kSinglePrecision = 2e-5;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (const SpectrumDistance distance :
       {SpectrumDistance::kPower, SpectrumDistance::kAmplitude}) {
    for (const bool relative : {false, true}) {
      for (const bool with_prior : {false, true}) {
        SpectrumOptions options;
        options.distance = distance;
        options.relative_weights = relative;
        options.num_alpha = 7;
        options.num_ks = 9;
        options.sigma = 0.2;
        if (with_prior) {
          for (int k = 0; k < 63; ++k) options.prior.push_back(u(rng) + 0.01);
        }
        std::vector<double> S_B, S_L, A, B;
        for (int l = 0; l <= 5; ++l) {
          S_L.push_back(static_cast<float>(u(rng) / (l + 1)));
          S_B.push_back(static_cast<float>(u(rng) * S_L.back()));
          if (l == 0) continue;
          A.push_back(ComparedSignal(options, l, S_L[l], S_L[l], S_B[0]));
          B.push_back(ComparedSignal(options, l, S_B[l], S_L[l], S_B[0]));
        }
        const EntropyMaps maps =
            EntropyOfSpectra(OneTexel(S_B, S_L), options, 0.1, 1);
        EXPECT_NEAR(PlainEntropy(A, B, options, 0.1), maps.entropy[0],
                    kSinglePrecision);
        EXPECT_EQ(maps.entropy[0], maps.entropy[2]);
      }
    }
  }
}

TexelSamples Samples(int num_texels, int num_views, double alpha, double Ks,
                     double Kd, int order = 5) {
  std::mt19937 rng(29);
  TexelSamples samples = EmptySamples(num_texels, num_views);
  RandomDirections(&rng, &samples);
  FillByModel(order, alpha, Ks, Kd, &rng, &samples);
  return samples;
}

EntropyMaps EvaluateSpectrum(const TexelSamples& samples,
                             const SpectrumOptions& options = {},
                             int threads = 1) {
  return SpectrumEntropyEvaluator(options).Evaluate(samples, threads).value();
}

TEST(SpectrumEntropy, IsOneWhereNothingIsSeen) {
  TexelSamples samples = Samples(20, 60, 0.2, 0.6, 0.2);
  for (int view = 0; view < 60; ++view) samples.weight[11 * 60 + view] = 0.0f;
  for (const SpectrumOptions& options :
       {SpectrumOptions(), SpectrumOptions::Published(1e-5)}) {
    const EntropyMaps maps = EvaluateSpectrum(samples, options);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(1.0f, maps.entropy[33 + c]);
      EXPECT_GT(1.0f, maps.entropy[30 + c]);
    }
    EXPECT_EQ(1.0f, maps.MinimumEntropy()[11]);
    EXPECT_EQ(1.0f, maps.MeanEntropy()[11]);
  }
}

TEST(SpectrumEntropy, IsHighUnderConstantLight) {
  TexelSamples samples = Samples(16, 100, 0.2, 0.6, 0.2);
  for (size_t k = 0; k < samples.incoming.size(); ++k) {
    samples.incoming[k] = 1.0f;
    samples.outgoing[k] = 0.7f;
  }
  for (const float H : EvaluateSpectrum(samples).entropy) EXPECT_GE(H, 0.98f);
}

TEST(SpectrumEntropy, DoesNotDependOnTheExposure) {
  const TexelSamples samples = Samples(40, 80, 0.15, 0.5, 0.3);
  const EntropyMaps maps = EvaluateSpectrum(samples);
  for (const double factor : {1024.0, 1.0 / 4096.0, 1.7, 333.3, 1e-3}) {
    TexelSamples scaled = samples;
    scaled.mean_radiance *= factor;
    for (float& x : scaled.incoming) x *= static_cast<float>(factor);
    for (float& x : scaled.outgoing) x *= static_cast<float>(factor);
    const EntropyMaps other = EvaluateSpectrum(scaled);
    int exponent = 0;
    const bool power_of_two = std::frexp(factor, &exponent) == 0.5;
    for (size_t k = 0; k < maps.entropy.size(); ++k) {
      EXPECT_NEAR(maps.entropy[k], other.entropy[k], power_of_two ? 0.0 : 1e-5)
          << factor;
    }
  }
}

TEST(SpectrumEntropy, DoesNotDependOnThreadsOrTheOrderOfViews) {
  const TexelSamples samples = Samples(900, 30, 0.15, 0.5, 0.3);
  const EntropyMaps one = EvaluateSpectrum(samples, {}, 1);
  EXPECT_EQ(one.entropy, EvaluateSpectrum(samples, {}, 2).entropy);
  TexelSamples reversed = samples;
  for (int texel = 0; texel < 900; ++texel) {
    for (int view = 0; view < 30; ++view) {
      const int from = texel * 30 + view, to = texel * 30 + 29 - view;
      for (int c = 0; c < 3; ++c) {
        reversed.directions[3 * to + c] = samples.directions[3 * from + c];
        reversed.outgoing[3 * to + c] = samples.outgoing[3 * from + c];
        reversed.incoming[3 * to + c] = samples.incoming[3 * from + c];
      }
    }
  }
  const EntropyMaps other = EvaluateSpectrum(reversed);
  for (size_t k = 0; k < one.entropy.size(); ++k) {
    EXPECT_NEAR(one.entropy[k], other.entropy[k], 1e-5);
  }
}

TEST(SpectrumEntropy, DoesNotDependOnTheAxesOfTheFrame) {
  // What turning cameras, mesh and map together does to a texel.
  constexpr float kTurned = 1e-4f;
  const TexelSamples samples = Samples(40, 80, 0.15, 0.5, 0.3);
  TexelSamples turned = samples;
  const float c = std::cos(1.1f), s = std::sin(1.1f);
  for (size_t k = 0; k < samples.weight.size(); ++k) {
    const float* const w = &samples.directions[3 * k];
    turned.directions[3 * k] = c * w[0] - s * w[1];
    turned.directions[3 * k + 1] = s * w[0] + c * w[1];
  }
  const EntropyMaps maps = EvaluateSpectrum(samples),
                    other = EvaluateSpectrum(turned);
  for (size_t k = 0; k < maps.entropy.size(); ++k) {
    EXPECT_NEAR(maps.entropy[k], other.entropy[k], kTurned);
  }
}

TEST(SpectrumEntropy, FindsTheParametersOfItsOwnModel) {
  // A cell of the grid. 150 views of the half sphere determine the 16
  // harmonics, with so little regularisation.
  const double alpha = 16.0 / 49.0, Ks = 5.0 / 7.0;
  SpectrumOptions options;
  options.filter = GlossFilter::kBeckmann;
  options.fit.order = 3;
  options.fit.lambda = 1e-9;
  TexelSamples samples = Samples(30, 300, alpha, Ks, 0.2, 3);
  const EntropyMaps maps = EvaluateSpectrum(samples, options);
  for (size_t k = 0; k < maps.alpha.size(); ++k) {
    EXPECT_NEAR(alpha, maps.alpha[k], 1e-6);
    EXPECT_NEAR(Ks, maps.Ks[k], 1e-6);
    EXPECT_LT(maps.misfit[k], 1e-6);
  }
  // Light smoothed before: undone, the same parameters are found.
  samples.incoming = Samples(30, 300, 0.3, 1.0, 0.0, 3).outgoing;
  samples.prefilter_alpha = 0.3;
  for (const float found : EvaluateSpectrum(samples, options).alpha) {
    EXPECT_NEAR(alpha, found, 1e-6);
  }
  options.undo_prefilter = false;
  for (const float found : EvaluateSpectrum(samples, options).alpha) {
    EXPECT_GT(alpha, found);
  }
}

TEST(SpectrumEntropy, IsFiniteForAnyInput) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value :
       {0.0f, -1.0f, 1e-30f, 1e-19f, 1e10f, 3e38f, kInfinity, std::nanf("")}) {
    for (const int views : {1, 3, 50}) {
      for (const SpectrumOptions& options :
           {SpectrumOptions(), SpectrumOptions::Published(1e-5)}) {
        TexelSamples samples = Samples(3, views, 0.1, 0.5, 0.5);
        for (size_t k = 0; k < samples.outgoing.size(); k += 2) {
          samples.outgoing[k] = value;
          samples.incoming[samples.outgoing.size() - 1 - k] = value;
        }
        const EntropyMaps maps = EvaluateSpectrum(samples, options);
        for (size_t k = 0; k < maps.entropy.size(); ++k) {
          EXPECT_TRUE(maps.entropy[k] >= 0.0f && maps.entropy[k] <= 1.0f)
              << value;
          EXPECT_TRUE(std::isfinite(maps.misfit[k]));
          EXPECT_TRUE(std::isfinite(maps.deviations[k]));
        }
      }
    }
  }
}

TEST(SpectrumEntropy, APriorNarrowsIt) {
  SpectrumOptions options;
  options.prior.assign(64, 1e-6);
  options.prior[20] = 1.0;
  TexelSamples unseen = EmptySamples(1, 4);
  unseen.weight.assign(4, 0.0f);
  EXPECT_LT(EvaluateSpectrum(unseen, options).entropy[0], 0.01f);
}

TEST(SpectrumOptions, BadOnesAreNamed) {
  EXPECT_TRUE(SpectrumOptions().Check().ok());
  EXPECT_TRUE(SpectrumOptions::Published(1e-5).Check().ok());
  EXPECT_TRUE(CheckNames<SpectrumOptions>("num_alpha",
                                          [](auto* o) { o->num_alpha = 1; }));
  EXPECT_TRUE(
      CheckNames<SpectrumOptions>("num_ks", [](auto* o) { o->num_ks = 257; }));
  EXPECT_TRUE(
      CheckNames<SpectrumOptions>("sigma", [](auto* o) { o->sigma = 0.0; }));
  EXPECT_TRUE(CheckNames<SpectrumOptions>(
      "floor", [](auto* o) { o->relative_floor = 0.0; }));
  EXPECT_TRUE(
      CheckNames<SpectrumOptions>("prior", [](auto* o) { o->prior = {1.0}; }));
  EXPECT_TRUE(CheckNames<SpectrumOptions>(
      "prior", [](auto* o) { o->prior.assign(64, -1.0); }));
  EXPECT_TRUE(
      CheckNames<SpectrumOptions>("order", [](auto* o) { o->fit.order = 0; }));
}

TEST(SpectrumEntropyEvaluator, RefusesBadSamples) {
  TexelSamples samples = EmptySamples(2, 3);
  samples.outgoing.pop_back();
  EXPECT_EQ(StatusCode::kInvalidInput,
            SpectrumEntropyEvaluator({}).Evaluate(samples, 1).status().code());
}

}  // namespace
}  // namespace ibrdf
