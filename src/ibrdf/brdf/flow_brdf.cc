#include "ibrdf/brdf/flow_brdf.h"

#include <glog/logging.h>

#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/brdf/merl_columns.h"

namespace ibrdf {

struct FlowBrdf::State {
  std::unique_ptr<BrdfFlow> flow;
  double exponent = 1.0;
  int num_lobes = 0, code_size = 0, num_threads = 1;
  std::vector<float> codes;            // [num_lobes][code_size]
  std::vector<Eigen::Array3d> colour;  // [num_lobes], 1/sr

  std::vector<Eigen::Array3d> Evaluate(
      const std::vector<HalfDiff>& angles) const {
    const size_t n = angles.size();
    std::vector<float> x(3 * n), log_density(n);
    for (size_t i = 0; i < n; ++i) {
      const HalfDiff& a = angles[i];
      const Eigen::Vector3d p =
          WithinMerlBins(ToUnitCube(a.theta_h, a.theta_d, a.phi_d));
      for (int k = 0; k < 3; ++k) x[k * n + i] = static_cast<float>(p[k]);
    }
    std::vector<Eigen::Array3d> f(n, Eigen::Array3d::Zero());
    for (int lobe = 0; lobe < num_lobes; ++lobe) {
      if ((colour[lobe] == 0.0).all()) continue;
      flow->LogDensity(x.data(), static_cast<int64_t>(n),
                       codes.data() + static_cast<size_t>(lobe) * code_size,
                       num_threads, log_density.data(), nullptr, nullptr);
      for (size_t i = 0; i < n; ++i) {
        f[i] += colour[lobe] *
                std::exp(exponent * static_cast<double>(log_density[i]));
      }
    }
    return f;
  }
};

BrdfBatch BatchOf(BrdfFunction brdf) {
  return [brdf = std::move(brdf)](const std::vector<HalfDiff>& angles) {
    std::vector<Eigen::Array3d> f;
    f.reserve(angles.size());
    for (const HalfDiff& a : angles) {
      f.push_back(brdf(a.theta_h, a.theta_d, a.phi_d));
    }
    return f;
  };
}

std::vector<double> MaterialLobes(const NeuralBrdfModel& model,
                                  int first_code) {
  CHECK_GE(first_code, 0);
  CHECK_LE(first_code + 3, model.num_codes());
  const int size = model.shape.code_size();
  const LobeLayout layout = {3, size};
  std::vector<double> parameters(layout.num_parameters());
  const MutableLobeMixture lobes(layout, parameters.data());
  for (int c = 0; c < 3; ++c) {
    const int code = first_code + c;
    const float* z = model.codes.data() + static_cast<size_t>(code) * size;
    lobes.code(c) = Eigen::Map<const Eigen::VectorXf>(z, size).cast<double>();
    lobes.log_colour(c).setConstant(-std::numeric_limits<double>::infinity());
    lobes.log_colour(c)[c] = model.log_colours[code];
  }
  return parameters;
}

FlowBrdf::FlowBrdf(const NeuralBrdfModel& model, const double* parameters,
                   int num_lobes, int num_threads) {
  CHECK_GE(num_lobes, 1);
  auto state = std::make_shared<State>();
  state->flow = BrdfFlow::Create(model.shape, model.weights);
  state->exponent = model.exponent;
  state->num_lobes = num_lobes;
  state->code_size = model.shape.code_size();
  state->num_threads = num_threads;
  const LobeMixture lobes({num_lobes, state->code_size}, parameters);
  const Eigen::Array3Xd colours = lobes.Colours();
  for (int k = 0; k < num_lobes; ++k) {
    const auto code = lobes.code(k);
    state->codes.insert(state->codes.end(), code.begin(), code.end());
    state->colour.push_back(colours.col(k));
  }
  state_ = std::move(state);
}

std::vector<Eigen::Array3d> FlowBrdf::Evaluate(
    const std::vector<HalfDiff>& angles) const {
  return state_->Evaluate(angles);
}

BrdfBatch FlowBrdf::Batch() const {
  return [state = state_](const std::vector<HalfDiff>& angles) {
    return state->Evaluate(angles);
  };
}

}  // namespace ibrdf
