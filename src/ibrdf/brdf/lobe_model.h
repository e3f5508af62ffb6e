// Reflectance as coloured lobes, tabulated with their derivatives on the
// solver's grid.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// f_c = sum_k exp(a_kc) kMerlScale[c] s_k(x; z_k) in 1/sr (Chen et al. 2020,
// Eq. 5, summed over lobes) of shapes s_k that a few numbers z_k, the lobe's
// code, tell. Parameters are the codes z_k and the log colours a_k, in raw MERL
// units, of a LobeMixture. A Lambertian lobe has s = 1: the uniform density on
// the cube of angles, as a flow's shapes are densities there.
class LobeModel {
 public:
  virtual ~LobeModel() = default;
  LobeModel(const LobeModel&) = delete;
  LobeModel& operator=(const LobeModel&) = delete;

  const LobeLayout& layout() const { return layout_; }
  int num_lobes() const { return layout_.num_lobes; }
  int code_size() const { return layout_.code_size; }
  int lobe_size() const { return layout_.lobe_size(); }
  int num_parameters() const { return layout_.num_parameters(); }
  // Shapes and their derivatives.
  int num_fields() const {
    return num_lobes() + layout_.num_coded() * code_size();
  }
  LobeMixture Mixture(const double* parameters) const {
    return {layout_, parameters};
  }
  MutableLobeMixture Mixture(double* parameters) const {
    return {layout_, parameters};
  }
  const BrdfGridShape& grid_shape() const { return grid_; }

  // Adds shift [3] to the log colours of every lobe.
  void ShiftColours(const double* shift, double* parameters) const;

  // Shapes s_k at the nodes, [num_lobes][nodes]; with `derivatives`, each
  // followed by its derivatives d s_k / d z_k, of which a Lambertian lobe has
  // none: [num_coded][1 + code_size][nodes], then its shape.
  virtual void Tabulate(const double* parameters, bool derivatives,
                        std::vector<float>* fields) const = 0;

  // At the bin centres of a MERL table; -1 in bins below the horizon.
  virtual MerlTable ToMerl(const double* parameters) const = 0;

  // BRDF on the grid from shapes, of which the k-th is field stride * k.
  BrdfGrid Combine(const double* parameters, const std::vector<float>& fields,
                   int stride) const;
  // Tabulated and combined.
  BrdfGrid Grid(const double* parameters) const;

 protected:
  LobeModel(const LobeLayout& layout, const BrdfGridShape& grid);

 private:
  LobeLayout layout_;
  BrdfGridShape grid_;
};

// The same lobes on any grid.
using LobeFactory =
    std::function<std::unique_ptr<const LobeModel>(const BrdfGridShape& grid)>;

}  // namespace ibrdf
