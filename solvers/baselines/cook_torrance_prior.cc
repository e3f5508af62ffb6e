#include "ibrdf/solvers/baselines/cook_torrance_prior.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/baselines/table_fit.h"

namespace ibrdf {
namespace {

// Log colours of a lobe that a fit drove out, raw units: a tenth of the
// metric's floor. Further down they would only widen the Gaussian.
constexpr double kFaintest = -16.0;
constexpr BrdfGridShape kNoGrid = {2, 2, 1};

}  // namespace

StatusOr<MaterialPrior> CookTorrancePrior(const NeuralBrdfModel& model,
                                          int num_threads) {
  if (model.fit_lobes == 0 || model.num_materials() < 3) {
    return InvalidInput("model", "expected lobes fitted to three materials");
  }
  std::vector<MaterialPrior::Material> materials =
      JointMaterialPrior(model, model.fit_lobes, 1.0).materials;
  const FlowLobes lobes(model, FittedLayout(model, model.fit_lobes), kNoGrid,
                        1);
  std::vector<Status> failed(materials.size());
  ParallelFor(
      static_cast<int64_t>(materials.size()), num_threads, [&](int64_t m, int) {
        Eigen::VectorXd& parameters = materials[m].parameters;
        const StatusOr<CookTorrance> fit =
            FitColouredCookTorranceToTable(lobes.ToMerl(parameters.data()), {});
        if (!fit.ok()) {
          failed[m] = fit.status();
          return;
        }
        parameters = ToEigen(CookTorranceLobes::ToParameters(*fit));
        const MutableLobeMixture mixture(CookTorranceLobes::kLayout,
                                         parameters.data());
        for (int k = 0; k < mixture.num_lobes(); ++k) {
          for (double& a : mixture.log_colour(k)) a = std::max(a, kFaintest);
        }
      });
  for (const Status& status : failed) {
    if (!status.ok()) return status;
  }
  MaterialPrior prior =
      GaussianPrior(std::move(materials), CookTorranceLobes::kCode);
  prior.factor
      .topLeftCorner<CookTorranceLobes::kCode, CookTorranceLobes::kCode>()
      .setIdentity();
  prior.wall = 0.0;
  return prior;
}

}  // namespace ibrdf
