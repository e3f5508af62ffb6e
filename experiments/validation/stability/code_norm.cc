// Codes within and beyond the unit ball.
#include <cmath>
#include <random>
#include <vector>

#include "experiments/validation/stability/naive_flow.h"
#include "experiments/validation/stability/sweeps.h"
#include "ibrdf/base/dual.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/triangular_reference.h"

namespace ibrdf {
namespace stability {
namespace {

constexpr int kCodes = 12, kPoints = 24;  // of each norm, and of each code

// Euclidean norms.
template <typename Value>
double GradientError(const Value& value, const std::vector<Real>& reference) {
  Real square = 0, difference = 0;
  for (size_t k = 0; k < reference.size(); ++k) {
    const Real d = value(static_cast<int>(k)) - reference[k];
    difference += d * d;
    square += reference[k] * reference[k];
  }
  return static_cast<double>(std::sqrt(difference / square));
}

}  // namespace

void SweepCodeNorm(const NeuralBrdfModel& model, const SweepOptions& options,
                   SweepTable* table) {
  using RealDual = BasicDual<Real>;
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  const NaiveFlow naive(model.shape.triangular, model.weights.data());
  const TriangularReference<Real> reference(model.shape.triangular,
                                            model.weights.data());
  std::mt19937_64 rng(options.seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const double norm : {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0,
                            20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    std::vector<double> value[2], gradient[2];
    for (int i = 0; i < kCodes; ++i) {
      std::vector<float> code(kCodeSize);
      double square = 0.0;
      for (float& z : code) {
        z = normal(rng);
        square += z * z;
      }
      for (float& z : code) {
        z = static_cast<float>(z * norm / std::sqrt(square));
      }
      std::vector<float> x(3 * kPoints);  // [3][points]
      for (float& v : x) v = uniform(rng);
      std::vector<float> log_density(kPoints), dcode(kCodeSize * kPoints);
      flow->LogDensity(x.data(), kPoints, code.data(), 1, log_density.data(),
                       dcode.data(), nullptr);
      std::vector<RealDual> precise_code;
      std::vector<CodeJet> naive_code;
      for (int k = 0; k < kCodeSize; ++k) {
        precise_code.emplace_back(Real(code[k]), kCodeSize, k);
        naive_code.emplace_back(code[k], k);
      }
      for (int n = 0; n < kPoints; ++n) {
        const float point[] = {x[n], x[kPoints + n], x[2 * kPoints + n]};
        const Real precise_point[] = {point[0], point[1], point[2]};
        const RealDual exact =
            reference.LogDensity(precise_point, precise_code.data());
        const CodeJet plain = log(naive.Density(point, naive_code.data()));
        value[0].push_back(
            static_cast<double>(std::abs(log_density[n] - exact.value)));
        value[1].push_back(
            static_cast<double>(std::abs(plain.a - exact.value)));
        gradient[0].push_back(GradientError(
            [&](int k) { return dcode[k * kPoints + n]; }, exact.derivatives));
        gradient[1].push_back(GradientError([&](int k) { return plain.v[k]; },
                                            exact.derivatives));
      }
    }
    const char* names[] = {kOurs, kNaive};
    for (int k = 0; k < 2; ++k) {
      table->Add("code norm", norm, "log density", names[k], value[k]);
      table->Add("code norm", norm, "gradient by code", names[k], gradient[k]);
    }
  }
}

}  // namespace stability
}  // namespace ibrdf
