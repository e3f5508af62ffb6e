#include "ibrdf/solvers/training/analytic_materials.h"

#include <cmath>
#include <random>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {

Disney RandomDisney(uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto between = [&](double low, double high) {
    return low + (high - low) * uniform(rng);
  };
  const auto log_between = [&](double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  };
  Disney brdf;
  brdf.roughness = std::sqrt(log_between(0.01, 0.7));
  brdf.metallic = uniform(rng) < 0.5 ? 1.0 : 0.0;
  brdf.specular = between(0.02, 0.08) / 0.08;
  for (int c = 0; c < 3; ++c) {
    brdf.base[c] =
        brdf.metallic > 0.0 ? between(0.4, 0.98) : log_between(0.003, 0.8);
  }
  return brdf;
}

void AddAnalyticMaterials(int count, uint64_t seed, TrainingData* data) {
  const FlowColumns& x = data->columns;
  for (int m = 0; m < count; ++m) {
    const Disney brdf = RandomDisney(seed * 1000003 + m);
    const std::string name = Format("analytic-%03d", m);
    const size_t begin = data->log_raw.size();
    const size_t channel = static_cast<size_t>(x.columns) * kMerlThetaH;
    data->log_raw.resize(begin + 3 * channel);
    for (int c = 0; c < x.columns; ++c) {
      const double theta_d = x.x_d[c] * kPi / 2, phi_d = x.x_p[c] * kPi;
      for (int i = 0; i < kMerlThetaH; ++i) {
        const Eigen::Array3d f = brdf.Evaluate(MerlThetaH(i), theta_d, phi_d);
        for (int k = 0; k < 3; ++k) {
          data->log_raw[begin + k * channel +
                        static_cast<size_t>(c) * kMerlThetaH + i] =
              static_cast<float>(std::log(f[k] / kMerlScale[k] + kLogFloor));
        }
      }
    }
    for (const char* suffix : {".red", ".green", ".blue"}) {
      data->names.push_back(std::string(name) + suffix);
    }
  }
}

}  // namespace ibrdf
