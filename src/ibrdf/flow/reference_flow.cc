#include "ibrdf/flow/reference_flow.h"

#include <algorithm>
#include <vector>

#include "ibrdf/base/dual.h"
#include "ibrdf/flow/coupling_flow_reference.h"
#include "ibrdf/flow/triangular_reference.h"

namespace ibrdf {

struct ReferenceFlow::Flows {
  int code_size = 0;
  std::unique_ptr<TriangularReference<double>> triangular;
  std::unique_ptr<CouplingFlowReference<double>> coupling;

  std::vector<Dual> Variables(const double* code) const {
    std::vector<Dual> z;
    for (int k = 0; k < code_size; ++k) z.emplace_back(code[k], code_size, k);
    return z;
  }
};

ReferenceFlow::ReferenceFlow(const NeuralBrdfModel& model)
    : ReferenceFlow(model.shape, model.weights) {}

ReferenceFlow::ReferenceFlow(const FlowShape& shape,
                             const std::vector<float>& weights)
    : flows_(std::make_unique<Flows>()) {
  flows_->code_size = shape.code_size();
  if (shape.architecture == FlowArchitecture::kTriangular) {
    flows_->triangular = std::make_unique<TriangularReference<double>>(
        shape.triangular, weights.data());
  } else {
    flows_->coupling = std::make_unique<CouplingFlowReference<double>>(
        shape.coupling, weights.data());
  }
}

ReferenceFlow::~ReferenceFlow() = default;

double ReferenceFlow::LogDensity(const double* x, const double* code,
                                 double* dcode) const {
  if (flows_->coupling != nullptr) {
    double u[3];
    return dcode == nullptr ? flows_->coupling->LogDensity(x, code, u)
                            : flows_->coupling->LogDensityWithGradient(
                                  x, code, nullptr, dcode, nullptr);
  }
  if (dcode == nullptr) return flows_->triangular->LogDensity(x, code);
  const std::vector<Dual> z = flows_->Variables(code);
  const Dual value = flows_->triangular->LogDensity(x, z.data());
  std::copy(value.derivatives.begin(), value.derivatives.end(), dcode);
  return value.value;
}

void ReferenceFlow::LogDensityOnColumn(double x_d, double x_p, const float* x_h,
                                       int points, size_t stride,
                                       const double* code, float* log_density,
                                       float* dcode, size_t code_stride) const {
  const auto store = [&](int i, double value, const double* derivatives) {
    log_density[i * stride] = static_cast<float>(value);
    for (int k = 0; k < flows_->code_size && dcode != nullptr; ++k) {
      dcode[k * code_stride + i * stride] = static_cast<float>(derivatives[k]);
    }
  };
  if (flows_->coupling != nullptr) {
    std::vector<double> gradient(flows_->code_size);
    for (int i = 0; i < points; ++i) {
      const double x[3] = {x_h[i * stride], x_d, x_p};
      const double value =
          LogDensity(x, code, dcode == nullptr ? nullptr : gradient.data());
      store(i, value, gradient.data());
    }
  } else if (dcode == nullptr) {
    flows_->triangular->LogDensityOnColumn(
        x_d, x_p, x_h, points, stride, code,
        [&](int i, double value) { store(i, value, nullptr); });
  } else {
    const std::vector<Dual> z = flows_->Variables(code);
    flows_->triangular->LogDensityOnColumn(
        x_d, x_p, x_h, points, stride, z.data(), [&](int i, const Dual& value) {
          store(i, value.value, value.derivatives.data());
        });
  }
}

}  // namespace ibrdf
