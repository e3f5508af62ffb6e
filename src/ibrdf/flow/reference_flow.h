// A model's density in double precision, written plainly, with its gradient by
// the code: for checks.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "ibrdf/flow/flow_shape.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

class ReferenceFlow {
 public:
  explicit ReferenceFlow(const NeuralBrdfModel& model);
  ReferenceFlow(const FlowShape& shape, const std::vector<float>& weights);
  ~ReferenceFlow();

  // Log density at x in [0,1]^3 for a code [code_size]; its derivatives go to
  // dcode [code_size] where not null.
  double LogDensity(const double* x, const double* code, double* dcode) const;

  // At x_h [points] of a column (x_d, x_p), rounded to float: log_density
  // [points] and, where not null, dcode [code_size][points]. Points lie
  // `stride` apart, components of the code `code_stride`.
  void LogDensityOnColumn(double x_d, double x_p, const float* x_h, int points,
                          size_t stride, const double* code, float* log_density,
                          float* dcode, size_t code_stride) const;

 private:
  struct Flows;
  std::unique_ptr<Flows> flows_;
};

}  // namespace ibrdf
