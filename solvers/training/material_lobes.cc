#include "ibrdf/solvers/training/material_lobes.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/training/lobe_table_fit.h"

namespace ibrdf {
namespace {

// log q at theta_h = 0 less log q at wide theta_h, theta_d = 18 degrees.
float Peakedness(const BrdfFlow& flow, const Eigen::VectorXd& code) {
  const Eigen::VectorXf z = code.cast<float>();
  const float x[6] = {0.02f, 0.8f, 0.2f, 0.2f, 0.5f, 0.5f};  // [3][2]
  float value[2];
  flow.LogDensity(x, 2, z.data(), 1, value, nullptr, nullptr);
  return value[0] - value[1];
}

}  // namespace

Status FitMaterialLobes(int lobes, int num_threads,
                        const std::atomic<bool>* stop, NeuralBrdfModel* model) {
  const LobeLayout layout = {lobes, model->shape.code_size()};
  const int materials = model->num_materials();
  const LobeTableFitter fitter(*model);
  const std::unique_ptr<BrdfFlow> flow =
      BrdfFlow::Create(model->shape, model->weights);
  // Its grid plays no part.
  const FlowLobes by_channel(*model, 3, {2, 2, 1}, 1);
  LobeTableFitOptions options;
  options.lobes = lobes;
  options.num_threads = 1;
  std::vector<std::vector<double>> fits(materials);
  std::vector<Status> failures(materials);
  ParallelFor(materials, num_threads, [&](int64_t m, int) {
    if (stop != nullptr && *stop) {
      failures[m] = Status(StatusCode::kInterrupted,
                           "stopped while lobes were fitted to materials");
      return;
    }
    const std::vector<double> channels =
        MaterialLobes(*model, 3 * static_cast<int>(m));
    const StatusOr<LobeTableFit> fit =
        fitter.Fit(by_channel.ToMerl(channels.data()), options);
    if (!fit.ok()) {
      failures[m] = fit.status();
      return;
    }
    std::vector<int> order(lobes);
    std::iota(order.begin(), order.end(), 0);
    const LobeMixture fitted(layout, fit->parameters.data());
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return Peakedness(*flow, fitted.code(a)) >
             Peakedness(*flow, fitted.code(b));
    });
    for (const int k : order) {
      const auto lobe = fitted.lobe(k);
      fits[m].insert(fits[m].end(), lobe.begin(), lobe.end());
    }
  });
  for (int m = 0; m < materials; ++m) {
    if (failures[m].ok()) continue;
    if (failures[m].code() == StatusCode::kInterrupted) return failures[m];
    return InvalidInput(model->names[static_cast<size_t>(3) * m],
                        failures[m].message());
  }
  model->fit_lobes = lobes;
  model->lobe_fits.clear();
  for (const std::vector<double>& fit : fits) {
    model->lobe_fits.insert(model->lobe_fits.end(), fit.begin(), fit.end());
  }
  return OkStatus();
}

}  // namespace ibrdf
