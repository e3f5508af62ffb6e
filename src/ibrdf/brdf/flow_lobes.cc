#include "ibrdf/brdf/flow_lobes.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/flow/reference_flow.h"

namespace ibrdf {
namespace {

// exp(exponent * log q) without overflow of float: a density above e^80 is no
// reflectance.
constexpr double kMaxLogShape = 80.0;
float Shape(double exponent, double log_density) {
  return static_cast<float>(
      std::exp(std::min(exponent * log_density, kMaxLogShape)));
}

// d shape / d log q, from the shape; 0 where that is clamped.
float ShapeSlope(double exponent, float shape) {
  static const float kLargest = Shape(1.0, kMaxLogShape);
  return shape < kLargest ? static_cast<float>(exponent) * shape : 0.0f;
}

}  // namespace

FlowLobes::FlowLobes(const NeuralBrdfModel& model, const LobeLayout& layout,
                     const BrdfGridShape& grid, int num_threads)
    : LobeModel(layout, grid),
      model_(model),
      flow_(BrdfFlow::Create(model.shape, model.weights)),
      num_threads_(num_threads) {
  CHECK_EQ(layout.code_size, model.shape.code_size());
  nodes_ = FlowColumns(grid.d * grid.p, grid.h);
  for (int i = 0; i < grid.h; ++i) {
    for (int c = 0; c < nodes_.columns; ++c) {
      const Eigen::Vector3d x =
          WithinMerlBins(grid.NodePoint(i * nodes_.columns + c));
      if (i == 0) nodes_.SetColumn(c, x[1], x[2]);
      nodes_.x_h[static_cast<size_t>(i) * nodes_.columns + c] =
          static_cast<float>(x[0]);
    }
  }
}

FlowLobes::FlowLobes(const NeuralBrdfModel& model, int num_lobes,
                     const BrdfGridShape& grid, int num_threads)
    : FlowLobes(model, LobeLayout{num_lobes, model.shape.code_size()}, grid,
                num_threads) {}

LobeFactory FlowLobes::Factory(const NeuralBrdfModel& model,
                               const LobeLayout& layout, int num_threads) {
  return [model, layout, num_threads](const BrdfGridShape& grid) {
    return std::make_unique<FlowLobes>(model, layout, grid, num_threads);
  };
}

LobeFactory FlowLobes::Factory(const NeuralBrdfModel& model, int num_lobes,
                               int num_threads) {
  return Factory(model, LobeLayout{num_lobes, model.shape.code_size()},
                 num_threads);
}

void FlowLobes::Tabulate(const double* parameters, bool derivatives,
                         std::vector<float>* fields) const {
  const size_t n = grid_shape().num_nodes();
  const int stride = derivatives ? 1 + code_size() : 1;
  fields->resize(n * (derivatives ? num_fields() : num_lobes()));
  if (layout().lambertian) std::fill(fields->end() - n, fields->end(), 1.0f);
  const LobeMixture lobes = Mixture(parameters);
  for (int k = 0; k < layout().num_coded(); ++k) {
    const Eigen::VectorXf code = lobes.code(k).cast<float>();
    float* value = fields->data() + static_cast<size_t>(k) * stride * n;
    flow_->LogDensityOnColumns(nodes_, code.data(), num_threads_, value,
                               derivatives ? value + n : nullptr);
    for (size_t i = 0; i < n; ++i) value[i] = Shape(model_.exponent, value[i]);
    for (int d = 1; d < stride; ++d) {
      float* derivative = value + d * n;
      for (size_t i = 0; i < n; ++i) {
        derivative[i] *= ShapeSlope(model_.exponent, value[i]);
      }
    }
  }
}

void FlowLobes::TabulateReference(const double* parameters, bool derivatives,
                                  std::vector<float>* fields) const {
  const size_t n = grid_shape().num_nodes();
  const int stride = derivatives ? 1 + code_size() : 1;
  fields->resize(n * (derivatives ? num_fields() : num_lobes()));
  if (layout().lambertian) std::fill(fields->end() - n, fields->end(), 1.0f);
  const ReferenceFlow flow(model_);
  const LobeMixture lobes = Mixture(parameters);
  for (int k = 0; k < layout().num_coded(); ++k) {
    const double* z = lobes.code(k).data();
    float* value = fields->data() + static_cast<size_t>(k) * stride * n;
    ParallelFor(static_cast<int64_t>(n), num_threads_, [&](int64_t i, int) {
      const int column = static_cast<int>(i) % nodes_.columns;
      const double x[3] = {nodes_.x_h[i], nodes_.x_d[column],
                           nodes_.x_p[column]};
      std::vector<double> dz(code_size());
      const double log_density =
          flow.LogDensity(x, z, derivatives ? dz.data() : nullptr);
      value[i] = Shape(model_.exponent, log_density);
      for (int d = 1; d < stride; ++d) {
        value[d * n + i] = static_cast<float>(
            ShapeSlope(model_.exponent, value[i]) * dz[d - 1]);
      }
    });
  }
}

MerlTable FlowLobes::ToMerl(const double* parameters) const {
  const FlowColumns columns = MerlColumns();
  const size_t n = columns.num_points();
  std::vector<float> value(n);
  std::vector<int> bins;
  for (int bin = 0; bin < kMerlBins; ++bin) {
    if (MerlBinAboveHorizon(bin / (kMerlThetaD * kMerlPhiD),
                            bin / kMerlPhiD % kMerlThetaD, bin % kMerlPhiD)) {
      bins.push_back(bin);
    }
  }
  const LobeMixture lobes = Mixture(parameters);
  const Eigen::Array3Xd colours = lobes.RawColours();
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  for (int c = 0; c < 3; ++c) {
    const double plain =
        layout().lambertian ? colours(c, num_lobes() - 1) : 0.0;
    for (const int bin : bins) table.raw[size_t{kMerlBins} * c + bin] = plain;
  }
  for (int k = 0; k < layout().num_coded(); ++k) {
    const Eigen::VectorXf code = lobes.code(k).cast<float>();
    flow_->LogDensityOnColumns(columns, code.data(), num_threads_, value.data(),
                               nullptr);
    for (const int bin : bins) {
      const double shape = Shape(model_.exponent, value[bin]);
      for (int c = 0; c < 3; ++c) {
        table.raw[size_t{kMerlBins} * c + bin] += colours(c, k) * shape;
      }
    }
  }
  return table;
}

}  // namespace ibrdf
