#include "ibrdf/solvers/next_view/informative_views.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/marginal/view_information.h"

namespace ibrdf {
namespace {

// What all views are looked at by.
struct Estimated {
  const InverseProblem* problem = nullptr;
  LobeFactory lobes;
  MarginalResolution resolution;  // with the shadows of the photographs
  std::vector<Eigen::Vector3d> directional_lights;
  Eigen::VectorXd parameters;  // as MarginalReflectance's
  // To parameters from those whose prior is N(., 1).
  Eigen::MatrixXd whitening;
  double sigma = ReflectanceSearchOptions().sigma;
  LightMode mode;  // of the light, given the lobes

  int num_nuisance() const {
    return 2 * static_cast<int>(directional_lights.size());
  }
};

Eigen::MatrixXd WhiteningOf(const MaterialPrior& prior, int num_nuisance) {
  const Eigen::Index n = prior.num_parameters(), all = n + num_nuisance;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(all, all);
  out.topLeftCorner(n, n) = prior.factor.triangularView<Eigen::Lower>();
  for (Eigen::Index i = n; i < all; ++i) {
    out(i, i) = MarginalObjective::kDirectionalLightOffsetStd;
  }
  return out;
}

MarginalReflectance ReflectanceOn(const std::vector<ShadingPoint>& points,
                                  const Observations& observed,
                                  const MarginalResolution& resolution,
                                  const Estimated& estimated, int num_threads) {
  return MarginalReflectance(estimated.lobes, points, observed, LightProcess(),
                             resolution, num_threads,
                             estimated.directional_lights);
}

// Finds the light's mode as well. Empty where there is none.
LinearPosterior PosteriorOfPhotographs(const SolveSetup& setup,
                                       const Solution& solution,
                                       Estimated* estimated) {
  const InverseProblem& problem = *estimated->problem;
  const MarginalReflectance photographs =
      ReflectanceOn(problem.points, SearchedPixels(setup),
                    estimated->resolution, *estimated, problem.num_threads);
  const Eigen::VectorXd lobes = ToEigen(solution.lobe_parameters);
  estimated->parameters = photographs.WithDirectionalLights(lobes);
  const double* const parameters = estimated->parameters.data();
  const MarginalLikelihood& likelihood = photographs.likelihood();
  const LightHyperparameters& hyperparameters = solution.light_hyperparameters;
  const std::array<RowMatrix, 3> matrices = photographs.Matrices(parameters);
  LightMode* const mode = &estimated->mode;
  const DataErrors errors =
      likelihood.FindErrors(matrices, {}, estimated->sigma, hyperparameters,
                            MarginalObjective::kModeTolerance, mode);
  if (!likelihood
           .Evaluate(matrices, errors, hyperparameters,
                     MarginalObjective::kModeTolerance, mode, nullptr)
           .ok) {
    return {};
  }
  const RowMatrix G =
      photographs.Slopes(parameters, estimated->sigma, *mode).by_parameters *
      estimated->whitening;
  if (!G.allFinite()) return {};
  LinearPosterior posterior =
      likelihood.Linearised(matrices, errors, hyperparameters, *mode, G);
  if (posterior.information.size() == 0) return {};
  // The wall about the codes is part of the prior.
  const Eigen::Index n = estimated->whitening.rows();
  Eigen::MatrixXd wall = Eigen::MatrixXd::Zero(n, n);
  setup.materials.AddWallInformation(lobes, &wall);
  posterior.information +=
      estimated->whitening.transpose() * wall * estimated->whitening;
  return posterior;
}

// Candidates whose lobes are tabulated once: a transport of all would not fit
// into memory.
constexpr size_t kCandidatesAtOnce = 8;

// The points of candidates [begin, end) that bins keep, numbered from 0; view:
// the candidate's number less begin.
std::vector<ShadingPoint> BinnedPoints(
    const std::vector<std::vector<ShadingPoint>>& candidates, size_t begin,
    size_t end, const NormalBinOptions& options) {
  std::vector<ShadingPoint> points;
  for (size_t k = begin; k < end; ++k) {
    for (ShadingPoint point : candidates[k]) {
      point.view = static_cast<int>(k - begin);
      points.push_back(point);
    }
  }
  const Observations any =
      MakeObservations(std::vector<double>(3 * points.size(), 1.0));
  std::vector<ShadingPoint> kept = BinByNormal(points, any, options).points;
  for (size_t i = 0; i < kept.size(); ++i) {
    kept[i].index = static_cast<int>(i);
  }
  return kept;
}

// The rows of bins [first, last) of so many.
LogRadianceSlopes RowsOf(const LogRadianceSlopes& all, Eigen::Index first,
                         Eigen::Index last) {
  const Eigen::Index P = all.by_light[0].rows(), count = last - first;
  LogRadianceSlopes out;
  out.by_parameters.resize(3 * count, all.by_parameters.cols());
  out.noise.resize(3 * count);
  for (int c = 0; c < 3; ++c) {
    out.by_light[c] = all.by_light[c].middleRows(first, count);
    out.by_parameters.middleRows(c * count, count) =
        all.by_parameters.middleRows(c * P + first, count);
    out.noise.segment(c * count, count) =
        all.noise.segment(c * P + first, count);
  }
  return out;
}

// Slopes of candidates from `begin` on, some at once; one that sees nothing has
// no rows.
void FindSlopes(const NextViewCandidates& candidates, size_t begin,
                const Estimated& estimated,
                std::vector<LogRadianceSlopes>* slopes) {
  const size_t end =
      std::min(begin + kCandidatesAtOnce, candidates.points.size());
  MarginalResolution resolution = estimated.resolution;
  resolution.bins.most_bins = 0;  // the limit is of one photograph more
  const std::vector<ShadingPoint> kept =
      BinnedPoints(candidates.points, begin, end, resolution.bins);
  if (kept.empty()) return;
  if (resolution.visibility != nullptr) {
    VisibilityOptions rays;
    rays.num_threads = 1;
    resolution.visibility =
        std::make_shared<Visibility>(candidates.scene, kept, rays);
  }
  const Observations any =
      MakeObservations(std::vector<double>(3 * kept.size(), 1.0));
  const MarginalReflectance reflectance =
      ReflectanceOn(kept, any, resolution, estimated, 1);
  LogRadianceSlopes all = reflectance.Slopes(estimated.parameters.data(),
                                             estimated.sigma, estimated.mode);
  all.by_parameters = RowMatrix(all.by_parameters * estimated.whitening);
  // Bins of a view come one after the other.
  const NormalBins& bins = reflectance.bins();
  for (int first = 0, last = 0; first < bins.num_bins(); first = last) {
    const int view = bins.points[bins.first[first]].view;
    while (last < bins.num_bins() &&
           bins.points[bins.first[last]].view == view) {
      ++last;
    }
    (*slopes)[begin + view] = RowsOf(all, first, last);
  }
}

// Greedy; fills first_gains, chosen and gains.
void Choose(const std::vector<LogRadianceSlopes>& slopes, int count,
            int num_threads, ViewInformation* information,
            InformativeViews* out) {
  const auto num = static_cast<int64_t>(slopes.size());
  std::vector<bool> taken(slopes.size(), false);
  for (int k = 0; k < count; ++k) {
    std::vector<double> gains(slopes.size(), 0.0);
    ParallelFor(num, num_threads, [&](int64_t i, int) {
      if (taken[i] || slopes[i].noise.size() == 0) return;
      const double gain = information->Gain(slopes[i]);
      if (std::isfinite(gain)) gains[i] = std::max(gain, 0.0);
    });
    if (k == 0) out->first_gains = gains;
    const auto best = std::max_element(gains.begin(), gains.end());
    if (!(*best > 0.0)) return;
    const int view = static_cast<int>(best - gains.begin());
    out->chosen.push_back(view);
    out->gains.push_back(*best);
    taken[view] = true;
    information->Add(slopes[view]);
  }
}

// Why the solution says nothing to choose by; empty: it does.
std::string WhyNotFrom(const Solution& solution) {
  if (solution.has_paint()) return "the object is painted";
  if (solution.lobe_parameters.empty() || solution.lobe_covariance.empty()) {
    return "the estimate has no posterior";
  }
  return "";
}

}  // namespace

StatusOr<InformativeViews> ChooseInformativeViews(
    const InverseProblem& problem, const Solution& solution,
    const NextViewCandidates& candidates, int count) {
  const std::string why = WhyNotFrom(solution);
  if (!why.empty()) {
    return Status(StatusCode::kNoImprovement, "no next views: " + why);
  }
  const Stopwatch watch;
  const StatusOr<SolveSetup> setup = SetUp(problem);
  if (!setup.ok()) return setup.status();
  Estimated estimated;
  estimated.problem = &problem;
  estimated.lobes = FlowLobes::Factory(*problem.model, setup->lobes->layout(),
                                       problem.num_threads);
  estimated.resolution = ReflectanceSearchOptions().fine;
  // All are binned as they would be together with one more.
  AdaptResolution(problem, candidates.setting.photographs.size() + 1,
                  &estimated.resolution);
  estimated.directional_lights = solution.directional_lights;
  estimated.whitening = WhiteningOf(setup->materials, estimated.num_nuisance());
  LinearPosterior posterior =
      PosteriorOfPhotographs(*setup, solution, &estimated);
  if (posterior.information.size() == 0) {
    return Status(StatusCode::kNoImprovement,
                  "no next views: the light that the estimate asks for was "
                  "not found again");
  }
  ViewInformation information(std::move(posterior), estimated.num_nuisance());
  InformativeViews out;
  out.from = candidates.from;
  out.candidates = candidates.views;
  out.information = information.information();
  std::vector<LogRadianceSlopes> slopes(candidates.views.size());
  const size_t groups =
      (slopes.size() + kCandidatesAtOnce - 1) / kCandidatesAtOnce;
  ParallelFor(static_cast<int64_t>(groups), problem.num_threads,
              [&](int64_t group, int) {
                FindSlopes(candidates, group * kCandidatesAtOnce, estimated,
                           &slopes);
              });
  count = std::min(count, static_cast<int>(slopes.size()));
  Choose(slopes, count, problem.num_threads, &information, &out);
  out.farthest = FarthestCandidates(
      candidates.views, candidates.setting.photographs,
      candidates.setting.centre, static_cast<int>(out.chosen.size()));
  out.seconds = watch.Seconds();
  return out;
}

}  // namespace ibrdf
