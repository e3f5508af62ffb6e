// The image likelihood as one Ceres cost over the two parameter blocks.
#pragma once
#include <ceres/cost_function.h>

#include <memory>
#include <optional>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/solvers/costs/log_likelihood.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// Residuals [points * 3], row i * 3 + c:
//   r_ic = RobustResidual((log(L_o_ic + eps) - log(I_ic + eps)) / b),
// L_o = Transport of the lobes (parameters[0], as LobeModel) and the map
// L = exp(UNet(noise; Phi)) (parameters[1] = Phi, in double). Residuals of
// points that take no part are 0. Jacobians: dL_o/d(z, a) by the flow's and the
// renderer's derivatives; d L_o / d Phi row by row by the UNet's
// vector-Jacobian product, so that block is for small problems (its rows are
// exact, and each costs a backward pass). All referenced objects must outlive
// the cost.
class LogRadianceCost final : public ceres::CostFunction {
 public:
  LogRadianceCost(const Transport* transport, const LobeModel* lobes,
                  const IlluminationUnet* unet, const Observations* observed,
                  const RobustLogLikelihood& likelihood);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const Transport* transport_;
  const LobeModel* lobes_;
  const IlluminationUnet* unet_;
  const Observations* observed_;
  const RobustLogLikelihood likelihood_;
};

// The same residuals for a fixed map [H, W, 3]: one block, the lobes; with
// ambient_unknown a second one, the ambient term [3] in place of the
// likelihood's, radiance >= 0. Of few
// points, the light that each gathers is stored at the start (some 40 kB per
// point) and serves every evaluation; `stored`: it was before, for this map.
class LobeRadianceCost final : public ceres::CostFunction {
 public:
  LobeRadianceCost(const Transport* transport, const LobeModel* lobes,
                   std::vector<float> map, const Observations* observed,
                   const RobustLogLikelihood& likelihood,
                   const ReflectanceOperator* stored = nullptr,
                   bool ambient_unknown = false);
  // Whether light is worth storing.
  static bool IsStored(const Transport& transport) {
    return transport.bounces() == 0 &&
           transport.num_points() <= kMaxStoredPoints;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  static constexpr int kMaxStoredPoints = 4000;

  const Transport* transport_;
  const LobeModel* lobes_;
  const std::vector<float> map_;
  std::optional<ReflectanceOperator> own_;
  const ReflectanceOperator* operator_;  // null: none is stored
  const Observations* observed_;
  const RobustLogLikelihood likelihood_;
  const bool ambient_unknown_;
};

// L_o [points * 3] of the lobes under a map, and with dL_o != nullptr its
// Jacobian [points * 3][lobes.num_parameters()], row-major. False if not
// finite.
bool RenderLobeModel(const Transport& transport, const LobeModel& lobes,
                     const double* parameters, const float* map,
                     std::vector<double>* L_o, std::vector<double>* dL_o);

}  // namespace ibrdf
