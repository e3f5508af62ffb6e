// Lobes of the trained flow.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Shapes s_k = q(x | z_k)^exponent of the flow's density q (Chen et al. 2020,
// Eq. 5; the exponent is ours, see neural_brdf_model.h), and a Lambertian lobe
// beside them where the layout has one. Beyond a table's bins q is what it is
// at the nearest one (WithinMerlBins).
class FlowLobes final : public LobeModel {
 public:
  // layout: with codes of the model's size.
  FlowLobes(const NeuralBrdfModel& model, const LobeLayout& layout,
            const BrdfGridShape& grid, int num_threads);
  // Lobes of the flow alone.
  FlowLobes(const NeuralBrdfModel& model, int num_lobes,
            const BrdfGridShape& grid, int num_threads);

  // `model` is copied.
  static LobeFactory Factory(const NeuralBrdfModel& model,
                             const LobeLayout& layout, int num_threads);
  static LobeFactory Factory(const NeuralBrdfModel& model, int num_lobes,
                             int num_threads);

  void Tabulate(const double* parameters, bool derivatives,
                std::vector<float>* fields) const override;

  // The same shapes by the flow's double-precision reference, slow: for checks
  // of derivatives, which float rounding would hide.
  void TabulateReference(const double* parameters, bool derivatives,
                         std::vector<float>* fields) const;

  MerlTable ToMerl(const double* parameters) const override;

 private:
  NeuralBrdfModel model_;
  std::unique_ptr<BrdfFlow> flow_;
  int num_threads_;
  FlowColumns nodes_;  // the grid
};

}  // namespace ibrdf
