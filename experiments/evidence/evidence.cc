// Is the truth what the joint posterior deems probable? For problems that give
// it: the cost of what the search finds beside that of the two lobes that come
// nearest to the true table, and where a descent from those ends.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/baselines/cook_torrance_prior.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/marginal/marginal_descent.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/observation/observation.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "ibrdf/solvers/problem/truth.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

namespace ibrdf {
namespace {

constexpr int kDescentIterations = 40;
// Past the search's own stop.
constexpr int kFurtherIterations = 200;
constexpr double kFurtherGain = 1e-4;  // nats
constexpr int kSpreadDraws = 64;
// Factors of the noise that light inside texels makes, at which the likelihood
// is taken.
constexpr std::array<double, 6> kTexelNoise = {2.0, 1.0, 0.5, 0.25, 0.1, 0.0};

struct StudyOptions {
  int bins_across = 0;  // of the finest resolution; 0: the search's
  bool texel_noise = false;
  bool found_alone = false;
  bool further = false;
  bool spread = false;
  int breadth = 1;
  bool ball_prior = false;
  bool cook_torrance = false;
  int most_directional_lights =
      ReflectanceSearchOptions().most_directional_lights;
  int num_threads = 0;
};

// Its search's finest resolution, its truth, and the metric.
class EvidenceStudy {
 public:
  EvidenceStudy(std::string name, const InverseProblem& problem,
                const Truth& truth, MaterialPrior prior,
                const StudyOptions& study)
      : name_(std::move(name)),
        problem_(problem),
        truth_(truth),
        prior_(std::move(prior)),
        factory_(study.cook_torrance
                     ? CookTorranceLobes::Factory(problem.num_threads)
                     : FlowLobes::Factory(*problem.model, prior_.layout(),
                                          problem.num_threads)),
        lobes_(factory_(problem.transport.grid)),
        study_(study),
        observed_(Observe(problem.image, nullptr, problem.points).observed) {
    options_.num_threads = problem.num_threads;
    options_.covariance = study.spread;
    options_.most_directional_lights = study.most_directional_lights;
    options_.kept *= study.breadth;
    for (SearchStage& round : options_.coarse_stages) {
      round.most *= study.breadth;
    }
    options_.screen.visibility = options_.coarse.visibility =
        options_.fine.visibility = problem.transport.visibility;
    if (study.bins_across > 0) {
      options_.fine.bins.bins_across = study.bins_across;
      options_.fine.map_width = 2 * study.bins_across;
      options_.fine.map_height = study.bins_across;
    }
  }

  Status Run() const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
        {factory_, &prior_}, problem_.points, observed_, options_);
    if (!found.ok()) return found.status();
    const double seconds =
        std::chrono::duration<double>(Clock::now() - start).count();
    const MarginalReflectance fine(
        factory_, problem_.points, observed_, options_.process, options_.fine,
        problem_.num_threads, found->directional_lights);
    std::printf("%s: search %.1f s, from %s\n", name_.c_str(), seconds,
                found->initial_guess.c_str());
    const Point end = {ToEigen(found->parameters), found->hyperparameters};
    Show(fine, "found", end);
    if (study_.spread) ShowSpread(*found);
    if (study_.further) {
      const Descent descent =
          DescendFrom(fine, end, kFurtherIterations, kFurtherGain);
      std::printf("  %d steps further\n", descent.summary.iterations);
      Show(fine, "further", descent.end);
    }
    if (study_.found_alone) return OkStatus();
    LobeTableFitOptions fit_options;
    fit_options.lobes = problem_.lobes;
    fit_options.lambertian = prior_.layout().lambertian;
    fit_options.num_threads = problem_.num_threads;
    const StatusOr<LobeTableFit> fit =
        LobeTableFitter(*problem_.model).Fit(truth_.brdf, fit_options);
    if (!fit.ok()) return fit.status();
    // The prior tells lobes apart: the order that it prefers.
    std::vector<double> nearest = fit->parameters;
    LevelGauge(*problem_.model, prior_, problem_.num_threads)
        .Fix(nearest.data());
    std::vector<double> turned = nearest;
    const auto end_of_codes =
        turned.begin() + lobes_->layout().num_coded() * lobes_->lobe_size();
    std::rotate(turned.begin(), end_of_codes - lobes_->lobe_size(),
                end_of_codes);
    if (prior_.Cost(ToEigen(turned), nullptr) <
        prior_.Cost(ToEigen(nearest), nullptr)) {
      nearest = turned;
    }
    const Point truth = {ToEigen(nearest), {}};
    Show(fine, "truth", truth);
    Show(fine, "from truth",
         DescendFrom(fine, truth, kDescentIterations,
                     MarginalDescentOptions().least_gain)
             .end);
    return OkStatus();
  }

 private:
  struct Point {
    Eigen::VectorXd lobes;  // directional lights where the search left them
    LightHyperparameters hyperparameters;
  };
  struct Descent {
    MarginalDescent summary;
    MarginalValue value;
    DataErrors errors;  // taken at the start
    Point end;
  };
  Descent DescendFrom(const MarginalReflectance& fine, const Point& start,
                      int iterations, double least_gain) const {
    Descent descent;
    LightMode mode;
    descent.errors = fine.likelihood().FindErrors(
        fine.Matrices(fine.WithDirectionalLights(start.lobes).data()), {},
        options_.sigma, start.hyperparameters,
        MarginalObjective::kModeTolerance, &mode);
    const MarginalObjective objective(&fine, &prior_, descent.errors, &mode);
    std::vector<double> y = objective.Whitened(
        fine.WithDirectionalLights(start.lobes), start.hyperparameters);
    MarginalDescentOptions o;
    o.max_iterations = iterations;
    o.least_gain = least_gain;
    descent.summary = Descend(objective, o, &y);
    descent.value = objective.last_value();
    descent.end = {objective.LobesOf(y.data()),
                   objective.HyperparametersOf(y.data())};
    return descent;
  }

  // With the noise of the point itself, so that all costs compare.
  void Show(const MarginalReflectance& fine, const char* what,
            const Point& point) const {
    const Descent here = DescendFrom(fine, point, 0, 0.0);
    if (!here.summary.ok) {
      std::printf("  %-10s no cost\n", what);
      return;
    }
    const StatusOr<BrdfMetrics> metrics =
        CompareBrdfs(lobes_->ToMerl(point.lobes.data()), truth_.brdf);
    std::printf(
        "  %-10s cost %8.1f = likelihood %8.1f + prior %5.1f  misfit %.4f  "
        "noise %.4f  BRDF aligned %.3f\n",
        what, here.summary.cost, here.value.cost,
        here.summary.cost - here.value.cost, here.value.misfit,
        here.errors.noise.cwiseSqrt().mean(),
        metrics.ok() ? metrics->log_rmse_aligned : std::nan(""));
    const LightHyperparameters& light = point.hyperparameters;
    std::printf("  %-10s light: log amplitude %.2f, log roughness", "",
                light.log_amplitude);
    for (const double r : light.log_roughness) std::printf(" %.2f", r);
    std::printf("\n");
    if (study_.texel_noise) SweepTexelNoise(fine, point, here.errors.noise);
    std::fflush(stdout);  // one problem takes half a minute
  }

  void ShowSpread(const ReflectanceSearchResult& found) const {
    const std::vector<double> covariance(
        found.covariance.data(),
        found.covariance.data() + found.covariance.size());
    const double spread =
        ReflectanceSpread(LobeDistance(factory_), found.parameters, covariance,
                          kSpreadDraws, problem_.seed);
    std::printf("  spread %.3f\n", spread);
  }

  void SweepTexelNoise(const MarginalReflectance& fine, const Point& point,
                       const Eigen::VectorXd& noise) const {
    const std::array<RowMatrix, 3> matrices =
        fine.Matrices(fine.WithDirectionalLights(point.lobes).data());
    const double own = options_.sigma * options_.sigma;
    std::printf("    texel noise times:");
    for (const double factor : kTexelNoise) {
      LightMode mode;
      const MarginalValue value = fine.likelihood().Evaluate(
          matrices, {(own + factor * (noise.array() - own)).matrix(), {}},
          point.hyperparameters, MarginalObjective::kModeTolerance, &mode,
          nullptr);
      std::printf("  %.2f %.1f", factor, value.cost);
    }
    std::printf("\n");
  }

  const std::string name_;
  const InverseProblem& problem_;
  const Truth& truth_;
  const MaterialPrior prior_;
  const LobeFactory factory_;
  const std::unique_ptr<const LobeModel> lobes_;
  const StudyOptions study_;
  const Observations observed_;
  ReflectanceSearchOptions options_;
};

// cook_torrance: priors by the model's path, which take a while to fit.
Status Study(const std::string& path, const StudyOptions& options,
             std::map<std::string, MaterialPrior>* cook_torrance) {
  const StatusOr<Problem> problem = ReadProblem(path, {});
  if (!problem.ok()) return problem.status();
  const StatusOr<InverseProblem> inverse =
      LoadInverseProblem(*problem, 1, options.num_threads);
  if (!inverse.ok()) return inverse.status();
  const StatusOr<Truth> truth =
      LoadTruth(problem->truth, inverse->map_width, inverse->map_height);
  if (!truth.ok()) return truth.status();
  if (truth->brdf.raw.empty()) {
    return InvalidInput(path, "truth.brdf is needed here");
  }
  const int lobes = inverse->lobes;
  MaterialPrior prior =
      options.ball_prior
          ? BallPrior(*inverse->model, lobes, inverse->prior_sigma)
          : JointMaterialPrior(*inverse->model, lobes, inverse->prior_sigma);
  if (options.cook_torrance) {
    const auto [known, is_new] =
        cook_torrance->try_emplace(problem->reflectance.model, MaterialPrior());
    if (is_new) {
      StatusOr<MaterialPrior> fitted =
          CookTorrancePrior(*inverse->model, options.num_threads);
      if (!fitted.ok()) return fitted.status();
      known->second = std::move(*fitted);
    }
    prior = known->second;
  }
  return EvidenceStudy(path, *inverse, *truth, std::move(prior), options).Run();
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  CLI::App app("Costs of the truth and of what a search finds");
  std::vector<std::string> problems;
  ibrdf::StudyOptions options;
  app.add_option("problems", problems, "joint problems with truth.brdf")
      ->required();
  app.add_option("--cells", options.bins_across,
                 "cells across and rows of the map, finest resolution");
  app.add_flag("--texel-noise", options.texel_noise,
               "the likelihood at several strengths of light inside texels");
  CLI::Option* const found =
      app.add_flag("--found", options.found_alone,
                   "the search alone, without the lobes nearest to the truth");
  app.add_flag(
      "--ball-prior", options.ball_prior,
      "codes N(0, prior_sigma^2), colours as the embedding's, in place "
      "of the materials' joint Gaussian");
  app.add_flag("--cook-torrance", options.cook_torrance,
               "search among Lambertian plus Cook-Torrance, not the flow")
      ->needs(found)
      ->excludes("--ball-prior");
  app.add_flag("--further", options.further,
               "the search's last descent, far past its stop");
  app.add_option("--breadth", options.breadth,
                 "so many times the search's own materials go on from each "
                 "stage to the next")
      ->check(CLI::Range(1, 8));
  app.add_flag("--spread", options.spread,
               "how far apart draws of the posterior are");
  app.add_option("--lamps", options.most_directional_lights,
                 "at most; the search's own: 3")
      ->check(CLI::Range(0, 8));
  app.add_option("--threads", options.num_threads, "0: all");
  CLI11_PARSE(app, argc, argv);
  std::map<std::string, ibrdf::MaterialPrior> cook_torrance;
  for (const std::string& path : problems) {
    const ibrdf::Status status = ibrdf::Study(path, options, &cook_torrance);
    if (status.ok()) continue;
    std::fprintf(stderr, "%s\n", status.message().c_str());
    return status.ExitCode();
  }
  return 0;
}
