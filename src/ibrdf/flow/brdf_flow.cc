#include "ibrdf/flow/brdf_flow.h"

#include "ibrdf/flow/coupling_flow.h"
#include "ibrdf/flow/double_flow.h"
#include "ibrdf/flow/triangular_flow.h"

namespace ibrdf {

FlowColumns::FlowColumns(int num_columns, int num_points)
    : columns(num_columns),
      points(num_points),
      x_d(num_columns),
      x_p(num_columns),
      features(static_cast<size_t>(kColumnFeatures) * num_columns),
      x_h(static_cast<size_t>(num_columns) * num_points) {}

void FlowColumns::SetColumn(int column, double xd, double xp) {
  x_d[column] = static_cast<float>(xd);
  x_p[column] = static_cast<float>(xp);
  double values[kColumnFeatures];
  ColumnFeatures<double>(xd, xp, values, nullptr, nullptr);
  for (int i = 0; i < kColumnFeatures; ++i) {
    features[static_cast<size_t>(i) * columns + column] =
        static_cast<float>(values[i]);
  }
}

void FlowColumns::CopyColumn(int column, const FlowColumns& other, int from) {
  x_d[column] = other.x_d[from];
  x_p[column] = other.x_p[from];
  for (int i = 0; i < kColumnFeatures; ++i) {
    features[static_cast<size_t>(i) * columns + column] =
        other.features[static_cast<size_t>(i) * other.columns + from];
  }
}

std::unique_ptr<BrdfFlow> BrdfFlow::Create(const FlowShape& shape,
                                           const std::vector<float>& weights,
                                           SimdLevel level) {
  if (level == SimdLevel::kDouble) {
    return std::make_unique<DoubleFlow>(
        shape, weights, Create(shape, weights, SimdLevel::kPortable));
  }
  if (shape.architecture == FlowArchitecture::kTriangular) {
    return std::make_unique<TriangularFlow>(shape.triangular, weights, level);
  }
  return std::make_unique<CouplingFlow>(shape.coupling, weights, level);
}

std::vector<float> InitialFlowWeights(const FlowShape& shape, uint64_t seed) {
  return shape.architecture == FlowArchitecture::kTriangular
             ? InitialTriangularWeights(shape.triangular, seed)
             : InitialCouplingWeights(shape.coupling, seed);
}

}  // namespace ibrdf
