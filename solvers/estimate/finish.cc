#include <utility>
#include <vector>

#include "ibrdf/metrics/brdf_metrics.h"
#include "solvers/estimate/estimator.h"

namespace ibrdf {

StatusOr<Estimate> Estimator::Finish(JointState best) {
  Estimate estimate;
  // The start with its own mean of the light's priors.
  std::swap(light_mean_, first_mean_);
  const TraceEntry start = Evaluate("start", full_.get(), first_);
  std::swap(light_mean_, first_mean_);
  const LevelObjective on = ObjectiveOn(full_.get());
  TraceEntry end = Entry("end", *full_, best, on.objective->Evaluate(best));
  if (!(end.cost < start.cost)) {
    best = first_;
    end = Entry("end", *full_, best, on.objective->Evaluate(best));
    estimate.status = Status(StatusCode::kNoImprovement,
                             "the solver could not improve on its start");
  }
  if (Interrupted()) {
    estimate.status = Status(StatusCode::kInterrupted,
                             "interrupted; the best iterate was kept");
  }
  Report(end);
  const std::vector<double>& E = on.objective->radiance();
  estimate.map = Image(problem_.map_width, problem_.map_height);
  estimate.map.rgb = on.objective->map();
  estimate.render = Image(problem_.image.width, problem_.image.height);
  for (size_t i = 0; i < full_->points.size(); ++i) {
    float* rgb =
        estimate.render.rgb.data() + size_t{3} * full_->points[i].pixel;
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(E[3 * i + c]);
  }
  if (lobes_unknown()) {
    estimate.lobe_parameters = best.lobes;
    estimate.brdf = lobes_->ToMerl(best.lobes.data());
    estimate.lobe_covariance.assign(covariance_.data(),
                                    covariance_.data() + covariance_.size());
    AddAlternatives(&estimate);
  }
  estimate.map_std = map_std_;
  estimate.scale = likelihood_.scale;
  estimate.epsilon = likelihood_.epsilon;
  estimate.misfit = end.misfit;
  estimate.pixels_used = full_->observed.num_valid;
  estimate.start = start_name_;
  estimate.trace = std::move(trace_);
  estimate.seconds = Elapsed();
  return estimate;
}

void Estimator::AddAlternatives(Estimate* estimate) const {
  for (const TriedMaterial& tried : tried_) {
    Alternative a;
    a.start = tried.name;
    a.cost = tried.cost - tried_.front().cost;
    const StatusOr<BrdfMetrics> difference =
        CompareBrdfs(lobes_->ToMerl(tried.parameters.data()), estimate->brdf);
    if (!difference.ok()) continue;
    a.brdf_log_difference = difference->log_rmse_aligned;
    estimate->alternatives.push_back(a);
  }
}

}  // namespace ibrdf
