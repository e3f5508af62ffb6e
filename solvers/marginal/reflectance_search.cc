#include "solvers/marginal/reflectance_search.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "ibrdf/base/parallel_for.h"
#include "solvers/marginal/marginal_objective.h"
#include "solvers/stop_callback.h"

namespace ibrdf {
namespace {

// Of a ranking's modes, nats: materials differ by tens.
constexpr double kRankingTolerance = 0.5;
// Standard deviation of log radiance with which a first mode is sought, from
// which the noise of the coarse map follows.
constexpr double kFirstSigma = 0.15;
// Of a refinement, relative: a twentieth of a nat in a thousand.
constexpr double kFunctionTolerance = 5e-5;
// Step of the differences of gradients, in prior standard deviations.
constexpr double kHessianStep = 0.02;

// A search at one resolution.
class Level {
 public:
  Level(const NeuralBrdfModel& model, const MaterialPrior& prior,
        const std::vector<ShadingPoint>& points,
        const std::vector<double>& radiance,
        const MarginalResolution& resolution,
        const ReflectanceSearchOptions& options)
      : prior_(prior),
        options_(options),
        reflectance_(model, prior.num_lobes(), points, radiance,
                     options.process, resolution, options.num_threads) {}

  const MarginalReflectance& reflectance() const { return reflectance_; }

  // The noise at the mode of a reflectance's matrices; `mode` receives it.
  Eigen::VectorXd NoiseOf(const std::array<RowMatrix, 3>& matrices,
                          double log_amplitude, LightMode* mode) const {
    const MarginalLikelihood& likelihood = reflectance_.likelihood();
    const Eigen::Index n =
        3 * static_cast<Eigen::Index>(reflectance_.cells().num_cells());
    likelihood.Evaluate(matrices,
                        Eigen::VectorXd::Constant(n, kFirstSigma * kFirstSigma),
                        log_amplitude, kRankingTolerance, mode, nullptr);
    return likelihood.NoiseVariance(matrices, options_.sigma, *mode);
  }

  MarginalObjective Objective(const Eigen::VectorXd& noise,
                              LightMode* mode) const {
    return MarginalObjective(&reflectance_, &prior_, options_.log_amplitude_std,
                             noise, mode);
  }

  // -log posterior at amplitude 1; infinite where it has none.
  double Rank(const Eigen::VectorXd& lobes, double* misfit) const {
    LightMode mode;
    const std::array<RowMatrix, 3> matrices =
        reflectance_.Matrices(lobes.data());
    const Eigen::VectorXd noise = NoiseOf(matrices, 0.0, &mode);
    const MarginalValue value = reflectance_.likelihood().Evaluate(
        matrices, noise, 0.0, kRankingTolerance, &mode, nullptr);
    if (!value.ok) return std::numeric_limits<double>::infinity();
    *misfit = value.misfit;
    return value.cost + prior_.Cost(lobes, nullptr);
  }

  struct End {
    bool ok = false;
    std::vector<double> y;
    double cost = std::numeric_limits<double>::infinity();
    MarginalValue value;
    LightMode mode;
    Eigen::VectorXd noise;
  };
  End Refine(const Eigen::VectorXd& lobes, double log_amplitude,
             int iterations) const {
    End end;
    end.noise =
        NoiseOf(reflectance_.Matrices(lobes.data()), log_amplitude, &end.mode);
    // Owned by the problem, which must not outlive the mode.
    auto* objective =
        new MarginalObjective(&reflectance_, &prior_,
                              options_.log_amplitude_std, end.noise, &end.mode);
    const ceres::GradientProblem problem(objective);
    end.y = objective->Whitened(lobes, log_amplitude);
    // Finds the light before the first line search needs it.
    std::vector<double> gradient(end.y.size());
    double first = 0.0;
    if (!objective->Evaluate(end.y.data(), &first, gradient.data())) return end;
    ceres::GradientProblemSolver::Options o;
    o.line_search_direction_type = ceres::BFGS;
    o.max_num_iterations = iterations;
    o.function_tolerance = kFunctionTolerance;
    o.logging_type = ceres::SILENT;
    StopCallback stop(options_.should_stop);
    o.callbacks.push_back(&stop);
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(o, problem, end.y.data(), &summary);
    end.ok = objective->Evaluate(end.y.data(), &end.cost, gradient.data());
    end.value = objective->last_value();
    return end;
  }

  // Inverse of the Hessian at y by central differences of gradients, mapped to
  // lobe parameters. Empty where it is not positive definite or time ran out.
  Eigen::MatrixXd Covariance(const End& end) const {
    const auto n = static_cast<Eigen::Index>(end.y.size());
    Eigen::MatrixXd hessian(n, n);
    std::vector<char> done(n, 0);
    ParallelFor(n, options_.num_threads, [&](int64_t i, int) {
      if (options_.should_stop && options_.should_stop()) return;
      Eigen::VectorXd side[2];
      for (int s = 0; s < 2; ++s) {
        std::vector<double> y = end.y;
        y[i] += s == 0 ? kHessianStep : -kHessianStep;
        LightMode at = end.mode;
        const MarginalObjective objective = Objective(end.noise, &at);
        double cost = 0.0;
        side[s].resize(n);
        if (!objective.Evaluate(y.data(), &cost, side[s].data())) return;
      }
      hessian.col(i) = (side[0] - side[1]) / (2 * kHessianStep);
      done[i] = 1;
    });
    if (std::find(done.begin(), done.end(), 0) != done.end()) return {};
    const Eigen::MatrixXd symmetric = 0.5 * (hessian + hessian.transpose());
    const Eigen::LLT<Eigen::MatrixXd> llt(symmetric);
    if (llt.info() != Eigen::Success) return {};
    const Eigen::Index lobes = prior_.num_parameters();
    const Eigen::MatrixXd inverse =
        llt.solve(Eigen::MatrixXd::Identity(n, n)).topLeftCorner(lobes, lobes);
    const Eigen::MatrixXd factor = prior_.factor.triangularView<Eigen::Lower>();
    return factor * inverse * factor.transpose();
  }

 private:
  const MaterialPrior& prior_;
  const ReflectanceSearchOptions& options_;
  MarginalReflectance reflectance_;
};

std::vector<double> ToVector(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

}  // namespace

StatusOr<ReflectanceSearchResult> SearchReflectance(
    const NeuralBrdfModel& model, const MaterialPrior& prior,
    const std::vector<ShadingPoint>& points,
    const std::vector<double>& radiance,
    const ReflectanceSearchOptions& options) {
  CHECK(!prior.materials.empty());
  if (GroupByNormal(points, radiance, options.coarse.cells).num_cells() == 0) {
    return InvalidInput("image",
                        "no pixel of the object, limb aside, is finite and "
                        "positive in all three channels");
  }
  const auto stopped = [&] {
    return options.should_stop && options.should_stop();
  };
  const auto report = [&](const std::string& stage, double cost,
                          double misfit) {
    if (options.report) options.report(stage, cost, misfit);
  };
  ReflectanceSearchResult result;
  const auto count = static_cast<int64_t>(prior.materials.size());
  for (const MaterialPrior::Material& m : prior.materials) {
    result.tried.push_back({m.name, std::numeric_limits<double>::infinity(),
                            0.0, std::numeric_limits<double>::infinity(),
                            ToVector(m.parameters)});
  }
  // Whole materials in parallel: what each does inside then runs in its thread.
  const auto rank = [&](const Level& level, int64_t first_count) {
    ParallelFor(first_count, options.num_threads, [&](int64_t i, int) {
      TriedMaterial& tried = result.tried[i];
      if (i > 0 && stopped()) return;
      tried.first_cost =
          level.Rank(Eigen::Map<const Eigen::VectorXd>(
                         tried.parameters.data(),
                         static_cast<Eigen::Index>(tried.parameters.size())),
                     &tried.first_misfit);
    });
    std::stable_sort(result.tried.begin(), result.tried.begin() + first_count,
                     [](const TriedMaterial& a, const TriedMaterial& b) {
                       return a.first_cost < b.first_cost;
                     });
  };
  rank(Level(model, prior, points, radiance, options.screen, options), count);
  const Level coarse(model, prior, points, radiance, options.coarse, options);
  // Costs of the two resolutions do not compare.
  const int64_t kept = std::min<int64_t>(options.kept, count);
  for (int64_t i = kept; i < count; ++i) {
    result.tried[i].first_cost = std::numeric_limits<double>::infinity();
  }
  rank(coarse, kept);
  report("rank " + std::to_string(count) + " materials",
         result.tried.front().first_cost, result.tried.front().first_misfit);
  Level::End best;
  std::string best_name = result.tried.front().name;
  // Whole refinements in parallel, as the rankings; joined in order.
  const int starts = std::min<int>(options.starts, static_cast<int>(kept));
  std::vector<Level::End> ends(starts);
  ParallelFor(starts, options.num_threads, [&](int64_t k, int) {
    const TriedMaterial& tried = result.tried[k];
    if ((k > 0 && stopped()) || !std::isfinite(tried.first_cost)) return;
    ends[k] =
        coarse.Refine(Eigen::Map<const Eigen::VectorXd>(
                          tried.parameters.data(),
                          static_cast<Eigen::Index>(tried.parameters.size())),
                      0.0, options.coarse_iterations);
  });
  for (int k = 0; k < starts; ++k) {
    Level::End& end = ends[k];
    if (!end.ok) continue;
    TriedMaterial& tried = result.tried[k];
    LightMode unused;
    tried.cost = end.cost;
    tried.parameters =
        ToVector(coarse.Objective(end.noise, &unused).LobesOf(end.y.data()));
    report("refine " + tried.name, end.cost, end.value.misfit);
    if (end.cost < best.cost) {
      best = std::move(end);
      best_name = tried.name;
    }
  }
  if (!best.ok) {
    return Status(StatusCode::kNoImprovement,
                  "no training material explains the image at all");
  }
  std::stable_sort(result.tried.begin(), result.tried.end(),
                   [](const TriedMaterial& a, const TriedMaterial& b) {
                     return a.cost < b.cost;
                   });
  const Level* level = &coarse;
  std::unique_ptr<Level> fine;
  LightMode unused;
  if (options.fine_iterations > 0 && !stopped()) {
    fine = std::make_unique<Level>(model, prior, points, radiance, options.fine,
                                   options);
    const MarginalObjective objective = coarse.Objective(best.noise, &unused);
    Level::End end = fine->Refine(objective.LobesOf(best.y.data()),
                                  objective.LogAmplitudeOf(best.y.data()),
                                  options.fine_iterations);
    if (end.ok) {
      level = fine.get();
      best = std::move(end);
      report("finish " + best_name, best.cost, best.value.misfit);
    }
  }
  const MarginalObjective objective = level->Objective(best.noise, &unused);
  const double log_amplitude = objective.LogAmplitudeOf(best.y.data());
  result.parameters = ToVector(objective.LobesOf(best.y.data()));
  result.start = best_name;
  result.cost = best.cost;
  result.misfit = best.value.misfit;
  result.amplitude = std::exp(log_amplitude);
  if (options.covariance && !stopped()) {
    result.covariance = level->Covariance(best);
  }
  const MarginalReflectance& reflectance = level->reflectance();
  result.map_width = reflectance.resolution().map_width;
  result.map_height = reflectance.resolution().map_height;
  result.log_radiance =
      ToVector((best.mode.l.array() + best.mode.level).matrix());
  result.log_radiance_std = ToVector(
      reflectance.likelihood()
          .LightVariance(reflectance.Matrices(result.parameters.data()),
                         best.noise, log_amplitude, best.mode)
          .cwiseSqrt());
  return result;
}

}  // namespace ibrdf
