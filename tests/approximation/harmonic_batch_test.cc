#include "ibrdf/approximation/harmonic_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/base/to_float.h"

namespace ibrdf {
namespace {

// What the header promises up to order 10.
constexpr double kTolerance = 2e-6;

struct Directions {
  std::vector<float> polar, zero, side;

  int count() const { return static_cast<int>(polar.size()); }
  void Add(double p, double z, double s) {
    polar.push_back(static_cast<float>(p));
    zero.push_back(static_cast<float>(z));
    side.push_back(static_cast<float>(s));
  }
};

// All over the sphere, both poles, and so close to them that a sine found from
// the cosine would have no correct digit.
Directions ManyDirections() {
  Directions out;
  out.Add(1, 0, 0);
  out.Add(-1, 0, 0);
  out.Add(0, 1, 0);
  out.Add(0, 0, -1);
  for (const double theta : {1e-7, 1e-5, 3e-4, 1e-2}) {
    out.Add(std::cos(theta), std::sin(theta) * 0.6, std::sin(theta) * 0.8);
    out.Add(-std::cos(theta), std::sin(theta) * 0.6, -std::sin(theta) * 0.8);
  }
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5000; ++i) {
    const double x = normal(rng), y = normal(rng), z = normal(rng);
    const double size = std::sqrt(x * x + y * y + z * z);
    out.Add(x / size, y / size, z / size);
  }
  return out;
}

double LargestError(int order, const Directions& u, const float* Y,
                    int64_t stride) {
  const HarmonicBasis basis(order);
  std::vector<double> expected(basis.count());
  double largest = 0.0;
  for (int i = 0; i < u.count(); ++i) {
    // HarmonicBasis takes directions of maps: +y is the polar axis.
    basis.Evaluate({u.side[i], u.polar[i], u.zero[i]}, expected.data());
    for (int k = 0; k < basis.count(); ++k) {
      largest = std::max(largest, std::abs(expected[k] - Y[k * stride + i]));
    }
  }
  return largest;
}

TEST(HarmonicBatch, AgreesWithTheBasisInDoublePrecision) {
  const Directions u = ManyDirections();
  for (const int order : {0, 1, 2, 5, 8, 10}) {
    const HarmonicBatch batch(order);
    const int64_t stride = u.count() + 3;
    std::vector<float> Y(batch.count() * stride, -7.0f);
    batch.Evaluate(u.polar.data(), u.zero.data(), u.side.data(), u.count(),
                   Y.data(), stride);
    EXPECT_LT(LargestError(order, u, Y.data(), stride), kTolerance) << order;
    // Nothing behind the directions is written.
    for (int k = 0; k < batch.count(); ++k) {
      EXPECT_EQ(-7.0f, Y[k * stride + u.count()]);
    }
  }
}

TEST(HarmonicBatch, EveryInstructionSetAgrees) {
  using Evaluate = void (*)(const HarmonicConstants&, const float*,
                            const float*, const float*, int, float*, int64_t);
  std::vector<std::pair<SimdLevel, Evaluate>> kernels{
      {SimdLevel::kPortable, portable::EvaluateHarmonics}};
#if defined(IBRDF_HAVE_X86_KERNELS)
  kernels.emplace_back(SimdLevel::kAvx2, avx2::EvaluateHarmonics);
  kernels.emplace_back(SimdLevel::kAvx512, avx512::EvaluateHarmonics);
#endif
  const int order = 10;
  const HarmonicBasis basis(order);
  const std::vector<float> diagonal = ToFloat(basis.diagonal()),
                           up = ToFloat(basis.up()),
                           down = ToFloat(basis.down());
  const HarmonicConstants constants{order, diagonal.data(), up.data(),
                                    down.data()};
  const Directions u = ManyDirections();
  for (const auto& [level, evaluate] : kernels) {
    if (!SimdLevelSupported(level)) continue;
    std::vector<float> Y(basis.count() * u.count());
    evaluate(constants, u.polar.data(), u.zero.data(), u.side.data(), u.count(),
             Y.data(), u.count());
    EXPECT_LT(LargestError(order, u, Y.data(), u.count()), kTolerance)
        << SimdLevelName(level);
  }
}

TEST(HarmonicBatch, AnyNumberOfDirectionsGivesTheSameBits) {
  const Directions u = ManyDirections();
  const HarmonicBatch batch(5);
  std::vector<float> all(batch.count() * 64), few(batch.count() * 64);
  batch.Evaluate(u.polar.data(), u.zero.data(), u.side.data(), 64, all.data(),
                 64);
  for (const int count : {1, 3, 15, 17, 33}) {
    batch.Evaluate(u.polar.data(), u.zero.data(), u.side.data(), count,
                   few.data(), 64);
    for (int k = 0; k < batch.count(); ++k) {
      for (int i = 0; i < count; ++i) {
        EXPECT_EQ(all[k * 64 + i], few[k * 64 + i]);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
