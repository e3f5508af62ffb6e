#include "ibrdf/uncertainty/angular_entropy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/base/pi.h"
#include "tests/uncertainty/random_samples.h"
#include "tests/uncertainty/spoilt_options.h"

namespace ibrdf {
namespace {

constexpr int kViews = 120;

EntropyMaps EvaluateAngular(const TexelSamples& samples,
                            const AngularOptions& options = {},
                            int threads = 1) {
  return AngularEntropyEvaluator(options).Evaluate(samples, threads).value();
}

// Eq. 20 to 25 for a light of harmonics L, one channel, in plain loops.
double Radiance(const AngularOptions& options, const Eigen::VectorXd& L,
                const Eigen::VectorXd& Y, double cosine, double alpha,
                double Ks, double matte, double prefilter_alpha) {
  double gloss = 0.0;
  for (int l = 0; l <= options.fit.order; ++l) {
    double filter = FilterOf(options.filter, alpha, l);
    if (options.undo_prefilter) {
      filter *= std::exp(prefilter_alpha * l * prefilter_alpha * l);
    }
    gloss +=
        filter * Y.segment(l * l, 2 * l + 1).dot(L.segment(l * l, 2 * l + 1));
  }
  if (options.masking) {
    const double tangent = std::tan(std::acos(cosine));
    const double lambda =
        0.5 * (std::sqrt(1.0 + alpha * alpha * tangent * tangent) - 1.0);
    gloss /= (1.0 + lambda) * (1.0 + lambda);
  }
  const double schlick = options.fresnel ? std::pow(1.0 - cosine, 5) : 0.0;
  return matte + (Ks + (1.0 - Ks) * schlick) * gloss;
}

// A surface of the evaluator's own model, irradiance given. The light has the
// order of the fit.
TexelSamples ModelSamples(const AngularOptions& options, double alpha,
                          double Ks, double Kd) {
  constexpr int kTexels = 20;
  std::mt19937 rng(31);
  TexelSamples samples = EmptySamples(kTexels, kViews);
  RandomDirections(&rng, &samples);
  samples.irradiance.assign(3 * kTexels, 3.0f);
  std::normal_distribution<double> normal;
  const HarmonicBasis basis(options.fit.order);
  Eigen::VectorXd Y(basis.count()), L(basis.count());
  for (int texel = 0; texel < kTexels; ++texel) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < basis.count(); ++k) L[k] = 0.5 * normal(rng);
      L[0] = 3.5;
      for (int view = 0; view < kViews; ++view) {
        const size_t at = 3 * (static_cast<size_t>(texel) * kViews + view);
        const float* const w = &samples.directions[at];
        if (w[2] <= 0.0f) continue;
        basis.Evaluate({w[1], w[2], w[0]}, Y.data());
        samples.incoming[at + c] = static_cast<float>(Y.dot(L));
        samples.outgoing[at + c] = static_cast<float>(
            Radiance(options, L, Y, w[2], alpha, Ks, Kd * 3.0 / kPi, 0.0));
      }
    }
  }
  return samples;
}

// Well-determined fits.
AngularOptions FewHarmonics() {
  AngularOptions options;
  options.fit.order = 3;
  options.fit.lambda = 1e-9;
  return options;
}

// Entropy of one channel of a texel, cell by cell and view by view.
double PlainEntropy(const TexelSamples& samples, const AngularOptions& options,
                    int texel, int channel) {
  const HarmonicBasis basis(options.fit.order);
  Eigen::VectorXd Y(basis.count()), value(1);
  SequentialFit fit(options.fit, 1);
  const auto harmonics = [&](int view) {
    const float* const w =
        &samples.directions[3 * (texel * samples.num_views + view)];
    basis.Evaluate({w[1], w[2], w[0]}, Y.data());
    return double{w[2]};
  };
  const auto seen = [&](int view) {
    const int at = texel * samples.num_views + view;
    return samples.directions[3 * at + 2] > 0.0f ? samples.weight[at] : 0.0f;
  };
  const double unit = samples.mean_radiance;
  for (int view = 0; view < samples.num_views; ++view) {
    const double cosine = harmonics(view);
    value[0] =
        samples.incoming[3 * (texel * samples.num_views + view) + channel] /
        unit;
    fit.Add(Y, seen(view) * cosine * cosine, value);
  }
  const Eigen::VectorXd L = fit.coefficients();
  const double white = samples.irradiance[3 * texel + channel] / unit / kPi;
  std::vector<double> p;
  double total = 0.0;
  for (const double alpha :
       AlphaValues(options.alpha_grid, options.num_alpha)) {
    for (const double Ks : UnitValues(options.num_ks)) {
      for (const double Kd : UnitValues(options.num_kd)) {
        double sum = 0.0, weights = 0.0;
        for (int view = 0; view < samples.num_views; ++view) {
          if (seen(view) <= 0.0f) continue;
          const double cosine = harmonics(view);
          const double B =
              samples
                  .outgoing[3 * (texel * samples.num_views + view) + channel] /
              unit;
          const double r = Radiance(options, L, Y, cosine, alpha, Ks,
                                    Kd * white, samples.prefilter_alpha) -
                           B;
          sum += seen(view) * r * r;
          weights += seen(view);
        }
        p.push_back(
            std::exp(-sum / weights / (2.0 * options.sigma * options.sigma)));
        total += p.back();
      }
    }
  }
  double H = 0.0;
  for (const double x : p) {
    if (x > 0.0) H -= x / total * std::log(x / total);
  }
  return H / std::log(double(p.size()));
}

TEST(AngularEntropy, AgreesWithThePlainSum) {
  constexpr double kSinglePrecision = 5e-5;
  for (const bool simple : {false, true}) {
    AngularOptions options;
    options.num_alpha = 4;
    options.num_ks = 5;
    options.num_kd = 6;
    options.fresnel = options.masking = !simple;
    options.undo_prefilter = !simple;
    options.filter = simple ? GlossFilter::kBeckmann : GlossFilter::kGgx;
    options.sigma = 0.2;
    TexelSamples samples = ModelSamples(options, 0.15, 0.4, 0.3);
    samples.mean_radiance = 1.7;
    samples.prefilter_alpha = 0.1;
    for (size_t k = 0; k < samples.weight.size(); k += 3) {
      samples.weight[k] = k % 2 == 0 ? 0.0f : 0.4f;
    }
    const EntropyMaps maps = EvaluateAngular(samples, options);
    for (const int texel : {0, 7, 19}) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(PlainEntropy(samples, options, texel, c),
                    maps.entropy[3 * texel + c], kSinglePrecision);
      }
    }
  }
}

TEST(AngularEntropy, FindsTheParametersOfItsOwnModel) {
  AngularOptions options = FewHarmonics();
  const double alpha = 9.0 / 49.0;
  for (const int num_kd : {8, 0}) {
    options.num_kd = num_kd;
    const EntropyMaps maps =
        EvaluateAngular(ModelSamples(options, alpha, 0.33, 0.44), options);
    for (size_t k = 0; k < maps.alpha.size(); ++k) {
      EXPECT_NEAR(alpha, maps.alpha[k], 1e-6);
      EXPECT_NEAR(0.33, maps.Ks[k], 1e-3);
      EXPECT_NEAR(0.44, maps.Kd[k], 1e-3);
      EXPECT_LT(maps.misfit[k], 1e-6);
    }
  }
}

TEST(AngularEntropy, IrradianceIsThatOfTheFitWhereNoneIsGiven) {
  const AngularOptions options = FewHarmonics();
  TexelSamples samples = ModelSamples(options, 9.0 / 49.0, 0.3, 0.4);
  samples.irradiance.clear();
  // Constant light of radiance 1: irradiance pi, so a white surface shows 1.
  samples.incoming.assign(samples.incoming.size(), 1.0f);
  samples.outgoing.assign(samples.outgoing.size(), 0.4f);
  AngularOptions matte = options;
  matte.fresnel = false;
  matte.num_kd = 8;
  const EntropyMaps maps = EvaluateAngular(samples, matte);
  TexelSamples given = samples;
  given.irradiance.assign(60, static_cast<float>(kPi));
  const EntropyMaps expected = EvaluateAngular(given, matte);
  for (size_t k = 0; k < maps.entropy.size(); ++k) {
    EXPECT_NEAR(expected.entropy[k], maps.entropy[k], 1e-3);
  }
}

TEST(AngularEntropy, IsOneWhereNothingIsSeen) {
  TexelSamples samples = ModelSamples({}, 0.1, 0.5, 0.2);
  for (int view = 0; view < kViews; ++view) {
    samples.weight[5 * kViews + view] = 0.0f;
  }
  AngularOptions options;
  for (const int num_kd : {8, 0}) {
    options.num_kd = num_kd;
    const EntropyMaps maps = EvaluateAngular(samples, options);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(1.0f, maps.entropy[15 + c]);
      EXPECT_GT(1.0f, maps.entropy[12 + c]);
    }
  }
}

TEST(AngularEntropy, DoesNotDependOnTheExposureOrThreads) {
  const TexelSamples samples = ModelSamples({}, 0.1, 0.5, 0.2);
  const EntropyMaps maps = EvaluateAngular(samples);
  EXPECT_EQ(maps.entropy, EvaluateAngular(samples, {}, 2).entropy);
  for (const double factor : {4096.0, 1.7, 0.001}) {
    TexelSamples scaled = samples;
    scaled.mean_radiance *= factor;
    for (std::vector<float>* v :
         {&scaled.incoming, &scaled.outgoing, &scaled.irradiance}) {
      for (float& x : *v) x *= static_cast<float>(factor);
    }
    const EntropyMaps other = EvaluateAngular(scaled);
    for (size_t k = 0; k < maps.entropy.size(); ++k) {
      EXPECT_NEAR(maps.entropy[k], other.entropy[k],
                  factor == 4096.0 ? 0.0 : 1e-5);
    }
  }
}

TEST(AngularEntropy, DoesNotDependOnTheAxesOfTheFrame) {
  constexpr float kTurned = 1e-4f;
  const TexelSamples samples = ModelSamples({}, 0.1, 0.5, 0.2);
  TexelSamples turned = samples;
  for (size_t k = 0; k < samples.weight.size(); ++k) {
    turned.directions[3 * k] = -samples.directions[3 * k + 1];
    turned.directions[3 * k + 1] = samples.directions[3 * k];
  }
  const EntropyMaps maps = EvaluateAngular(samples),
                    other = EvaluateAngular(turned);
  for (size_t k = 0; k < maps.entropy.size(); ++k) {
    EXPECT_NEAR(maps.entropy[k], other.entropy[k], kTurned);
  }
}

TEST(AngularEntropy, IsFiniteForAnyInput) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value : {0.0f, -1.0f, 1e-30f, 1e-19f, 1e-10f, 1e10f, 3e38f,
                            kInfinity, std::nanf("")}) {
    for (const int num_kd : {8, 0}) {
      AngularOptions options;
      options.num_kd = num_kd;
      TexelSamples samples = ModelSamples(options, 0.1, 0.5, 0.5);
      for (size_t k = 0; k < samples.outgoing.size(); k += 2) {
        samples.outgoing[k] = value;
        samples.incoming[samples.outgoing.size() - 1 - k] = value;
      }
      samples.irradiance[4] = value;
      const EntropyMaps maps = EvaluateAngular(samples, options);
      for (size_t k = 0; k < maps.entropy.size(); ++k) {
        EXPECT_TRUE(maps.entropy[k] >= 0.0f && maps.entropy[k] <= 1.0f)
            << value;
        EXPECT_TRUE(std::isfinite(maps.misfit[k]));
        EXPECT_TRUE(std::isfinite(maps.deviations[k]));
        EXPECT_TRUE(maps.Ks[k] >= 0.0f && maps.Ks[k] <= 1.0f);
      }
    }
  }
}

TEST(AngularOptions, BadOnesAreNamed) {
  EXPECT_TRUE(AngularOptions().Check().ok());
  EXPECT_TRUE(CheckNames<AngularOptions>("num_alpha",
                                         [](auto* o) { o->num_alpha = 1; }));
  EXPECT_TRUE(
      CheckNames<AngularOptions>("num_ks", [](auto* o) { o->num_ks = 65; }));
  EXPECT_TRUE(
      CheckNames<AngularOptions>("num_kd", [](auto* o) { o->num_kd = 1; }));
  EXPECT_TRUE(
      CheckNames<AngularOptions>("sigma", [](auto* o) { o->sigma = -1.0; }));
  EXPECT_TRUE(
      CheckNames<AngularOptions>("prior", [](auto* o) { o->prior = {1.0}; }));
  EXPECT_TRUE(
      CheckNames<AngularOptions>("order", [](auto* o) { o->fit.order = 0; }));
}

}  // namespace
}  // namespace ibrdf
