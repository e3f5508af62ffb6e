// Random inputs of the properties: ordinary and extreme ones.
#pragma once
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/image/image.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {

// Checks a property whose cases are slow: so many of a hundred that are asked
// for (RC_PARAMS), and at least two, the least and the largest size.
template <typename Testable>
void CheckSome(int percent, const Testable& property) {
  using namespace rc::detail;  // NOLINT
  TestParams params = configuration().testParams;
  params.disableShrinking = true;
  params.maxSuccess = std::max(2, params.maxSuccess * percent / 100);
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  TestMetadata metadata;
  metadata.description = test->name();
  metadata.id = std::string(test->test_suite_name()) + "/" + test->name();
  const rc::detail::TestResult result =
      checkTestable(property, metadata, params);
  if (result.template is<SuccessResult>()) return;
  std::ostringstream text;
  printResultMessage(result, text);
  FAIL() << text.str();
}

// In [0, 1], both ends among them.
inline rc::Gen<double> Unit() {
  return rc::gen::map(rc::gen::inRange(0, 1 << 20 | 1),
                      [](int i) { return i / static_cast<double>(1 << 20); });
}

inline rc::Gen<double> Between(double low, double high) {
  return rc::gen::map(Unit(), [=](double u) { return low + (high - low) * u; });
}

// Magnitudes evenly over the orders between, both > 0.
inline rc::Gen<double> Magnitude(double low, double high) {
  return rc::gen::map(Between(std::log(low), std::log(high)),
                      [](double x) { return std::exp(x); });
}

// Any of [0, count), of small cases too (inRange alone begins at 0).
inline rc::Gen<int> Choice(int count) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, count));
}

// Any bits: negative zero, denormals, infinities, not numbers; the ends of
// what float and half hold among them.
inline std::vector<float> AnyFloats(size_t count) {
  using Limits = std::numeric_limits<float>;
  const float ends[] = {0.0f,
                        -0.0f,
                        Limits::denorm_min(),
                        Limits::min(),
                        Limits::max(),
                        Limits::infinity(),
                        Limits::quiet_NaN(),
                        std::ldexp(1.0f, -25),
                        65504.0f,
                        65520.0f};
  std::mt19937_64 rng(*rc::gen::arbitrary<uint64_t>());
  std::vector<float> values(count);
  for (float& v : values) {
    const auto bits = static_cast<uint32_t>(rng());
    std::memcpy(&v, &bits, 4);
    if (rng() % 8 == 0) v = ends[rng() % 10] * (rng() % 2 == 0 ? 1.0f : -1.0f);
  }
  return values;
}

// Any finite bits.
inline std::vector<double> AnyFiniteDoubles(size_t count) {
  std::mt19937_64 rng(*rc::gen::arbitrary<uint64_t>());
  std::vector<double> values(count);
  for (double& v : values) {
    do {
      const uint64_t bits = rng();
      std::memcpy(&v, &bits, 8);
    } while (!std::isfinite(v));
  }
  return values;
}

// Unit vectors with z >= least; a share of them at the limb and the pole.
inline Eigen::Vector3d AnyDirectionAbove(double least) {
  const double z = *rc::gen::oneOf(Between(least, 1.0),
                                   Between(least, std::min(1.0, least + 1e-3)),
                                   Between(1.0 - 1e-9, 1.0));
  const double phi = *Between(-3.14159265358979, 3.14159265358979);
  const double s = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {s * std::cos(phi), s * std::sin(phi), z};
}

// A map of any radiance >= 0: dim, bright, with black texels.
inline Image AnyMap(int height, int width) {
  Image map(width, height);
  const double scale = *Magnitude(1e-12, 1e12);
  const double range = *Magnitude(1.0, 1e6);
  const auto texels = *rc::gen::container<std::vector<double>>(
      map.rgb.size(),
      rc::gen::weightedOneOf<double>(
          {{9, Magnitude(1.0, range + 1e-9)}, {1, rc::gen::just(0.0)}}));
  for (size_t i = 0; i < map.rgb.size(); ++i) {
    map.rgb[i] = static_cast<float>(scale * texels[i]);
  }
  return map;
}

// A model of three random materials, from nearly flat to steep.
inline NeuralBrdfModel AnyModel() {
  return TinyModel(3, *rc::gen::inRange<uint64_t>(1, 1000),
                   static_cast<float>(*Between(0.0, 30.0)));
}

// Lobe parameters with codes inside, on and beyond the unit sphere.
inline std::vector<double> AnyLobes(const NeuralBrdfModel& model, int lobes) {
  const int size = model.shape.code_size();
  std::vector<double> parameters;
  for (int k = 0; k < lobes; ++k) {
    Eigen::VectorXd z(size);
    for (int d = 0; d < size; ++d) z[d] = *Between(-1.0, 1.0);
    const double norm = *rc::gen::oneOf(Between(0.0, 1.0), rc::gen::just(1.0),
                                        Between(1.0, 1.5));
    if (z.norm() > 0.0) z *= norm / z.norm();
    parameters.insert(parameters.end(), z.data(), z.data() + size);
    for (int c = 0; c < 3; ++c) parameters.push_back(*Between(-20.0, 12.0));
  }
  return parameters;
}

}  // namespace ibrdf
