#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/estimator.h"

namespace ibrdf {
namespace {

// Transported at once: the lists of pairs of all pixels would take gigabytes.
constexpr size_t kPointsAtOnce = 4096;
constexpr int kSpreadDraws = 64;

}  // namespace

Estimator::View Estimator::ViewOf(const JointState& state) {
  // Priors and map are the same on any level.
  const LevelObjective on =
      ObjectiveOn(light_unknown() ? cells_.get() : few_.get());
  View view;
  view.cost = on.objective->Evaluate(state);
  view.map = on.objective->map();
  view.grid =
      lobes_unknown() ? lobes_->Grid(state.lobes.data()) : *problem_.known_brdf;
  return view;
}

void Estimator::RenderPixels(const std::vector<View*>& views) {
  const std::vector<ShadingPoint>& points = full_->points;
  for (View* const view : views) view->radiance.resize(3 * points.size());
  const bool bounces = problem_.transport.patches != nullptr;
  const size_t at_once = bounces ? kPointsAtOnceWithBounces : kPointsAtOnce;
  for (size_t begin = 0; begin < points.size(); begin += at_once) {
    Level slice;
    const size_t end = std::min(begin + at_once, points.size());
    slice.points.assign(points.begin() + begin, points.begin() + end);
    const Transport& transport = TransportOf(&slice);
    for (View* const view : views) {
      transport.Render(view->grid, view->map.data(),
                       &view->radiance[3 * begin]);
    }
  }
  for (View* const view : views) {
    const LikelihoodValue value = EvaluateLikelihood(
        view->radiance, full_->observed, likelihood_, nullptr);
    view->cost.likelihood = value.cost;
    view->cost.misfit = value.misfit;
  }
}

StatusOr<Solution> Estimator::Finish(JointState best) {
  Solution estimate;
  // The start with its own centre of the light's priors.
  std::swap(light_priors_, first_priors_);
  View first = ViewOf(first_);
  std::swap(light_priors_, first_priors_);
  View last = ViewOf(best);
  RenderPixels({&first, &last});
  const TraceEntry start = Entry("start", *full_, first_, first.cost);
  TraceEntry end = Entry("end", *full_, best, last.cost);
  if (!(end.cost < start.cost)) {
    best = first_;
    last = std::move(first);
    end = start;
    end.stage = "end";
    // They are of what was turned down.
    covariance_.resize(0, 0);
    map_std_ = Image();
    tried_.clear();
    estimate.status = Status(StatusCode::kNoImprovement,
                             "the solver could not improve on its start");
  }
  if (Interrupted()) {
    estimate.status = Status(StatusCode::kInterrupted,
                             "interrupted; the best iterate was kept");
  }
  Report(end);
  estimate.map = Image(problem_.map_width, problem_.map_height);
  estimate.map.rgb = light_unknown() ? last.map : problem_.known_map->rgb;
  estimate.render = Image(problem_.image.width, problem_.image.height);
  for (size_t i = 0; i < full_->points.size(); ++i) {
    float* rgb =
        estimate.render.rgb.data() + size_t{3} * full_->points[i].pixel;
    for (int c = 0; c < 3; ++c) {
      rgb[c] = static_cast<float>(last.radiance[3 * i + c]);
    }
  }
  if (lobes_unknown()) {
    estimate.lobe_parameters = best.lobes;
    estimate.brdf = lobes_->ToMerl(best.lobes.data());
    estimate.lobe_covariance.assign(covariance_.data(),
                                    covariance_.data() + covariance_.size());
    const LobeDistance distance(FlowLobes::Factory(
        *problem_.model, problem_.lobes, problem_.num_threads));
    estimate.spread = SpreadOf(distance, best);
    AddAlternatives(distance, best, &estimate);
  }
  estimate.map_std = map_std_;
  estimate.scale = likelihood_.scale;
  estimate.epsilon = likelihood_.epsilon;
  estimate.misfit = end.misfit;
  estimate.start_cost = start.cost;
  estimate.end_cost = end.cost;
  estimate.pixels_used = full_->observed.num_valid;
  estimate.start = start_name_;
  estimate.trace = std::move(trace_);
  estimate.seconds = Elapsed();
  return estimate;
}

double Estimator::SpreadOf(const LobeDistance& distance,
                           const JointState& state) const {
  if (covariance_.size() == 0) return Solution().spread;
  const std::vector<double> covariance(covariance_.data(),
                                       covariance_.data() + covariance_.size());
  return ReflectanceSpread(distance, state.lobes, covariance, kSpreadDraws,
                           problem_.seed);
}

void Estimator::AddAlternatives(const LobeDistance& distance,
                                const JointState& best,
                                Solution* estimate) const {
  if (tried_.empty()) return;
  const std::vector<double> found = distance.LogValues(best.lobes);
  for (const TriedMaterial& tried : tried_) {
    Alternative a;
    a.start = tried.name;
    a.cost = tried.cost - tried_.front().cost;
    a.brdf_log_difference =
        distance.Aligned(distance.LogValues(tried.parameters), found);
    if (!std::isfinite(a.brdf_log_difference)) continue;
    estimate->alternatives.push_back(a);
  }
}

}  // namespace ibrdf
