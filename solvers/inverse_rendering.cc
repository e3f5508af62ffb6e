#include "solvers/inverse_rendering.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "solvers/embedding_prior.h"
#include "solvers/illumination_model.h"
#include "solvers/joint/joint_method.h"
#include "solvers/joint/process_prior.h"
#include "solvers/known_light_search.h"
#include "solvers/level_gauge.h"
#include "solvers/log_map_fit.h"
#include "solvers/marginal/reflectance_search.h"
#include "solvers/mean_cells.h"
#include "solvers/process_illumination.h"
#include "solvers/reflectance_solver.h"

namespace ibrdf {
namespace {

// Of the time left, at most: the search for the reflectance; the map as a draw
// of the light's process; the last rounds, whose last steps take the rest.
constexpr double kSearchShare = 0.4;
constexpr double kProcessShare = 0.5;
constexpr double kMapShare = 0.9;
// Of the draw's misfit: a network beyond it is not finished.
constexpr double kWorseMisfit = 1.5;
// Time of Finish over that of a transport of all pixels, which it builds: the
// render, the alternatives and the tables are the rest.
constexpr double kFinishPerTransport = 2.5;
constexpr double kMostFinishShare = 0.3;
constexpr double kFirstScale = 0.1;  // b at first: tolerant
constexpr double kScaleStep = 3.0;   // b falls by no more in a round
// Rounds end where b falls by no more than to this share, and the cost by this
// many times the tolerance of a step.
constexpr double kSettledScale = 0.9;
constexpr double kRoundTolerance = 300.0;
constexpr double kSmallestScale = 3e-3;  // below any real image's noise
// Standard deviation of log (red / green) and log (blue / green) of a map's
// mean log radiance (experiments/light_statistics).
constexpr double kLightChromaStd = 0.35;
constexpr double kEpsilonShare = 1e-5;  // of the mean radiance
// Of the disc of normals: what a map's estimate is made from, and what a few
// dozen parameters under known light can learn from.
constexpr int kMapCells = 64;
constexpr int kKnownLightCells = 26;
constexpr double kMinCosine = 0.1;
constexpr size_t kThinPoints = 4000;
// Maps are first found at this size or below.
constexpr int kProcessWidth = 128;
constexpr int kKnownLightStarts = 4;
constexpr int kKnownLightSteps = 6;  // of the trust region, each time

double Now() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// A set of points with its observations and transport.
struct Level {
  std::vector<ShadingPoint> points;
  Observations observed;
  std::unique_ptr<Transport> transport;
};

class Estimator {
 public:
  Estimator(const InverseProblem& problem, const SolveProgress& progress,
            const std::atomic<bool>* stop)
      : problem_(problem), progress_(progress), stop_(stop), start_(Now()) {}

  StatusOr<Estimate> Run() {
    IBRDF_RETURN_IF_ERROR(Prepare());
    likelihood_.scale = problem_.scale.value_or(kFirstScale);
    JointState state;
    if (!light_unknown()) {
      state = StartUnderKnownLight();
      if (problem_.solver.max_iterations > 0) KnownLightRounds(&state);
    } else if (lobes_unknown() &&
               problem_.solver.estimator == SolverEstimator::kMarginal) {
      IBRDF_RETURN_IF_ERROR(SearchMarginal(&state));
      IBRDF_RETURN_IF_ERROR(EstimateLight(&state));
    } else if (lobes_unknown()) {
      StartAtMeanMaterial(&state);
      SetLight(MakeLight(), true);
      MatchLight(&state);
      FixGauge(&state);
      first_ = state;
      first_mean_ = light_mean_;
      Report("start", cells_.get(), state);
      IBRDF_RETURN_IF_ERROR(Rounds("maximum", MethodFor(JointBlocks::kBoth),
                                   JointBlocks::kBoth, kMapShare, &state));
    } else {
      IBRDF_RETURN_IF_ERROR(EstimateLight(&state));
    }
    return Finish(state);
  }

 private:
  double Elapsed() const { return Now() - start_; }
  double Budget() const { return problem_.solver.seconds; }
  bool Interrupted() const { return stop_ != nullptr && stop_->load(); }
  bool lobes_unknown() const { return !problem_.known_brdf.has_value(); }
  bool light_unknown() const { return !problem_.known_map.has_value(); }
  // Of the time left from now on but for what Finish takes.
  std::function<bool()> StopAfter(double share) const {
    const double now = Elapsed();
    const double end =
        now + share * std::max(Budget() - finish_seconds_ - now, 0.0);
    return [this, end] { return Interrupted() || Elapsed() > end; };
  }

  Status Prepare() {
    full_ = MakeLevel(problem_.points, RadianceOf(problem_.points));
    if (full_->observed.num_valid == 0) {
      return InvalidInput("image",
                          "no pixel of the object is finite and positive in "
                          "all three channels");
    }
    if (light_unknown()) cells_ = MakeCellLevel(kMapCells);
    double mean = 0.0;
    for (size_t i = 0; i < full_->observed.radiance.size(); ++i) {
      if (full_->observed.valid[i / 3]) mean += full_->observed.radiance[i];
    }
    mean /= 3.0 * full_->observed.num_valid;
    likelihood_.epsilon = problem_.epsilon.value_or(kEpsilonShare * mean);

    if (lobes_unknown()) {
      lobes_ = std::make_unique<LobeModel>(problem_.model, problem_.lobes,
                                           problem_.transport.grid,
                                           problem_.num_threads);
      lobe_prior_ = EmbeddingPrior(problem_.model, problem_.prior_sigma);
      materials_ = JointMaterialPrior(problem_.model, problem_.lobes,
                                      problem_.prior_sigma);
    }
    return OkStatus();
  }

  static std::unique_ptr<Level> MakeLevel(std::vector<ShadingPoint> points,
                                          const std::vector<double>& radiance) {
    auto level = std::make_unique<Level>();
    level->observed = MakeObservations(radiance);
    level->points = std::move(points);
    return level;
  }
  // All pixels where the image has too few away from the limb. Points in shadow
  // have no like: they are thinned by rows and columns.
  std::unique_ptr<Level> MakeCellLevel(int cells_across) const {
    if (problem_.transport.visibility != nullptr) return MakeThinLevel();
    const std::vector<double> radiance = RadianceOf(problem_.points);
    MeanCells cells =
        JoinLikePoints(problem_.points, radiance, cells_across, kMinCosine);
    if (cells.points.empty()) return MakeLevel(problem_.points, radiance);
    return MakeLevel(std::move(cells.points), cells.radiance);
  }
  std::unique_ptr<Level> MakeThinLevel() const {
    int step = 1;
    while (problem_.points.size() >
           kThinPoints * static_cast<size_t>(step) * step) {
      ++step;
    }
    std::vector<ShadingPoint> thin;
    for (const ShadingPoint& p : problem_.points) {
      const int x = p.pixel % problem_.image.width;
      const int y = p.pixel / problem_.image.width;
      if (x % step == 0 && y % step == 0) thin.push_back(p);
    }
    std::unique_ptr<Level> level = MakeLevel(thin, RadianceOf(thin));
    if (level->observed.num_valid > 0) return level;
    return MakeLevel(problem_.points, RadianceOf(problem_.points));
  }

  std::vector<double> RadianceOf(
      const std::vector<ShadingPoint>& points) const {
    std::vector<double> radiance;
    for (const ShadingPoint& p : points) {
      const float* rgb = problem_.image.rgb.data() + size_t{3} * p.pixel;
      radiance.insert(radiance.end(), rgb, rgb + 3);
    }
    return radiance;
  }

  // Built at first use, for the present map's size.
  const Transport& TransportOf(Level* level) {
    const int height = light_ ? light_->height() : problem_.map_height;
    const int width = light_ ? light_->width() : problem_.map_width;
    if (level->transport == nullptr ||
        level->transport->map_height() != height ||
        level->transport->map_width() != width) {
      TransportOptions options = problem_.transport;
      options.num_threads = problem_.num_threads;
      const double start = Elapsed();
      level->transport =
          std::make_unique<Transport>(level->points, height, width, options);
      const double texels =
          static_cast<double>(problem_.map_width) * problem_.map_height;
      finish_seconds_ = std::min(
          kFinishPerTransport * (Elapsed() - start) *
              (static_cast<double>(full_->points.size()) /
               level->points.size()) *
              std::max(1.0, texels / (static_cast<double>(width) * height)),
          kMostFinishShare * Budget());
    }
    return *level->transport;
  }

  // The objective on a level, at the current scale and light mean. It must not
  // outlive the next change of either.
  struct LevelObjective {
    std::unique_ptr<LightOperator> known_brdf;
    std::unique_ptr<JointObjective> objective;
  };
  LevelObjective ObjectiveOn(Level* level) {
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
      terms.light_mean = light_mean_;
      for (const auto& prior : light_priors_) {
        terms.light_priors.push_back(prior.get());
      }
    } else {
      terms.known_map = problem_.known_map->rgb;
    }
    out.objective = std::make_unique<JointObjective>(std::move(terms));
    return out;
  }

  // At the image's pixels under known light the materials' prior stands in for
  // the one of the joint maximum.
  TraceEntry Entry(const std::string& stage, const Level& level,
                   const JointState& state, const JointCost& cost) const {
    TraceEntry entry;
    entry.stage = stage;
    entry.scale = likelihood_.scale;
    entry.pixels = level.observed.num_valid;
    entry.likelihood = cost.likelihood;
    entry.reflectance_prior =
        light_unknown() ? cost.reflectance_prior
                        : materials_.Cost(VectorOf(state.lobes), nullptr);
    entry.illumination_prior = cost.illumination_prior;
    entry.cost =
        entry.likelihood + entry.reflectance_prior + entry.illumination_prior;
    entry.misfit = cost.misfit;
    entry.seconds = Elapsed();
    return entry;
  }

  TraceEntry Evaluate(const std::string& stage, Level* level,
                      const JointState& state) {
    const LevelObjective on = ObjectiveOn(level);
    return Entry(stage, *level, state, on.objective->Evaluate(state));
  }

  void Report(const TraceEntry& entry) {
    trace_.push_back(entry);
    VLOG(1) << entry.stage << " " << entry.seconds << " s misfit "
            << entry.misfit << " cost " << entry.cost;
    if (progress_) progress_(entry, std::min(entry.seconds / Budget(), 1.0));
  }
  void Report(const std::string& stage, Level* level, const JointState& state) {
    Report(Evaluate(stage, level, state));
  }

  static Eigen::VectorXd VectorOf(const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(
        v.data(), static_cast<Eigen::Index>(v.size()));
  }

  // The reflectance whose posterior is highest with the light integrated out.
  Status SearchMarginal(JointState* state) {
    ReflectanceSearchOptions o;
    o.num_threads = problem_.num_threads;
    o.screen.visibility = o.coarse.visibility = o.fine.visibility =
        problem_.transport.visibility;
    o.should_stop = StopAfter(kSearchShare);
    // The first stages of a small budget of iterations are cut short alike.
    const int iterations = problem_.solver.max_iterations;
    o.starts = iterations == 0 ? 1 : o.starts;
    o.coarse_iterations = std::min(o.coarse_iterations, 5 * iterations);
    o.fine_iterations = std::min(o.fine_iterations, 5 * iterations);
    o.covariance = iterations > 0;
    o.report = [this](const std::string& stage, double cost, double misfit) {
      TraceEntry entry;
      entry.stage = stage;
      entry.pixels = full_->observed.num_valid;
      entry.cost = entry.likelihood = cost;
      entry.misfit = misfit;
      entry.seconds = Elapsed();
      Report(entry);
    };
    const StatusOr<ReflectanceSearchResult> found =
        SearchReflectance(problem_.model, materials_, problem_.points,
                          RadianceOf(problem_.points), o);
    if (!found.ok()) return found.status();
    state->lobes = found->parameters;
    const double level =
        LevelShift(problem_.model, materials_, VectorOf(state->lobes),
                   problem_.num_threads);
    for (int k = 0; k < lobes_->num_lobes(); ++k) {
      for (int c = 0; c < 3; ++c) {
        state->lobes[static_cast<size_t>(k) * lobes_->lobe_size() +
                     lobes_->code_size() + c] += level;
      }
    }
    start_name_ = found->start;
    light_amplitude_ = found->amplitude;
    const auto& materials = materials_.materials;
    const auto start =
        std::find_if(materials.begin(), materials.end(),
                     [&](const auto& m) { return m.name == found->start; });
    first_.lobes.assign(start->parameters.data(),
                        start->parameters.data() + start->parameters.size());
    covariance_ = found->covariance;
    mode_ = map_std_ = Image(found->map_width, found->map_height);
    const size_t texels = map_std_.num_pixels();
    for (size_t i = 0; i < 3 * texels; ++i) {
      const size_t from = i % 3 * texels + i / 3;
      mode_.rgb[i] = static_cast<float>(found->log_radiance[from] - level);
      map_std_.rgb[i] = static_cast<float>(found->log_radiance_std[from]);
    }
    for (const TriedMaterial& tried : found->tried) {
      if (std::isfinite(tried.cost)) tried_.push_back(tried);
    }
    return OkStatus();
  }

  void StartAtMeanMaterial(JointState* state) {
    const std::string name = SpreadMaterials(problem_.model, 1).front().name;
    for (const MaterialPrior::Material& m : materials_.materials) {
      if (m.name != name) continue;
      state->lobes.assign(m.parameters.data(),
                          m.parameters.data() + m.parameters.size());
    }
    start_name_ = name;
  }

  std::unique_ptr<IlluminationModel> MakeLight() const {
    if (problem_.illumination_prior == IlluminationPrior::kNone) {
      return MakeFreeIllumination(problem_.map_width, problem_.map_height);
    }
    IlluminationUnetOptions unet;
    unet.width = problem_.map_width;
    unet.height = problem_.map_height;
    unet.seed = problem_.seed;
    unet.num_threads = problem_.num_threads;
    return MakeUnetIllumination(unet);
  }
  // process_prior: it is no part of the model itself.
  void SetLight(std::unique_ptr<IlluminationModel> light, bool process_prior) {
    light_ = std::move(light);
    has_process_prior_ = process_prior;
    light_priors_.clear();
  }

  // A constant map at the image's level; the light's priors are centred there.
  void MatchLight(JointState* state) {
    const double zero[3] = {0, 0, 0};
    state->light = light_mean_ = light_->ConstantMap(zero);
    const LevelObjective on = ObjectiveOn(cells_.get());
    on.objective->Evaluate(*state);
    const std::vector<double>& E = on.objective->radiance();
    const Observations& o = cells_->observed;
    std::fill(level_, level_ + 3, 0.0);
    for (size_t i = 0; i < E.size(); ++i) {
      if (!o.valid[i / 3]) continue;
      level_[i % 3] +=
          (std::log(o.radiance[i]) - std::log(std::max(E[i], 0.0) + 1e-30)) /
          o.num_valid;
    }
    StartAtLevel(state);
  }
  void StartAtLevel(JointState* state) {
    state->light = light_mean_ = light_->ConstantMap(level_);
    if (!has_process_prior_) return;
    light_priors_.clear();
    light_priors_.push_back(std::make_unique<ProcessPrior>(
        light_->height(), light_->width(), LightProcess(), light_amplitude_,
        (level_[0] + level_[1] + level_[2]) / 3));
  }

  // The map given the reflectance: as a draw of the light's process first,
  // whose parameters are as good as whitened and take a tenth of the time of
  // a network's; then as the network's output, from its fit to that draw.
  Status EstimateLight(JointState* state) {
    const bool none = problem_.illumination_prior == IlluminationPrior::kNone;
    if (none || problem_.solver.max_iterations == 0) {
      SetLight(MakeLight(), !none);
      MatchLight(state);
      first_.light = state->light;
      first_mean_ = light_mean_;
      Report("constant map", cells_.get(), *state);
      return Rounds("map", MethodFor(JointBlocks::kLight), JointBlocks::kLight,
                    kMapShare, state);
    }
    const bool network =
        problem_.illumination_prior == IlluminationPrior::kUNet;
    int width = problem_.map_width, height = problem_.map_height;
    while (network && width > kProcessWidth && width % 4 == 0 &&
           height % 2 == 0) {
      width /= 2;
      height /= 2;
    }
    SetLight(MakeProcessIllumination(width, height, LightProcess(),
                                     light_amplitude_),
             false);
    MatchLight(state);
    first_.light = state->light;
    first_mean_ = light_mean_;
    Report("constant map", cells_.get(), *state);
    if (mode_.num_pixels() > 0) {
      LogMapFitOptions o;
      o.should_stop = StopAfter(kProcessShare / 2);
      FitLogMap(Planar(mode_, height, width), o, light_.get(), &state->light);
    }
    // The draw itself has one fitting method; solver.method is the network's.
    IBRDF_RETURN_IF_ERROR(Rounds(
        "map",
        network ? JointMethod::kGaussNewton : MethodFor(JointBlocks::kLight),
        JointBlocks::kLight, network ? kProcessShare : kMapShare, state));
    if (!network) return OkStatus();
    Image log_map(width, height);
    std::vector<float> planar(light_->num_outputs());
    light_->Forward(state->light.data(), planar.data());
    const size_t texels = log_map.num_pixels();
    for (size_t i = 0; i < 3 * texels; ++i) {
      log_map.rgb[i] = planar[i % 3 * texels + i / 3];
    }
    const double draw_misfit = Evaluate("map", cells_.get(), *state).misfit;
    const std::vector<float> draw = state->light, draw_mean = light_mean_;
    const JointState draw_first = first_;
    std::unique_ptr<IlluminationModel> process = std::move(light_);
    SetLight(MakeLight(), true);
    StartAtLevel(state);
    first_.light = state->light;
    first_mean_ = light_mean_;
    LogMapFitOptions o;
    o.should_stop = StopAfter(kMapShare / 2);
    FitLogMap(Planar(log_map, problem_.map_height, problem_.map_width), o,
              light_.get(), &state->light);
    Report("network", cells_.get(), *state);
    IBRDF_RETURN_IF_ERROR(Rounds("network", MethodFor(JointBlocks::kLight),
                                 JointBlocks::kLight, kMapShare, state));
    // Out of time before the network came near the draw: the draw it is.
    const double misfit = Evaluate("network", cells_.get(), *state).misfit;
    if (misfit > kWorseMisfit * draw_misfit &&
        process->width() == problem_.map_width) {
      SetLight(std::move(process), false);
      state->light = draw;
      light_mean_ = first_mean_ = draw_mean;
      first_ = draw_first;
      Report("map again", cells_.get(), *state);
    }
    return OkStatus();
  }

  // [3][height][width] of an image [H, W, 3], between its centres bilinearly.
  static std::vector<float> Planar(const Image& map, int height, int width) {
    const size_t texels = static_cast<size_t>(height) * width;
    std::vector<float> out(3 * texels);
    for (size_t t = 0; t < texels; ++t) {
      const Eigen::Array3d value =
          LookUpMap(map, MapDirection(static_cast<double>(t / width) + 0.5,
                                      static_cast<double>(t % width) + 0.5,
                                      height, width));
      for (size_t c = 0; c < 3; ++c) {
        out[c * texels + t] = static_cast<float>(value[c]);
      }
    }
    return out;
  }

  // Moves scale between the two unknowns; the image stays as it is.
  void FixGauge(JointState* state) {
    if (!lobes_unknown() || !light_unknown()) return;
    std::vector<float> log_map(light_->num_outputs());
    light_->Forward(state->light.data(), log_map.data());
    double mean[3] = {0, 0, 0};
    const int W = light_->width(), H = light_->height();
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < H; ++r) {
        const double w = TexelSolidAngle(r, H, W) / (4 * M_PI);
        for (int x = 0; x < W; ++x) {
          mean[c] += w * log_map[(static_cast<size_t>(c) * H + r) * W + x];
        }
      }
    }
    const std::vector<double> d =
        GaugeShift(*lobes_, lobe_prior_, state->lobes, mean, kLightChromaStd);
    double back[3];
    for (int c = 0; c < 3; ++c) {
      back[c] = -d[c];
      for (int k = 0; k < lobes_->num_lobes(); ++k) {
        state->lobes[static_cast<size_t>(k) * lobes_->lobe_size() +
                     lobes_->code_size() + c] += d[c];
      }
    }
    light_->ShiftChannels(back, state->light.data());
    light_->ShiftChannels(back, light_mean_.data());
  }

  JointMethod MethodFor(JointBlocks blocks) const {
    switch (problem_.solver.method) {
      case SolverMethod::kAuto:
        break;
      case SolverMethod::kAlternating:
        return JointMethod::kAlternating;
      case SolverMethod::kGaussNewton:
        return JointMethod::kGaussNewton;
      case SolverMethod::kLbfgs:
        return JointMethod::kLbfgs;
      case SolverMethod::kAdam:
        return JointMethod::kAdam;
      case SolverMethod::kTrustRegion:
        return JointMethod::kTrustRegion;
    }
    return blocks == JointBlocks::kLight ? JointMethod::kGaussNewton
                                         : JointMethod::kAlternating;
  }

  // Lowers the objective over the blocks, some steps at a scale, until a share
  // of the time is spent or a round gains less than the tolerance.
  Status Rounds(const std::string& stage, JointMethod method,
                JointBlocks blocks, double share, JointState* state) {
    Level* const level = cells_.get();
    const std::function<bool()> stop = StopAfter(share);
    if (stop() || iterations_ >= problem_.solver.max_iterations) {
      return OkStatus();
    }
    JointMethodOptions o;
    // The network's products cost more, and its fit leaves less to do.
    o.max_iterations = has_process_prior_ ? 3 : 4;
    o.max_cg_iterations = has_process_prior_ ? 20 : 40;
    o.tolerance = problem_.solver.tolerance;
    o.should_stop = stop;
    o.adam_rounds = 1;
    // The reference runs as many rounds as it is given (Chen et al. 2020).
    const bool whole_schedule = method == JointMethod::kAdam;
    TraceEntry before = Evaluate(stage, level, *state);
    for (int round = 0; iterations_ < problem_.solver.max_iterations; ++round) {
      if (stop()) break;
      UpdateScale(before.misfit);
      const LevelObjective on = ObjectiveOn(level);
      if (lobes_unknown() && light_unknown()) on.objective->Free(blocks);
      IBRDF_RETURN_IF_ERROR(CheckJointMethod(method, *on.objective));
      before = Entry(stage, *level, *state, on.objective->Evaluate(*state));
      JointState next = *state;
      MinimiseJoint(method, on.objective.get(), &next, o);
      const std::vector<float> mean = light_mean_;
      if (blocks == JointBlocks::kBoth) FixGauge(&next);
      const TraceEntry after =
          Evaluate(stage + " round " + std::to_string(round + 1), level, next);
      ++iterations_;
      if (!(after.cost < before.cost)) {
        light_mean_ = mean;
        if (whole_schedule) continue;
        break;
      }
      *state = next;
      Report(after);
      if (!whole_schedule && RoundsSettled(before, after)) break;
      before = after;
    }
    return OkStatus();
  }

  // The materials under the known light, the best few refined.
  JointState StartUnderKnownLight() {
    // Pixels as they are: under a known lamp the mean of a cell is not the
    // radiance of its mean normal.
    std::vector<ShadingPoint> few =
        GroupByNormal(problem_.points, RadianceOf(problem_.points),
                      {kKnownLightCells, 1, kMinCosine})
            .points;
    if (few.empty()) few = problem_.points;
    few_ = MakeLevel(few, RadianceOf(few));
    const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
        TransportOf(few_.get()), *lobes_, materials_, problem_.known_map->rgb,
        few_->observed, likelihood_);
    first_.lobes = ranked.front().parameters;
    start_name_ = ranked.front().name;
    JointState best = first_;
    TraceEntry least = Evaluate("start " + start_name_, few_.get(), first_);
    Report(least);
    if (problem_.solver.max_iterations == 0) return best;
    const int starts =
        std::min<int>(kKnownLightStarts, static_cast<int>(ranked.size()));
    const std::function<bool()> stop = StopAfter(kSearchShare);
    for (int k = 0; k < starts; ++k) {
      if (k > 0 && stop()) break;
      JointState state;
      state.lobes = ranked[k].parameters;
      LobeSteps(&state);
      const TraceEntry entry =
          Evaluate("start " + ranked[k].name, few_.get(), state);
      Report(entry);
      if (!(entry.cost < least.cost)) continue;
      least = entry;
      best = state;
      start_name_ = ranked[k].name;
    }
    return best;
  }

  void LobeSteps(JointState* state) const {
    ReflectanceStepOptions o;
    o.likelihood = likelihood_;
    o.materials = &materials_;
    o.max_iterations = kKnownLightSteps;
    o.tolerance = problem_.solver.tolerance;
    o.should_stop = StopAfter(1.0);
    SolveReflectance(*few_->transport, *lobes_, problem_.known_map->rgb,
                     few_->observed, o, &state->lobes);
  }

  void KnownLightRounds(JointState* state) {
    TraceEntry before = Evaluate("refine", few_.get(), *state);
    for (int round = 0; iterations_ < problem_.solver.max_iterations; ++round) {
      if (Interrupted() || Elapsed() > Budget() - finish_seconds_) return;
      UpdateScale(before.misfit);
      before = Evaluate("refine", few_.get(), *state);
      JointState next = *state;
      LobeSteps(&next);
      const TraceEntry after = Evaluate(
          "refine round " + std::to_string(round + 1), few_.get(), next);
      ++iterations_;
      if (!(after.cost < before.cost)) return;
      *state = next;
      Report(after);
      if (RoundsSettled(before, after)) return;
      before = after;
    }
  }

  // Whether another round is not worth its time.
  bool RoundsSettled(const TraceEntry& before, const TraceEntry& after) const {
    return ScaleFor(after.misfit) > kSettledScale * likelihood_.scale &&
           before.cost - after.cost < kRoundTolerance *
                                          problem_.solver.tolerance *
                                          std::max(after.cost, 1.0);
  }

  // The Laplacian's maximum-likelihood scale is the mean magnitude of the
  // residuals. It only falls, and not at once: with a small scale too early the
  // robust loss holds on to wrong pixels.
  double ScaleFor(double misfit) const {
    if (problem_.scale.has_value()) return *problem_.scale;
    return std::min(
        likelihood_.scale,
        std::max({misfit, likelihood_.scale / kScaleStep, kSmallestScale}));
  }
  void UpdateScale(double misfit) { likelihood_.scale = ScaleFor(misfit); }

  StatusOr<Estimate> Finish(JointState best) {
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

  void AddAlternatives(Estimate* estimate) const {
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

  const InverseProblem& problem_;
  const SolveProgress& progress_;
  const std::atomic<bool>* stop_;
  const double start_;
  RobustLogLikelihood likelihood_;
  // Every pixel; pixels of like normals joined, for the light and, fewer, under
  // known light.
  std::unique_ptr<Level> full_, cells_, few_;
  std::unique_ptr<LobeModel> lobes_;  // null: known
  LobePrior lobe_prior_;
  MaterialPrior materials_;
  std::unique_ptr<IlluminationModel> light_;  // null: known
  bool has_process_prior_ = false;
  std::vector<std::unique_ptr<LightPrior>> light_priors_;
  double level_[3] = {0.0, 0.0, 0.0};  // log radiance of a constant map
  // Where the prior of the light's parameters is centred: a constant map at the
  // image's level, whatever the image's unit.
  std::vector<float> light_mean_, first_mean_;
  double light_amplitude_ = 1.0;
  JointState first_;
  double finish_seconds_ = 0.0;  // predicted
  std::string start_name_;
  std::vector<TriedMaterial> tried_;
  Eigen::MatrixXd covariance_;
  Image mode_, map_std_;  // of log radiance, at the search's resolution
  std::vector<TraceEntry> trace_;
  int iterations_ = 0;
};

}  // namespace

StatusOr<Estimate> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  return Estimator(problem, progress, stop).Run();
}

}  // namespace ibrdf
