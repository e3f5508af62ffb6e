// Flows and lobes in long double, with derivatives: the templates of the
// library's slow references, none of its float kernels.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "experiments/validation/derivatives/error_table.h"
#include "ibrdf/base/dual.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/flow/coupling_flow_reference.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/flow/triangular_reference.h"

namespace ibrdf {
namespace derivatives {

using RealDual = BasicDual<Real>;

struct FlowDerivatives {
  Real value = 0;
  std::vector<Real> by_code;
  std::vector<Real> by_point;  // [3]
};

class ReferenceFlows {
 public:
  explicit ReferenceFlows(const NeuralBrdfModel& model);

  // At x [3] and a code. Where a spline has a knot at x: the right side's.
  FlowDerivatives At(const Real* x, const std::vector<Real>& code) const;
  // Value and by_code alone, at all x_h of a column, whose networks they share.
  std::vector<FlowDerivatives> OnColumn(Real x_d, Real x_p,
                                        const std::vector<Real>& x_h,
                                        const std::vector<Real>& code) const;

 private:
  int code_size_;
  std::unique_ptr<TriangularReference<RealDual>> points_;
  std::unique_ptr<TriangularReference<Real>> codes_;
  std::unique_ptr<CouplingFlowReference<Real>> coupling_;
};

// Shapes s_k = q^exponent at the nodes and their derivatives by the code, as
// LobeModel::Tabulate: [num_lobes][1 + code_size][nodes]. Nodes are where
// LobeModel has them, rounded to float.
std::vector<Real> ReferenceFields(const NeuralBrdfModel& model, int num_lobes,
                                  const BrdfGridShape& grid,
                                  const std::vector<double>& parameters);

// colour_kc = exp(min(a_kc, kMaxLogColour)) kMerlScale[c].
Real ReferenceColour(double log_colour, int channel);

}  // namespace derivatives
}  // namespace ibrdf
