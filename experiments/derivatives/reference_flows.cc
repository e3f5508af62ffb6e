#include "experiments/derivatives/reference_flows.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr Real kMaxLogShape = 80;  // of LobeModel

}  // namespace

ReferenceFlows::ReferenceFlows(const NeuralBrdfModel& model)
    : code_size_(model.shape.code_size()) {
  if (model.shape.architecture == FlowArchitecture::kTriangular) {
    const TriangularShape& shape = model.shape.triangular;
    points_ = std::make_unique<TriangularReference<RealDual>>(
        shape, model.weights.data());
    codes_ = std::make_unique<TriangularReference<Real>>(shape,
                                                         model.weights.data());
  } else {
    coupling_ = std::make_unique<CouplingFlowReference<Real>>(
        model.shape.coupling, model.weights.data());
  }
}

FlowDerivatives ReferenceFlows::At(const Real* x,
                                   const std::vector<Real>& code) const {
  FlowDerivatives out;
  if (coupling_ != nullptr) {
    out.by_code.resize(code_size_);
    out.by_point.resize(3);
    out.value = coupling_->LogDensityWithGradient(
        x, code.data(), out.by_point.data(), out.by_code.data(), nullptr);
    return out;
  }
  const int n = code_size_ + 3;
  std::vector<RealDual> z, p;
  for (int k = 0; k < code_size_; ++k) z.emplace_back(code[k], n, k);
  for (int i = 0; i < 3; ++i) p.emplace_back(x[i], n, code_size_ + i);
  const RealDual value = points_->LogDensity(p.data(), z.data());
  out.value = value.value;
  const auto middle = value.derivatives.begin() + code_size_;
  out.by_code.assign(value.derivatives.begin(), middle);
  out.by_point.assign(middle, value.derivatives.end());
  return out;
}

FlowDerivatives ReferenceFlows::ByCode(const Real* x,
                                       const std::vector<Real>& code) const {
  if (coupling_ != nullptr) return At(x, code);
  std::vector<RealDual> z;
  for (int k = 0; k < code_size_; ++k) z.emplace_back(code[k], code_size_, k);
  const RealDual value = codes_->LogDensity(x, z.data());
  return {value.value, value.derivatives, {}};
}

std::vector<Real> ReferenceFields(const NeuralBrdfModel& model, int num_lobes,
                                  const BrdfGridShape& grid,
                                  const std::vector<double>& parameters) {
  const ReferenceFlows flow(model);
  const int codes = model.shape.code_size(), stride = 1 + codes;
  const size_t nodes = grid.num_nodes();
  std::vector<Real> fields(nodes * stride * num_lobes);
  ParallelFor(static_cast<int64_t>(nodes) * num_lobes, 0, [&](int64_t i, int) {
    const size_t lobe = i / nodes, node = i % nodes;
    const double* z = parameters.data() + lobe * (codes + 3);
    // LobeModel gives its flow codes in float.
    std::vector<Real> code;
    for (int k = 0; k < codes; ++k) code.push_back(static_cast<float>(z[k]));
    const Eigen::Vector3d p = grid.NodePoint(static_cast<int>(node));
    const Real x[3] = {static_cast<float>(p[0]), static_cast<float>(p[1]),
                       static_cast<float>(p[2])};
    const FlowDerivatives d = flow.ByCode(x, code);
    const Real exponent = model.exponent;
    // Shapes are clamped, without slope beyond.
    const bool moves = exponent * d.value < kMaxLogShape;
    const Real shape = std::exp(std::min(exponent * d.value, kMaxLogShape));
    Real* out = &fields[lobe * stride * nodes + node];
    out[0] = shape;
    for (int k = 0; k < codes; ++k) {
      out[(1 + k) * nodes] = moves ? shape * exponent * d.by_code[k] : 0;
    }
  });
  return fields;
}

Real ReferenceColour(double log_colour, int channel) {
  return std::exp(Real(std::min(log_colour, LobeModel::kMaxLogColour))) *
         Real(kMerlScale[channel]);
}

}  // namespace derivatives
}  // namespace ibrdf
