#include "ibrdf/light/illumination_unet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/illumination_unet_reference.h"

namespace ibrdf {
namespace {

using Doubles = std::vector<double>;
using Floats = std::vector<float>;

// Central differences at the step below: truncation up to 1e-7, cancellation
// 1e-9.
constexpr double kDifferenceTolerance = 1e-6;
// Products of a few hundred thousand terms in double.
constexpr double kDoubleRounding = 1e-11;
// Float rounding through about twenty layers of sums of hundreds of terms.
constexpr double kNetworkRounding = 2e-5;
constexpr double kFloatAdjointTolerance = 1e-4;

IlluminationUnetOptions Options(int width, int height, int scales, int channels,
                                int skip_channels, int noise_channels) {
  IlluminationUnetOptions options;
  options.width = width;
  options.height = height;
  options.scales = scales;
  options.channels = channels;
  options.skip_channels = skip_channels;
  options.noise_channels = noise_channels;
  options.seed = 5;
  options.num_threads = 1;
  return options;
}

IlluminationUnetOptions Plain(IlluminationUnetOptions options) {
  options.normalize = false;
  return options;
}

std::vector<IlluminationUnetOptions> ManyOptions() {
  return {
      Options(128, 64, 4, 32, 8, 8),       Options(64, 32, 4, 32, 8, 8),
      Options(32, 16, 4, 32, 8, 8),        Options(16, 8, 4, 24, 5, 3),
      Options(8, 4, 4, 40, 17, 9),         Options(20, 10, 2, 7, 1, 1),
      Options(32, 16, 2, 16, 0, 4),        Options(6, 3, 4, 8, 2, 2),
      Options(12, 6, 3, 1, 1, 1),          Options(24, 8, 3, 50, 20, 5),
      Plain(Options(64, 32, 4, 32, 8, 8)), Plain(Options(16, 8, 2, 9, 5, 3))};
}

std::string Name(const IlluminationUnetOptions& o) {
  return std::to_string(o.width) + "x" + std::to_string(o.height) + ", " +
         std::to_string(o.scales) + " scales, " + std::to_string(o.channels) +
         "+" + std::to_string(o.skip_channels) + " channels";
}

Doubles ToDouble(const Floats& x) { return Doubles(x.begin(), x.end()); }

template <typename T>
std::vector<T> RandomNormal(size_t n, int seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<T> x(n);
  for (T& v : x) v = static_cast<T>(normal(rng));
  return x;
}

// A draw from the prior, the last layer included.
Floats PriorDraw(const IlluminationUnet& unet, int seed) {
  Floats weights = RandomNormal<float>(unet.num_weights(), seed);
  const Floats deviation = unet.PriorStd();
  for (size_t i = 0; i < weights.size(); ++i) weights[i] *= deviation[i];
  return weights;
}

template <typename T>
double Dot(const std::vector<T>& a, const std::vector<T>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}

template <typename T>
double Norm(const std::vector<T>& a) {
  return std::sqrt(Dot(a, a));
}

template <typename A, typename B>
double RelativeError(const std::vector<A>& a, const std::vector<B>& b) {
  double error = 0.0, scale = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    error += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
    scale += double{b[i]} * b[i];
  }
  return scale > 0.0 ? std::sqrt(error / scale) : std::sqrt(error);
}

UnetReference<double> Reference(const IlluminationUnet& unet) {
  return UnetReference<double>(unet.plan(), ToDouble(unet.noise()));
}

// The three passes of the fast implementation.
struct FastPasses {
  Floats log_radiance, jvp, vjp;
};
FastPasses RunFast(const IlluminationUnet& unet, const Floats& weights,
                   const Floats& tangent, const Floats& adjoint) {
  FastPasses passes{Floats(unet.num_outputs()), Floats(unet.num_outputs()),
                    Floats(unet.num_weights())};
  IlluminationUnet::Workspace workspace;
  IlluminationUnet::Scratch scratch;
  unet.Forward(weights.data(), &workspace, passes.log_radiance.data());
  unet.Jvp(tangent.data(), workspace, &scratch, passes.jvp.data());
  unet.Vjp(adjoint.data(), workspace, &scratch, passes.vjp.data());
  return passes;
}

TEST(IlluminationUnetReference, JvpMatchesCentralDifferences) {
  for (const auto& options :
       {Options(16, 8, 4, 8, 3, 4), Options(8, 4, 2, 6, 2, 2),
        Options(32, 16, 3, 6, 0, 3), Plain(Options(16, 8, 4, 8, 3, 4))}) {
    const IlluminationUnet unet(options);
    const auto reference = Reference(unet);
    for (const double scale : {1.0, 10.0, 1e-3, 0.0}) {
      Doubles weights = ToDouble(PriorDraw(unet, 1));
      for (double& w : weights) w *= scale;
      const Doubles tangent = ToDouble(PriorDraw(unet, 2));
      const auto pass = reference.Forward(weights);
      const Doubles jvp = reference.Jvp(weights, tangent, pass);
      // Truncation at 1e-5 is 8e-6 where features of weights ten times the
      // prior's sweep through the activation's bend; it falls with the square.
      const double step = 1e-6;
      Doubles plus = weights, minus = weights;
      for (size_t i = 0; i < weights.size(); ++i) {
        plus[i] += step * tangent[i];
        minus[i] -= step * tangent[i];
      }
      Doubles difference = reference.Forward(plus).log_radiance();
      const Doubles below = reference.Forward(minus).log_radiance();
      for (size_t i = 0; i < difference.size(); ++i) {
        difference[i] = (difference[i] - below[i]) / (2.0 * step);
      }
      EXPECT_GT(Norm(jvp), 0.0);
      EXPECT_LT(RelativeError(jvp, difference), kDifferenceTolerance)
          << Name(options) << ", weights x " << scale;
    }
  }
}

TEST(IlluminationUnetReference, VjpIsTheAdjointOfJvp) {
  for (const auto& options : ManyOptions()) {
    if (options.width > 32) continue;  // slow
    const IlluminationUnet unet(options);
    const auto reference = Reference(unet);
    for (const double scale : {1.0, 10.0, 1e-3, 0.0}) {
      Doubles weights = ToDouble(PriorDraw(unet, 1));
      for (double& w : weights) w *= scale;
      const Doubles v = ToDouble(PriorDraw(unet, 2));
      const Doubles u = RandomNormal<double>(unet.num_outputs(), 3);
      const auto pass = reference.Forward(weights);
      const Doubles jv = reference.Jvp(weights, v, pass);
      const Doubles jtu = reference.Vjp(weights, u, pass);
      EXPECT_NEAR(Dot(u, jv), Dot(jtu, v),
                  kDoubleRounding * (Norm(u) * Norm(jv) + Norm(jtu) * Norm(v)))
          << Name(options) << ", weights x " << scale;
    }
  }
}

TEST(IlluminationUnet, AgreesWithTheDoubleReferenceAtEverySimdLevel) {
  for (const auto& options : ManyOptions()) {
    const IlluminationUnet unet(options);
    const auto reference = Reference(unet);
    for (const float scale : {1.0f, 0.01f, 0.0f}) {
      if (scale != 1.0f && options.width > 32) continue;  // slow
      Floats weights = PriorDraw(unet, 1);
      for (float& w : weights) w *= scale;
      const Floats v = PriorDraw(unet, 2);
      const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
      const auto pass = reference.Forward(ToDouble(weights));
      const Doubles jv = reference.Jvp(ToDouble(weights), ToDouble(v), pass);
      const Doubles jtu = reference.Vjp(ToDouble(weights), ToDouble(u), pass);
      for (const SimdLevel level :
           {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
        if (!SimdLevelSupported(level)) continue;
        SCOPED_TRACE(Name(options) + ", weights x " + std::to_string(scale) +
                     ", " + SimdLevelName(level));
        const IlluminationUnet fast(options, unet.noise(), level);
        const FastPasses passes = RunFast(fast, weights, v, u);
        EXPECT_LT(RelativeError(passes.log_radiance, pass.log_radiance()),
                  kNetworkRounding);
        EXPECT_LT(RelativeError(passes.jvp, jv), kNetworkRounding);
        EXPECT_LT(RelativeError(passes.vjp, jtu), kNetworkRounding);
      }
    }
  }
}

TEST(IlluminationUnet, LevelDoubleIsTheReferenceRoundedOnce) {
  const IlluminationUnetOptions options = ManyOptions().front();
  const IlluminationUnet any(options);
  const IlluminationUnet unet(options, any.noise(), SimdLevel::kDouble);
  const auto reference = Reference(unet);
  const Floats weights = PriorDraw(unet, 1), v = PriorDraw(unet, 2);
  const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
  const auto pass = reference.Forward(ToDouble(weights));
  const auto rounded = [](const Doubles& x) {
    return Floats(x.begin(), x.end());
  };
  const FastPasses passes = RunFast(unet, weights, v, u);
  EXPECT_EQ(rounded(pass.log_radiance()), passes.log_radiance);
  EXPECT_EQ(rounded(reference.Jvp(ToDouble(weights), ToDouble(v), pass)),
            passes.jvp);
  EXPECT_EQ(rounded(reference.Vjp(ToDouble(weights), ToDouble(u), pass)),
            passes.vjp);
}

TEST(IlluminationUnet, VjpIsTheAdjointOfJvp) {
  for (const auto& options : ManyOptions()) {
    const IlluminationUnet unet(options);
    for (const float scale : {1.0f, 3.0f, 0.1f}) {
      Floats weights = PriorDraw(unet, 1);
      for (float& w : weights) w *= scale;
      const Floats v = PriorDraw(unet, 2);
      const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
      const FastPasses passes = RunFast(unet, weights, v, u);
      EXPECT_NEAR(Dot(u, passes.jvp), Dot(passes.vjp, v),
                  kFloatAdjointTolerance * Norm(u) * Norm(passes.jvp))
          << Name(options) << ", weights x " << scale;
    }
  }
}

TEST(IlluminationUnet, ThreadCountDoesNotChangeABit) {
  for (const auto& base :
       {Options(64, 32, 4, 32, 8, 8), Options(32, 16, 3, 40, 17, 9)}) {
    std::vector<FastPasses> all;
    for (const int threads : {1, 2, 8}) {
      IlluminationUnetOptions options = base;
      options.num_threads = threads;
      const IlluminationUnet unet(options);
      all.push_back(RunFast(unet, PriorDraw(unet, 1), PriorDraw(unet, 2),
                            RandomNormal<float>(unet.num_outputs(), 3)));
    }
    for (const FastPasses& passes : all) {
      EXPECT_EQ(all[0].log_radiance, passes.log_radiance);
      EXPECT_EQ(all[0].jvp, passes.jvp);
      EXPECT_EQ(all[0].vjp, passes.vjp);
    }
  }
}

TEST(IlluminationUnet, ScratchMayBeReusedByProductsAndNetworks) {
  IlluminationUnet::Workspace workspace;
  IlluminationUnet::Scratch scratch;
  for (const auto& options :
       {Options(16, 8, 2, 20, 5, 3), Options(16, 8, 2, 28, 7, 3)}) {
    const IlluminationUnet unet(options);
    const Floats v = PriorDraw(unet, 2);
    const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
    for (const int seed : {1, 4}) {
      const Floats weights = PriorDraw(unet, seed);
      const FastPasses fresh = RunFast(unet, weights, v, u);
      FastPasses again = fresh;
      unet.Forward(weights.data(), &workspace, again.log_radiance.data());
      for (int repeat = 0; repeat < 2; ++repeat) {
        unet.Vjp(u.data(), workspace, &scratch, again.vjp.data());
        unet.Jvp(v.data(), workspace, &scratch, again.jvp.data());
        EXPECT_EQ(fresh.log_radiance, again.log_radiance);
        EXPECT_EQ(fresh.vjp, again.vjp);
        EXPECT_EQ(fresh.jvp, again.jvp);
      }
    }
  }
}

// Noise turned by a multiple of the coarsest texel turns the map alike (but for
// the order of the normalisation's sums); by less it does not.
TEST(IlluminationUnet, TurnsWithItsNoise) {
  const IlluminationUnetOptions options = Options(64, 32, 3, 16, 4, 4);
  const IlluminationUnet unet(options);
  const Floats weights = PriorDraw(unet, 1);
  const auto turned = [&](const Floats& planes, int columns) {
    Floats result(planes.size());
    for (size_t i = 0; i < planes.size(); ++i) {
      const size_t row_start = i - i % options.width;
      result[row_start + (i + columns) % options.width] = planes[i];
    }
    return result;
  };
  const auto map = [&](const Floats& noise) {
    const IlluminationUnet other(options, noise);
    Floats log_radiance(other.num_outputs());
    IlluminationUnet::Workspace workspace;
    other.Forward(weights.data(), &workspace, log_radiance.data());
    return log_radiance;
  };
  const Floats base = map(unet.noise());
  for (const int columns : {8, 16, 32, 56}) {
    EXPECT_LT(RelativeError(map(turned(unet.noise(), columns)),
                            turned(base, columns)),
              kNetworkRounding);
  }
  EXPECT_GT(RelativeError(map(turned(unet.noise(), 4)), turned(base, 4)), 0.01);
}

const WeightBlock& Block(const UnetPlan& plan, const std::string& name) {
  for (const WeightBlock& block : plan.blocks) {
    if (block.name == name) return block;
  }
  ADD_FAILURE() << "no block " << name;
  return plan.blocks[0];
}

double Activated(double x) {
  return 0.5 * (1.0 + kUnetLeak) * x +
         0.5 * (1.0 - kUnetLeak) *
             (std::sqrt(x * x + kUnetCurvature * kUnetCurvature) -
              kUnetCurvature);
}

// A function that is smooth on the sphere, poles included.
double SmoothOnSphere(double theta, double phi) {
  const double x = std::sin(theta) * std::sin(phi);
  const double z = std::sin(theta) * std::cos(phi);
  return 0.7 * x - 0.4 * std::cos(theta) + 0.5 * z * x + 0.3 * z;
}

// Largest error of the first map channel against `expected` of (theta, phi),
// over all texels, for a network of one channel whose weights `set` chooses.
template <typename SetWeights, typename Expected>
double LargestError(int height, const SetWeights& set,
                    const Expected& expected) {
  const IlluminationUnetOptions options =
      Plain(Options(2 * height, height, 1, 1, 1, 1));
  const double h = kPi / height;
  Floats noise;
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < 2 * height; ++c) {
      noise.push_back(
          static_cast<float>(SmoothOnSphere((r + 0.5) * h, (c + 0.5) * h)));
    }
  }
  const IlluminationUnet unet(options, noise);
  Floats weights(unet.num_weights(), 0.0f);
  set(unet.plan(), &weights);
  Floats map(unet.num_outputs());
  IlluminationUnet::Workspace workspace;
  unet.Forward(weights.data(), &workspace, map.data());
  double error = 0.0;
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < 2 * height; ++c) {
      error = std::max(error, std::abs(map[r * 2 * height + c] -
                                       expected((r + 0.5) * h, (c + 0.5) * h)));
    }
  }
  return error;
}

// A blur of a smooth function errs by the square of the texel size, at the
// poles too when rows continue over them; a border that repeats or mirrors the
// last row without the half turn errs by the first power there.
TEST(IlluminationUnet, ConvolutionsContinueOverThePoles) {
  const auto blur_skip_branch = [](const UnetPlan& plan, Floats* weights) {
    (*weights)[Block(plan, "scale0.skip.weight").offset] = 1.0f;
    const int merge = Block(plan, "scale0.merge3.weight").offset;
    const float tent[3] = {0.25f, 0.5f, 0.25f};
    for (int tap = 0; tap < 9; ++tap) {
      // Inputs in order: the upsampled channel, the skip channel.
      (*weights)[merge + 2 * tap + 1] = tent[tap / 3] * tent[tap % 3];
    }
    (*weights)[Block(plan, "scale0.merge1.weight").offset] = 1.0f;
    (*weights)[Block(plan, "output.weight").offset] = 1.0f;
  };
  const auto expected = [](double theta, double phi) {
    return Activated(Activated(Activated(SmoothOnSphere(theta, phi))));
  };
  const double coarse = LargestError(16, blur_skip_branch, expected);
  const double fine = LargestError(64, blur_skip_branch, expected);
  EXPECT_LT(coarse, 0.05);
  // Second order divides by 16, first order by 4.
  EXPECT_LT(fine, coarse / 12.0);
}

// Likewise for the way down, the mean of four texels, and the bilinear way up:
// neither moves the map, so that what lies beyond a pole fits on.
TEST(IlluminationUnet, ScalesContinueOverThePoles) {
  const auto pass_deep_branch = [](const UnetPlan& plan, Floats* weights) {
    for (const int centre : {5, 6, 9, 10}) {  // of 4 x 4
      (*weights)[Block(plan, "scale0.down1.weight").offset + centre] = 0.25f;
    }
    (*weights)[Block(plan, "scale0.down2.weight").offset + 4] = 1.0f;
    (*weights)[Block(plan, "scale0.merge3.weight").offset + 8] = 1.0f;
    (*weights)[Block(plan, "scale0.merge1.weight").offset] = 1.0f;
    (*weights)[Block(plan, "output.weight").offset] = 1.0f;
  };
  const auto expected = [](double theta, double phi) {
    double value = SmoothOnSphere(theta, phi);
    for (int layer = 0; layer < 4; ++layer) value = Activated(value);
    return value;
  };
  const double coarse = LargestError(16, pass_deep_branch, expected);
  const double fine = LargestError(64, pass_deep_branch, expected);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, coarse / 12.0);
}

TEST(IlluminationUnet, StartsAtAConstantMapAndIsAlive) {
  for (const auto& options : ManyOptions()) {
    const IlluminationUnet unet(options);
    Floats weights = unet.InitialWeights(7);
    EXPECT_EQ(weights, unet.InitialWeights(7));
    const WeightBlock& bias = unet.plan().blocks.back();
    ASSERT_EQ("output.bias", bias.name);
    ASSERT_EQ(3, bias.size);
    EXPECT_EQ(unet.num_weights(), bias.offset + bias.size);
    for (int c = 0; c < 3; ++c) weights[bias.offset + c] = 0.5f - c;
    const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
    const FastPasses passes = RunFast(unet, weights, weights, u);
    const int texels = options.width * options.height;
    for (int i = 0; i < unet.num_outputs(); ++i) {
      ASSERT_EQ(0.5f - static_cast<float>(i / texels), passes.log_radiance[i]);
    }
    // Gradients reach the last layer: the start is no stationary point.
    const WeightBlock& output = Block(unet.plan(), "output.weight");
    double largest = 0.0;
    for (int i = 0; i < output.size; ++i) {
      largest =
          std::max(largest, std::abs(double{passes.vjp[output.offset + i]}));
    }
    EXPECT_GT(largest, 0.0);
  }
}

// Root mean square of the map over prior draws: about the output's standard
// deviation, neither vanishing nor exploding with depth.
TEST(IlluminationUnet, PriorDrawsHaveVarianceOfOrderOne) {
  for (const auto& options :
       {Options(128, 64, 4, 32, 8, 8), Options(32, 16, 3, 16, 4, 8)}) {
    const IlluminationUnet unet(options);
    IlluminationUnet::Workspace workspace;
    Floats map(unet.num_outputs());
    double power = 0.0;
    constexpr int kDraws = 8;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Floats weights = PriorDraw(unet, 10 + draw);
      unet.Forward(weights.data(), &workspace, map.data());
      power += Dot(map, map) / static_cast<double>(map.size()) / kDraws;
    }
    EXPECT_GT(std::sqrt(power), 0.5);
    EXPECT_LT(std::sqrt(power), 3.0);
  }
}

TEST(IlluminationUnet, ExtremeWeightsStayFinite) {
  for (const auto& options : ManyOptions()) {
    const IlluminationUnet unet(options);
    const Floats v = PriorDraw(unet, 2);
    const Floats u = RandomNormal<float>(unet.num_outputs(), 3);
    for (const float scale : {100.0f, 1e-20f, 1e-38f, 0.0f}) {
      Floats weights = PriorDraw(unet, 1);
      for (float& w : weights) w *= scale;
      const FastPasses passes = RunFast(unet, weights, v, u);
      for (const Floats* values :
           {&passes.log_radiance, &passes.jvp, &passes.vjp}) {
        EXPECT_TRUE(std::all_of(values->begin(), values->end(),
                                [](float x) { return std::isfinite(x); }))
            << Name(options) << ", weights x " << scale;
      }
    }
  }
}

TEST(UnetPlan, UsesAsManyScalesAsTheMapAllows) {
  const auto scales = [](int width, int height, int most) {
    return MakeUnetPlan(Options(width, height, most, 4, 2, 2)).scales;
  };
  EXPECT_EQ(4, scales(128, 64, 4));
  EXPECT_EQ(5, scales(128, 64, 6));
  EXPECT_EQ(4, scales(64, 32, 4));
  EXPECT_EQ(3, scales(32, 16, 4));
  EXPECT_EQ(1, scales(8, 4, 4));
  EXPECT_EQ(1, scales(100, 50, 4));
  EXPECT_EQ(0, scales(6, 3, 4));
  EXPECT_EQ(0, scales(2, 1, 4));
}

TEST(UnetPlan, BlocksCoverTheWeights) {
  for (const auto& options : ManyOptions()) {
    const UnetPlan plan = MakeUnetPlan(options);
    int offset = 0;
    for (const WeightBlock& block : plan.blocks) {
      EXPECT_EQ(offset, block.offset) << block.name;
      EXPECT_GT(block.size, 0) << block.name;
      offset += block.size;
    }
    EXPECT_EQ(plan.num_weights, offset);
  }
}

}  // namespace
}  // namespace ibrdf
