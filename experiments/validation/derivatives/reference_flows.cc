#include "experiments/validation/derivatives/reference_flows.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/brdf/merl_columns.h"

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

std::vector<FlowDerivatives> ReferenceFlows::OnColumn(
    Real x_d, Real x_p, const std::vector<Real>& x_h,
    const std::vector<Real>& code) const {
  std::vector<FlowDerivatives> out;
  if (coupling_ != nullptr) {
    for (const Real h : x_h) {
      const Real x[3] = {h, x_d, x_p};
      out.push_back(At(x, code));
    }
    return out;
  }
  std::vector<RealDual> z;
  for (int k = 0; k < code_size_; ++k) z.emplace_back(code[k], code_size_, k);
  codes_->LogDensityOnColumn(
      x_d, x_p, x_h.data(), static_cast<int>(x_h.size()), 1, z.data(),
      [&out](int, const RealDual& value) {
        out.push_back({value.value, value.derivatives, {}});
      });
  return out;
}

std::vector<Real> ReferenceFields(const NeuralBrdfModel& model, int num_lobes,
                                  const BrdfGridShape& grid,
                                  const std::vector<double>& parameters) {
  const ReferenceFlows flow(model);
  const int codes = model.shape.code_size(), stride = 1 + codes;
  const size_t nodes = grid.num_nodes();
  const int columns = grid.d * grid.p;
  const Real exponent = model.exponent;
  std::vector<Real> fields(nodes * stride * num_lobes);
  ParallelFor(int64_t{num_lobes} * columns, 0, [&](int64_t i, int) {
    const size_t lobe = i / columns;
    const int column = static_cast<int>(i % columns);
    const double* z = parameters.data() + lobe * (codes + 3);
    // LobeModel gives its flow codes in float.
    std::vector<Real> code, x_h;
    for (int k = 0; k < codes; ++k) code.push_back(static_cast<float>(z[k]));
    Eigen::Vector3d p = WithinMerlBins(grid.NodePoint(column));
    for (int h = 0; h < grid.h; ++h) {
      p = WithinMerlBins(grid.NodePoint(h * columns + column));
      x_h.push_back(static_cast<float>(p[0]));
    }
    const std::vector<FlowDerivatives> at = flow.OnColumn(
        static_cast<float>(p[1]), static_cast<float>(p[2]), x_h, code);
    for (int h = 0; h < grid.h; ++h) {
      // Shapes are clamped, without slope beyond.
      const FlowDerivatives& d = at[h];
      const bool moves = exponent * d.value < kMaxLogShape;
      const Real shape = std::exp(std::min(exponent * d.value, kMaxLogShape));
      Real* out = &fields[lobe * stride * nodes + h * columns + column];
      out[0] = shape;
      for (int k = 0; k < codes; ++k) {
        out[(1 + k) * nodes] = moves ? shape * exponent * d.by_code[k] : 0;
      }
    }
  });
  return fields;
}

Real ReferenceColour(double log_colour, int channel) {
  return std::exp(Real(std::min(log_colour, kMaxLogColour))) *
         Real(kMerlScale[channel]);
}

}  // namespace derivatives
}  // namespace ibrdf
