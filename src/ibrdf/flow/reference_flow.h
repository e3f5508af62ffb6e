// A model's density in double precision, written plainly, with its gradient by
// the code: for checks.
#pragma once
#include <memory>

#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

class ReferenceFlow {
 public:
  explicit ReferenceFlow(const NeuralBrdfModel& model);
  ~ReferenceFlow();

  // Log density at x in [0,1]^3 for a code [code_size]; its derivatives go to
  // dcode [code_size] where not null.
  double LogDensity(const double* x, const double* code, double* dcode) const;

 private:
  struct Flows;
  std::unique_ptr<Flows> flows_;
};

}  // namespace ibrdf
