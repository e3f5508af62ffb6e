#include "ibrdf/solvers/estimation/estimator.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/priors/embedding_prior.h"
#include "ibrdf/transport/bright_texels.h"

namespace ibrdf {
namespace {

constexpr double kFirstScale = 0.1;     // b at first: tolerant
constexpr double kEpsilonShare = 1e-5;  // of the mean radiance
// Time of Finish: over that of a transport of all pixels, which it builds and
// renders by, and for the table and the draws of the posterior.
constexpr double kFinishPerTransport = 1.4;
constexpr double kTableSeconds = 0.3;
// That a transport is timed on.
constexpr size_t kProbePoints = 128;
// Of the time left when it is predicted: the rest is to have something to
// finish.
constexpr double kMostFinishShare = 0.6;

// Of directions that stand for a bright texel: finer than the narrowest lobes.
constexpr double kBrightSpacing = 0.75 * M_PI / 180.0;
int BrightSamplesPerSide(int map_height) {
  const double texel = M_PI / map_height;
  return 2 * static_cast<int>(std::ceil(texel / kBrightSpacing));
}

}  // namespace

Estimator::Estimator(const InverseProblem& problem,
                     const SolveProgress& progress,
                     const std::atomic<bool>* stop)
    : problem_(problem), progress_(progress), stop_(stop) {}

StatusOr<Solution> Estimator::Run() {
  IBRDF_RETURN_IF_ERROR(Prepare());
  likelihood_.scale = problem_.scale.value_or(kFirstScale);
  JointState state;
  if (!light_unknown()) {
    state = EstimateUnderKnownLight();
  } else if (joint_maximum()) {
    IBRDF_RETURN_IF_ERROR(EstimateBoth(&state));
  } else {
    Status found;
    if (lobes_unknown()) found = SearchMarginal(&state);
    if (found.code() == StatusCode::kNoImprovement) {
      LOG(WARNING) << found.message();
      StartWithoutSearch(&state);
      return Finish(state);
    }
    IBRDF_RETURN_IF_ERROR(found);
    IBRDF_RETURN_IF_ERROR(EstimateLight(&state));
  }
  return Finish(state);
}

double Estimator::Elapsed() const {
  return problem_.seconds_spent + clock_.Seconds();
}

std::function<bool()> Estimator::StopAfter(double share) const {
  const double now = Elapsed();
  const double end =
      now + share * std::max(Budget() - finish_seconds_ - now, 0.0);
  return [this, end] { return Interrupted() || Elapsed() > end; };
}

Status Estimator::Prepare() {
  full_ = MakeFullLevel(problem_);
  if (full_->observed.num_valid == 0) {
    return InvalidInput("image",
                        "no pixel of the object is finite and positive in "
                        "all three channels");
  }
  if (light_unknown()) cells_ = MakeBinnedLevel(problem_, kMapBins);
  double mean = 0.0;
  for (size_t i = 0; i < full_->observed.radiance.size(); ++i) {
    if (full_->observed.valid[i / 3]) mean += full_->observed.radiance[i];
  }
  mean /= 3.0 * full_->observed.num_valid;
  likelihood_.epsilon = problem_.epsilon.value_or(kEpsilonShare * mean);

  if (!light_unknown()) {
    const Image& map = *problem_.known_map;
    BrightTexels split = SplitBrightTexels(map);
    known_map_ = std::move(split.rest.rgb);
    bright_ = SampleBrightTexels(split.texels, map.height, map.width,
                                 BrightSamplesPerSide(map.height));
  }
  if (lobes_unknown()) {
    lobes_ = std::make_unique<FlowLobes>(*problem_.model, problem_.lobes,
                                         problem_.transport.grid,
                                         problem_.num_threads);
    lobe_prior_ = EmbeddingPrior(*problem_.model, problem_.prior_sigma);
    materials_ = JointMaterialPrior(*problem_.model, problem_.lobes,
                                    problem_.prior_sigma);
  }
  IBRDF_RETURN_IF_ERROR(CheckMethod());
  PredictFinish();
  return OkStatus();
}

Status Estimator::CheckMethod() const {
  const JointMethod method = MethodFor(JointBlocks::kLight);
  if (!light_unknown() || problem_.solver.max_iterations == 0 ||
      method != JointMethod::kTrustRegion) {
    return OkStatus();
  }
  const bool draw =
      problem_.illumination_prior == IlluminationPrior::kProcess &&
      !joint_maximum();
  const int64_t texels = int64_t{problem_.map_width} * problem_.map_height;
  const int64_t unknowns = (draw ? 3 * texels : MakeLight()->num_parameters()) +
                           (joint_maximum() ? lobes_->num_parameters() : 0);
  return CheckJointMethod(method, unknowns,
                          static_cast<int64_t>(3 * cells_->points.size()));
}

void Estimator::PredictFinish() {
  const std::vector<ShadingPoint>& points = full_->points;
  const size_t stride = std::max<size_t>(points.size() / kProbePoints, 1);
  Level probe;
  for (size_t i = 0; i < points.size(); i += stride) {
    probe.points.push_back(points[i]);
  }
  const double start = Elapsed();
  TransportOf(&probe);
  // Each transport has one of the patches besides.
  const auto& patches = problem_.transport.patches;
  const size_t besides = patches ? patches->points().size() : 0;
  const double transport = (Elapsed() - start) *
                           static_cast<double>(points.size() + besides) /
                           static_cast<double>(probe.points.size() + besides);
  finish_seconds_ = std::min(
      kFinishPerTransport * transport +
          (lobes_unknown() ? kTableSeconds : 0.0) + problem_.seconds_reserved,
      kMostFinishShare * std::max(Budget() - start, 0.0));
  VLOG(1) << "the end is predicted to take " << finish_seconds_ << " s";
}

const Transport& Estimator::TransportOf(Level* level) {
  const int height = light_ ? light_->height() : problem_.map_height;
  const int width = light_ ? light_->width() : problem_.map_width;
  if (level->transport == nullptr || level->transport->map_height() != height ||
      level->transport->map_width() != width) {
    TransportOptions options = problem_.transport;
    options.num_threads = problem_.num_threads;
    options.bright = bright_;
    level->transport =
        std::make_unique<Transport>(level->points, height, width, options);
  }
  return *level->transport;
}

Estimator::LevelObjective Estimator::ObjectiveOn(Level* level) {
  LevelObjective out;
  JointTerms terms;
  terms.observed = &level->observed;
  terms.likelihood = likelihood_;
  if (lobes_unknown()) {
    terms.transport = &TransportOf(level);
    terms.lobes = lobes_.get();
    terms.lobe_prior = lobe_prior_;
  } else {
    out.known_brdf = std::make_unique<LightOperator>(
        TransportOf(level).ByLight(*problem_.known_brdf));
    terms.known_brdf = out.known_brdf.get();
  }
  if (light_unknown()) {
    terms.illumination = light_.get();
    terms.light_mean = light_priors_.mean;
    for (const auto& prior : light_priors_.on_map) {
      terms.light_priors.push_back(prior.get());
    }
  } else {
    terms.known_map = known_map_;
  }
  out.objective = std::make_unique<JointObjective>(std::move(terms));
  return out;
}

double Estimator::ReflectancePrior(const JointState& state) const {
  const Eigen::VectorXd lobes = ToEigen(state.lobes);
  return light_unknown() ? materials_.CostAtBestLevel(lobes)
                         : materials_.Cost(lobes, nullptr);
}

TraceEntry Estimator::Entry(const std::string& stage, const Level& level,
                            const JointState& state,
                            const JointCost& cost) const {
  TraceEntry entry;
  entry.stage = stage;
  entry.scale = likelihood_.scale;
  entry.pixels = level.observed.num_valid;
  entry.likelihood = cost.likelihood;
  entry.reflectance_prior = lobes_unknown() && !joint_maximum()
                                ? ReflectancePrior(state)
                                : cost.reflectance_prior;
  entry.illumination_prior = cost.illumination_prior;
  entry.cost =
      entry.likelihood + entry.reflectance_prior + entry.illumination_prior;
  entry.misfit = cost.misfit;
  entry.seconds = Elapsed();
  return entry;
}

TraceEntry Estimator::Evaluate(const std::string& stage, Level* level,
                               const JointState& state) {
  const LevelObjective on = ObjectiveOn(level);
  return Entry(stage, *level, state, on.objective->Evaluate(state));
}

void Estimator::Report(const TraceEntry& entry) {
  trace_.push_back(entry);
  VLOG(1) << entry.stage << " " << entry.seconds << " s misfit " << entry.misfit
          << " cost " << entry.cost;
  if (progress_) progress_(entry, std::min(entry.seconds / Budget(), 1.0));
}

void Estimator::Report(const std::string& stage, Level* level,
                       const JointState& state) {
  Report(Evaluate(stage, level, state));
}

}  // namespace ibrdf
