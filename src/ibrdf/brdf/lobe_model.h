// Reflectance as coloured lobes of the trained flow, tabulated with its
// derivatives on the solver's grid.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// f_c = sum_k exp(a_kc) kMerlScale[c] q(x | z_k)^exponent in 1/sr
// (Chen et al. 2020, Eq. 5, summed over lobes; the exponent is ours, see
// neural_brdf_model.h). Parameters of lobe k, one after the other: the code
// z_k [code_size], then the log colours a_k [3] in raw MERL units.
class LobeModel {
 public:
  LobeModel(const NeuralBrdfModel& model, int num_lobes,
            const BrdfGridShape& grid, int num_threads);

  int num_lobes() const { return num_lobes_; }
  int code_size() const { return model_.shape.code_size(); }
  int lobe_size() const { return code_size() + 3; }
  int num_parameters() const { return num_lobes_ * lobe_size(); }
  int num_fields() const { return num_lobes_ * (1 + code_size()); }
  const NeuralBrdfModel& model() const { return model_; }
  const BrdfGridShape& grid_shape() const { return grid_; }

  // Adds shift [3] to the log colours of every lobe.
  void ShiftColours(const double* shift, double* parameters) const;

  // Lobe shapes s_k = q^exponent at the nodes, [num_lobes][nodes]; with
  // `derivatives`, each followed by its code_size derivatives d s_k / d z_k:
  // [num_lobes][1 + code_size][nodes].
  void Tabulate(const double* parameters, bool derivatives,
                std::vector<float>* fields) const;

  // The same shapes by the flow's double-precision reference, slow: for checks
  // of derivatives, which float rounding would hide.
  void TabulateReference(const double* parameters, bool derivatives,
                         std::vector<float>* fields) const;

  // BRDF on the grid from shapes [num_lobes][stride fields][nodes].
  BrdfGrid Combine(const double* parameters, const std::vector<float>& fields,
                   int stride) const;
  // Tabulated and combined.
  BrdfGrid Grid(const double* parameters) const;

  // At the bin centres of a MERL table; -1 in bins below the horizon.
  MerlTable ToMerl(const double* parameters) const;

  // Largest log colour that exp() is taken of; colours beyond are bugs of a
  // caller's step and are clamped so that nothing overflows.
  static constexpr double kMaxLogColour = 40.0;

 private:
  NeuralBrdfModel model_;
  std::unique_ptr<BrdfFlow> flow_;
  int num_lobes_;
  BrdfGridShape grid_;
  int num_threads_;
  FlowColumns nodes_;  // the grid
};

}  // namespace ibrdf
