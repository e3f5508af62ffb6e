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
};

ReferenceFlow::ReferenceFlow(const NeuralBrdfModel& model)
    : flows_(std::make_unique<Flows>()) {
  flows_->code_size = model.shape.code_size();
  if (model.shape.architecture == FlowArchitecture::kTriangular) {
    flows_->triangular = std::make_unique<TriangularReference<double>>(
        model.shape.triangular, model.weights.data());
  } else {
    flows_->coupling = std::make_unique<CouplingFlowReference<double>>(
        model.shape.coupling, model.weights.data());
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
  const int n = flows_->code_size;
  std::vector<Dual> z;
  for (int k = 0; k < n; ++k) z.emplace_back(code[k], n, k);
  const Dual value = flows_->triangular->LogDensity(x, z.data());
  std::copy(value.derivatives.begin(), value.derivatives.end(), dcode);
  return value.value;
}

}  // namespace ibrdf
