#include "solvers/inverse_rendering.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/light/environment_map.h"
#include "solvers/costs/log_radiance_cost.h"
#include "solvers/embedding_prior.h"
#include "solvers/illumination_model.h"
#include "solvers/illumination_solver.h"
#include "solvers/reflectance_solver.h"

namespace ibrdf {
namespace {

constexpr int kStarts = 5;
constexpr double kStartShare = 0.4;    // of the time, at most
constexpr double kCoarseShare = 0.65;  // of the time, starts included
// More points than this are thinned to every other row and column first.
constexpr size_t kCoarsePoints = 4000;
// The BRDF grid of the first stages: a fifth of the nodes of the last one.
constexpr BrdfGridShape kCoarseGrid = {48, 20, 12};
constexpr double kFirstScale = 0.2;      // b of the starts: tolerant
constexpr double kSmallestScale = 3e-3;  // below any real image's noise
// Standard deviation of log (red / green) and log (blue / green) of a map's
// mean log radiance: 0.25 and 0.43 over nine maps
// (experiments/light_statistics).
constexpr double kLightChromaStd = 0.35;
constexpr double kEpsilonShare = 1e-5;  // of the mean radiance

double Now() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Reflectance and illumination together, as vectors.
struct State {
  std::vector<double> lobes;  // empty: known
  std::vector<float> light;   // empty: known
  // Where the prior of `light` is centred: a constant map at the image's level,
  // whatever the image's unit.
  std::vector<float> light_mean;
};

// A set of points with its observations, and the lobes on its BRDF grid.
struct Level {
  std::vector<ShadingPoint> points;
  BrdfGridShape grid;
  Observations observed;
  std::unique_ptr<Transport> transport;
  std::unique_ptr<LobeModel> lobes;
  Level* lobe_level = nullptr;  // where lobes are fitted; null: here
};

class Estimator {
 public:
  Estimator(const InverseProblem& problem, const SolveProgress& progress,
            const std::atomic<bool>* stop)
      : problem_(problem), progress_(progress), stop_(stop), start_(Now()) {}

  StatusOr<Estimate> Run() {
    IBRDF_RETURN_IF_ERROR(Prepare());
    likelihood_.scale = problem_.scale.value_or(kFirstScale);
    State best = ChooseStart();
    const State first = first_state_;
    Rounds("coarse", coarse_.get(), kCoarseShare, &best);
    Rounds("full", full_.get(), 1.0, &best);
    return Finish(first, best);
  }

 private:
  double Elapsed() const { return Now() - start_; }
  double Budget() const { return problem_.solver.seconds; }
  bool Interrupted() const { return stop_ != nullptr && stop_->load(); }
  bool lobes_unknown() const { return !problem_.known_brdf.has_value(); }
  bool light_unknown() const { return !problem_.known_map.has_value(); }
  std::function<bool()> StopAfter(double share) const {
    return
        [this, share] { return Interrupted() || Elapsed() > share * Budget(); };
  }
  const LobeModel& lobes() const { return *full_->lobes; }

  Status Prepare() {
    full_ = MakeLevel(problem_.points, problem_.transport.grid);
    if (full_->observed.num_valid == 0) {
      return InvalidInput("image",
                          "no pixel of the object is finite and positive in "
                          "all three channels");
    }
    std::vector<ShadingPoint> thin = problem_.points;
    if (problem_.points.size() > kCoarsePoints) {
      thin.clear();
      for (const ShadingPoint& p : problem_.points) {
        const int x = p.pixel % problem_.image.width;
        const int y = p.pixel / problem_.image.width;
        if (x % 2 == 0 && y % 2 == 0) thin.push_back(p);
      }
    }
    coarse_ = MakeLevel(thin, kCoarseGrid);
    if (coarse_->observed.num_valid == 0) {
      coarse_ = MakeLevel(problem_.points, kCoarseGrid);
    } else if (thin.size() < problem_.points.size()) {
      // A few dozen lobe parameters do not need every pixel.
      thin_ = MakeLevel(std::move(thin), problem_.transport.grid);
      full_->lobe_level = thin_.get();
    }
    double mean = 0.0;
    for (size_t i = 0; i < full_->observed.radiance.size(); ++i) {
      if (full_->observed.valid[i / 3]) mean += full_->observed.radiance[i];
    }
    mean /= 3.0 * full_->observed.num_valid;
    likelihood_.epsilon = problem_.epsilon.value_or(kEpsilonShare * mean);

    if (lobes_unknown()) {
      prior_ = EmbeddingPrior(problem_.model, problem_.prior_sigma);
    }
    if (light_unknown()) {
      if (problem_.illumination_prior == IlluminationPrior::kUNet) {
        IlluminationUnetOptions unet;
        unet.width = problem_.map_width;
        unet.height = problem_.map_height;
        unet.seed = problem_.seed;
        unet.num_threads = problem_.num_threads;
        light_ = MakeUnetIllumination(unet);
      } else {
        light_ = MakeFreeIllumination(problem_.map_width, problem_.map_height);
      }
    }
    return OkStatus();
  }

  std::unique_ptr<Level> MakeLevel(std::vector<ShadingPoint> points,
                                   const BrdfGridShape& grid) const {
    auto level = std::make_unique<Level>();
    // A known BRDF comes on one grid.
    level->grid = lobes_unknown() ? grid : problem_.known_brdf->shape;
    if (lobes_unknown()) {
      level->lobes = std::make_unique<LobeModel>(
          problem_.model, problem_.lobes, level->grid, problem_.num_threads);
    }
    std::vector<double> radiance;
    for (const ShadingPoint& p : points) {
      const float* rgb = problem_.image.rgb.data() + size_t{3} * p.pixel;
      radiance.insert(radiance.end(), rgb, rgb + 3);
    }
    level->observed = MakeObservations(radiance);
    level->points = std::move(points);
    return level;
  }

  // Built at first use: a level that is never reached costs nothing.
  const Transport& TransportOf(Level* level) const {
    if (level->transport == nullptr) {
      TransportOptions options = problem_.transport;
      options.num_threads = problem_.num_threads;
      options.grid = level->grid;
      level->transport = std::make_unique<Transport>(
          level->points, problem_.map_height, problem_.map_width, options);
    }
    return *level->transport;
  }

  BrdfGrid GridOf(const Level& level, const State& state) const {
    if (!lobes_unknown()) return *problem_.known_brdf;
    std::vector<float> fields;
    level.lobes->Tabulate(state.lobes.data(), false, &fields);
    return level.lobes->Combine(state.lobes.data(), fields, 1);
  }

  std::vector<float> MapOf(const State& state) const {
    if (!light_unknown()) return problem_.known_map->rgb;
    std::vector<float> log_map(light_->num_outputs()), map;
    light_->Forward(state.light.data(), log_map.data());
    ToRadianceMap(log_map, &map);
    return map;
  }

  // The state's cost on a level at the current scale; E and map optional.
  TraceEntry Evaluate(const std::string& stage, Level* level,
                      const State& state, std::vector<double>* E_out = nullptr,
                      std::vector<float>* map_out = nullptr) {
    TraceEntry entry;
    entry.stage = stage;
    entry.scale = likelihood_.scale;
    entry.pixels = level->observed.num_valid;
    const Transport& transport = TransportOf(level);
    const BrdfGrid grid = GridOf(*level, state);
    std::vector<double> E(level->observed.radiance.size());
    std::vector<float> map;
    if (light_unknown()) {
      const LightOperator light = transport.ByLight(grid);
      const IlluminationCost cost = EvaluateIllumination(
          light, level->observed, LightOptions(0.0), state.light_mean,
          state.light.data(), light_.get(), &E, &map);
      entry.illumination_prior = cost.prior;
    } else {
      map = problem_.known_map->rgb;
      transport.Render(grid, map.data(), E.data());
    }
    double absolute = 0.0;
    const Observations& o = level->observed;
    for (size_t i = 0; i < E.size(); ++i) {
      if (!o.valid[i / 3]) continue;
      const double d = std::log(std::max(E[i], 0.0) + likelihood_.epsilon) -
                       std::log(o.radiance[i] + likelihood_.epsilon);
      absolute += std::abs(d);
      const double r =
          RobustResidual(d / likelihood_.scale, likelihood_.delta, nullptr);
      entry.likelihood += r * r / 2;
    }
    entry.misfit = absolute / (3.0 * o.num_valid);
    if (lobes_unknown()) {
      entry.reflectance_prior =
          LobePriorCostValue(lobes(), prior_, state.lobes);
    }
    entry.cost =
        entry.likelihood + entry.reflectance_prior + entry.illumination_prior;
    entry.seconds = Elapsed();
    if (E_out != nullptr) *E_out = std::move(E);
    if (map_out != nullptr) *map_out = std::move(map);
    return entry;
  }

  void Report(const TraceEntry& entry) {
    trace_.push_back(entry);
    VLOG(1) << entry.stage << " " << entry.seconds << " s misfit "
            << entry.misfit << " cost " << entry.cost;
    if (progress_) progress_(entry, std::min(entry.seconds / Budget(), 1.0));
  }

  IlluminationStepOptions LightOptions(double share) const {
    IlluminationStepOptions o;
    o.likelihood = likelihood_;
    o.lbfgs = problem_.solver.method == SolverMethod::kLbfgs;
    o.tolerance = problem_.solver.tolerance;
    o.should_stop = StopAfter(share);
    return o;
  }

  void LightStep(Level* level, int iterations, int cg_iterations, double share,
                 State* state) {
    if (!light_unknown()) return;
    const LightOperator light =
        TransportOf(level).ByLight(GridOf(*level, *state));
    IlluminationStepOptions o = LightOptions(share);
    o.max_iterations = iterations;
    o.max_cg_iterations = cg_iterations;
    SolveIllumination(light, level->observed, o, state->light_mean,
                      light_.get(), &state->light);
  }

  void LobeStep(Level* level, int iterations, double share, State* state) {
    if (!lobes_unknown()) return;
    ReflectanceStepOptions o;
    o.likelihood = likelihood_;
    o.prior = prior_;
    o.max_iterations = iterations;
    o.tolerance = problem_.solver.tolerance;
    o.should_stop = StopAfter(share);
    if (level->lobe_level != nullptr) level = level->lobe_level;
    SolveReflectance(TransportOf(level), *level->lobes, MapOf(*state),
                     level->observed, o, &state->lobes);
  }

  // Moves scale between the two unknowns; the image stays as it is.
  void FixGauge(State* state) const {
    if (!lobes_unknown() || !light_unknown()) return;
    std::vector<float> log_map(light_->num_outputs());
    light_->Forward(state->light.data(), log_map.data());
    double mean[3] = {0, 0, 0};
    const int W = problem_.map_width, H = problem_.map_height;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < H; ++r) {
        const double w = TexelSolidAngle(r, H, W) / (4 * M_PI);
        for (int x = 0; x < W; ++x) {
          mean[c] += w * log_map[(static_cast<size_t>(c) * H + r) * W + x];
        }
      }
    }
    const std::vector<double> d =
        GaugeShift(lobes(), prior_, state->lobes, mean, kLightChromaStd);
    double back[3];
    for (int c = 0; c < 3; ++c) {
      back[c] = -d[c];
      for (int k = 0; k < lobes().num_lobes(); ++k) {
        state->lobes[static_cast<size_t>(k) * lobes().lobe_size() +
                     lobes().code_size() + c] += d[c];
      }
    }
    light_->ShiftChannels(back, state->light.data());
    light_->ShiftChannels(back, state->light_mean.data());
  }

  // The state with a constant map (where unknown) at the image's level, or with
  // the colours at the image's level where the light is known.
  void MatchLevel(Level* level, State* state) {
    if (light_unknown()) {
      const double zero[3] = {0, 0, 0};
      state->light = state->light_mean = light_->ConstantMap(zero);
    }
    std::vector<double> E;
    Evaluate("level", level, *state, &E);
    const Observations& o = level->observed;
    double shift[3] = {0, 0, 0};
    for (size_t i = 0; i < E.size(); ++i) {
      if (!o.valid[i / 3]) continue;
      shift[i % 3] +=
          (std::log(o.radiance[i]) - std::log(std::max(E[i], 0.0) + 1e-30)) /
          o.num_valid;
    }
    if (light_unknown()) {
      light_->ShiftChannels(shift, state->light.data());
      state->light_mean = state->light;
    } else if (lobes_unknown()) {
      for (int k = 0; k < lobes().num_lobes(); ++k) {
        for (int c = 0; c < 3; ++c) {
          state->lobes[static_cast<size_t>(k) * lobes().lobe_size() +
                       lobes().code_size() + c] += shift[c];
        }
      }
    }
  }

  // Lobe 0 begins as the material, the others as the most matte one, a
  // fraction of its strength.
  State StartFrom(const MaterialCode& material, const MaterialCode& matte) {
    State state;
    for (int k = 0; k < lobes().num_lobes(); ++k) {
      const MaterialCode& m = k == 0 ? material : matte;
      state.lobes.insert(state.lobes.end(), m.code.begin(), m.code.end());
      const double a = m.log_colour - (k == 0 ? 0.0 : 1.0);
      state.lobes.insert(state.lobes.end(), {a, a, a});
    }
    return state;
  }

  // The material whose peak stands out least from its reflectance at wide
  // angles.
  MaterialCode MostMatte() const {
    const std::unique_ptr<BrdfFlow> flow =
        BrdfFlow::Create(problem_.model.shape, problem_.model.weights);
    const std::vector<MaterialCode> all = MaterialCodes(problem_.model);
    double least = std::numeric_limits<double>::infinity();
    MaterialCode best = all.front();
    for (const MaterialCode& m : all) {
      const std::vector<float> code(m.code.begin(), m.code.end());
      // Two points [3][2]: theta_h = 0 and wide, theta_d = 18 degrees.
      const float x[6] = {0.02f, 0.8f, 0.2f, 0.2f, 0.5f, 0.5f};
      float value[2];
      flow->LogDensity(x, 2, code.data(), 1, value, nullptr, nullptr);
      if (value[0] - value[1] < least) {
        least = value[0] - value[1];
        best = m;
      }
    }
    return best;
  }

  // Runs several starts cheaply and returns the one of least cost.
  State ChooseStart() {
    Level* level = coarse_.get();
    if (!lobes_unknown()) {
      State state;
      MatchLevel(level, &state);
      first_state_ = state;
      Report(Evaluate("start", level, state));
      return state;
    }
    const MaterialCode matte = MostMatte();
    std::vector<MaterialCode> materials =
        SpreadMaterials(problem_.model, kStarts);
    State best;
    double best_cost = std::numeric_limits<double>::infinity();
    int tried = 0;
    for (const MaterialCode& material : materials) {
      const double share = kStartShare * ++tried / kStarts;
      if (tried > 1 && StopAfter(kStartShare)()) break;
      State state = StartFrom(material, matte);
      MatchLevel(level, &state);
      FixGauge(&state);
      if (tried == 1) {
        first_state_ = best = state;
        start_name_ = material.name;
        Report(Evaluate("start", level, state));
      }
      if (problem_.solver.max_iterations == 0) break;
      LightStep(level, 2, 10, share, &state);
      LobeStep(level, light_unknown() ? 4 : 6, share, &state);
      LightStep(level, 2, 10, share, &state);
      FixGauge(&state);
      const TraceEntry entry = Evaluate("start " + material.name, level, state);
      Report(entry);
      if (entry.cost < best_cost) {
        best_cost = entry.cost;
        best = state;
        start_name_ = material.name;
      }
    }
    return best;
  }

  // Alternates the two blocks until a share of the time is spent or a round
  // gains less than the tolerance.
  void Rounds(const std::string& stage, Level* level, double share,
              State* state) {
    TraceEntry before = Evaluate(stage, level, *state);
    for (int round = 0; iterations_ < problem_.solver.max_iterations; ++round) {
      if (StopAfter(share)()) return;
      UpdateScale(before.misfit);
      before = Evaluate(stage, level, *state);
      State next = *state;
      LightStep(level, 3, 15, share, &next);
      LobeStep(level, 5, share, &next);
      FixGauge(&next);
      const TraceEntry after =
          Evaluate(stage + " round " + std::to_string(round + 1), level, next);
      ++iterations_;
      if (!(after.cost < before.cost)) return;
      *state = next;
      Report(after);
      const double gain = before.cost - after.cost;
      const bool scale_settled = ScaleFor(after.misfit) == likelihood_.scale;
      before = after;
      if (scale_settled &&
          gain < problem_.solver.tolerance * std::max(after.cost, 1.0)) {
        return;
      }
    }
  }

  // The Laplacian's maximum-likelihood scale is the mean magnitude of the
  // residuals. It only falls, at most by half a round: with a small scale too
  // early the robust loss holds on to wrong pixels.
  double ScaleFor(double misfit) const {
    if (problem_.scale.has_value()) return *problem_.scale;
    return std::min(likelihood_.scale,
                    std::max({misfit, likelihood_.scale / 2, kSmallestScale}));
  }
  void UpdateScale(double misfit) { likelihood_.scale = ScaleFor(misfit); }

  StatusOr<Estimate> Finish(const State& first, State best) {
    Estimate estimate;
    std::vector<double> E;
    std::vector<float> map;
    const TraceEntry start = Evaluate("start", full_.get(), first);
    TraceEntry end = Evaluate("end", full_.get(), best, &E, &map);
    if (!(end.cost < start.cost)) {
      best = first;
      end = Evaluate("end", full_.get(), best, &E, &map);
      estimate.status = Status(StatusCode::kNoImprovement,
                               "the solver could not improve on its start");
    }
    if (Interrupted()) {
      estimate.status = Status(StatusCode::kInterrupted,
                               "interrupted; the best iterate was kept");
    }
    Report(end);
    estimate.map = Image(problem_.map_width, problem_.map_height);
    estimate.map.rgb = map;
    estimate.render = Image(problem_.image.width, problem_.image.height);
    for (size_t i = 0; i < full_->points.size(); ++i) {
      float* rgb =
          estimate.render.rgb.data() + size_t{3} * full_->points[i].pixel;
      for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(E[3 * i + c]);
    }
    if (lobes_unknown()) {
      estimate.lobe_parameters = best.lobes;
      estimate.brdf = lobes().ToMerl(best.lobes.data());
    }
    estimate.scale = likelihood_.scale;
    estimate.epsilon = likelihood_.epsilon;
    estimate.misfit = end.misfit;
    estimate.pixels_used = full_->observed.num_valid;
    estimate.start = start_name_;
    estimate.trace = std::move(trace_);
    estimate.seconds = Elapsed();
    return estimate;
  }

  const InverseProblem& problem_;
  const SolveProgress& progress_;
  const std::atomic<bool>* stop_;
  const double start_;
  RobustLogLikelihood likelihood_;
  std::unique_ptr<Level> full_, coarse_, thin_;
  LobePrior prior_;
  std::unique_ptr<IlluminationModel> light_;
  State first_state_;
  std::string start_name_;
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
