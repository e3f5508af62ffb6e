#include "ibrdf/solvers/training/material_lobes.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

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

// Codes and log colours of one material's lobes, the most peaked first. With a
// Lambertian lobe the flow's lobes stay near those without one: a prior of
// others misled joint estimates (docs/notes, lambertian_lobe).
StatusOr<std::vector<double>> FitMaterial(const LobeTableFitter& fitter,
                                          const BrdfFlow& flow,
                                          const MerlTable& table,
                                          const LobeTableFitOptions& options,
                                          bool lambertian) {
  StatusOr<LobeTableFit> fit = fitter.Fit(table, options);
  if (fit.ok() && lambertian) {
    fit = fitter.AddLambertian(table, *fit, options);
  }
  if (!fit.ok()) return fit.status();
  const LobeMixture fitted(LobeLayout::OfSize(fit->parameters.size(),
                                              fitter.model().shape.code_size()),
                           fit->parameters.data());
  std::vector<int> order(options.lobes);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return Peakedness(flow, fitted.code(a)) > Peakedness(flow, fitted.code(b));
  });
  std::vector<double> lobes;
  for (const int k : order) {
    const auto lobe = fitted.lobe(k);
    lobes.insert(lobes.end(), lobe.begin(), lobe.end());
  }
  if (lambertian) {
    const auto lobe = fitted.lobe(options.lobes);
    lobes.insert(lobes.end(), lobe.begin(), lobe.end());
  }
  return lobes;
}

}  // namespace

Status FitMaterialLobes(int lobes, bool lambertian, int num_threads,
                        const std::atomic<bool>* stop, NeuralBrdfModel* model) {
  const int materials = model->num_materials();
  const LobeTableFitter fitter(*model);
  const std::unique_ptr<BrdfFlow> flow =
      BrdfFlow::Create(model->shape, model->weights);
  // Its grid plays no part.
  const FlowLobes by_channel(*model, 3, {2, 2, 1}, 1);
  LobeTableFitOptions options;
  options.lobes = lobes;
  options.num_threads = 1;
  std::vector<StatusOr<std::vector<double>>> fits(
      materials, Status(StatusCode::kInterrupted,
                        "stopped while lobes were fitted to materials"));
  ParallelFor(materials, num_threads, [&](int64_t m, int) {
    if (stop != nullptr && *stop) return;
    const std::vector<double> channels =
        MaterialLobes(*model, 3 * static_cast<int>(m));
    fits[m] = FitMaterial(fitter, *flow, by_channel.ToMerl(channels.data()),
                          options, lambertian);
  });
  for (int m = 0; m < materials; ++m) {
    if (fits[m].ok()) continue;
    const Status status = fits[m].status();
    if (status.code() == StatusCode::kInterrupted) return status;
    return InvalidInput(model->names[static_cast<size_t>(3) * m],
                        status.message());
  }
  model->fit_lobes = lobes;
  model->fit_lambertian = lambertian;
  model->lobe_fits.clear();
  for (const StatusOr<std::vector<double>>& fit : fits) {
    model->lobe_fits.insert(model->lobe_fits.end(), fit->begin(), fit->end());
  }
  return OkStatus();
}

}  // namespace ibrdf
