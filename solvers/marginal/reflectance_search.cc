#include "ibrdf/solvers/marginal/reflectance_search.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/marginal/marginal_descent.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

// A ranking finds modes to so many nats; materials differ by tens.
constexpr double kRankingTolerance = 0.5;
// Every candidate takes so many steps at the fine resolution.
constexpr int kTrialIterations = 3;
// Two directional lights within this angle, degrees, are one.
constexpr double kReach = 20.0;

// Radiance divided by factors > 0 [points * 3].
Observations Quotient(const Observations& observed,
                      const std::vector<double>& factors) {
  const auto divide = [&](std::vector<double> values) {
    for (size_t i = 0; i < values.size(); ++i) values[i] /= factors[i];
    return values;
  };
  return MakeObservations(divide(observed.radiance), divide(observed.low),
                          divide(observed.high));
}

// [points]; empty: none.
std::vector<char> ClippedPoints(const Observations& observed) {
  std::vector<char> clipped;
  for (size_t k = 0; !observed.exact() && k < observed.high.size(); k += 3) {
    clipped.push_back(
        std::any_of(observed.high.begin() + k, observed.high.begin() + k + 3,
                    [](double high) { return std::isinf(high); }));
  }
  return clipped;
}

bool IsNearOneOf(const std::vector<Eigen::Vector3d>& lights,
                 const Eigen::Vector3d& direction) {
  const double reach = std::cos(kReach * kDegree);
  return std::any_of(lights.begin(), lights.end(), [&](const auto& light) {
    return light.dot(direction) >= reach;
  });
}

// The image without what is known of its paint: a bright patch is no highlight.
std::vector<double> RadianceWithoutPaint(
    const Observations& observed, const ReflectanceSearchOptions& options) {
  std::vector<double> out = observed.radiance;
  if (!options.paint || options.paint->mean.empty()) return out;
  CHECK_EQ(options.paint->mean.size(), out.size());
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] *= std::exp(-options.paint->mean[i]);
  }
  return out;
}

// The lights that a material's highlights show: where two materials meet, the
// brighter one has none. all: radiance [points * 3].
std::vector<Eigen::Vector3d> LightsOfMaterial(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<double>& all, int material,
    const ReflectanceSearchOptions& options) {
  const std::vector<char> clipped = ClippedPoints(observed);
  if (options.num_materials == 1) {
    return FindDirectionalLights(points, all, options.most_directional_lights,
                                 clipped);
  }
  std::vector<ShadingPoint> of_material;
  std::vector<double> radiance;
  std::vector<char> of_clipped;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].material != material) continue;
    of_material.push_back(points[i]);
    radiance.insert(radiance.end(), &all[3 * i], &all[3 * i] + 3);
    if (!clipped.empty()) of_clipped.push_back(clipped[i]);
  }
  return FindDirectionalLights(of_material, radiance,
                               options.most_directional_lights, of_clipped);
}

// The lights that the caller knows, and others that highlights show: the
// brightest of each material first.
std::vector<Eigen::Vector3d> DirectionalLights(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options) {
  const std::vector<double> radiance = RadianceWithoutPaint(observed, options);
  std::vector<std::vector<Eigen::Vector3d>> found;
  for (int m = 0; m < options.num_materials; ++m) {
    found.push_back(LightsOfMaterial(points, observed, radiance, m, options));
  }
  std::vector<Eigen::Vector3d> lights = options.directional_lights;
  // Those of one material are apart.
  const std::vector<Eigen::Vector3d>& others =
      options.num_materials == 1 ? options.directional_lights : lights;
  for (size_t rank = 0;
       rank < static_cast<size_t>(options.most_directional_lights); ++rank) {
    for (const std::vector<Eigen::Vector3d>& of_material : found) {
      if (rank >= of_material.size()) continue;
      if (!IsNearOneOf(others, of_material[rank])) {
        lights.push_back(of_material[rank]);
      }
    }
  }
  if (static_cast<int>(lights.size()) > options.most_directional_lights) {
    lights.resize(options.most_directional_lights);
  }
  return lights;
}

// Where a refinement at one resolution ended.
struct LocalOptimum {
  bool ok = false;
  std::vector<double> y;
  double cost = std::numeric_limits<double>::infinity();
  MarginalValue value;
  LightMode mode;
  DataErrors errors;
};

// A search at one resolution.
class SearchLevel {
 public:
  SearchLevel(const LobeFactory& lobes, const MaterialPrior& prior,
              const std::vector<ShadingPoint>& points,
              const Observations& observed,
              const MarginalResolution& resolution,
              const std::vector<Eigen::Vector3d>& directional_lights,
              const ReflectanceSearchOptions& options)
      : prior_(prior),
        options_(options),
        reflectance_(lobes, points, observed, options.process, resolution,
                     options.num_threads, directional_lights, options.paint,
                     options.num_materials) {}

  const MarginalReflectance& reflectance() const { return reflectance_; }

  MarginalObjective Objective(const DataErrors& errors, LightMode* mode) const {
    return MarginalObjective(&reflectance_, &prior_, errors, mode);
  }

  // -log posterior at these hyperparameters of light; infinite where it has
  // none.
  double Rank(const Eigen::VectorXd& lobes,
              const LightHyperparameters& hyperparameters,
              double* misfit) const {
    LightMode mode;
    const Eigen::VectorXd parameters =
        reflectance_.WithDirectionalLights(lobes);
    const std::array<RowMatrix, 3> matrices =
        reflectance_.Matrices(parameters.data());
    const MarginalLikelihood& likelihood = reflectance_.likelihood();
    const DataErrors errors = likelihood.FindErrors(
        matrices, reflectance_.MatteMatrices(parameters.data()), options_.sigma,
        hyperparameters, kRankingTolerance, &mode);
    const MarginalValue value = likelihood.Evaluate(
        matrices, errors, hyperparameters, kRankingTolerance, &mode, nullptr);
    if (!value.ok) return std::numeric_limits<double>::infinity();
    if (HidesPaint(errors)) return std::numeric_limits<double>::infinity();
    *misfit = value.misfit;
    double of_hyperparameters = 0.0;
    for (const double y : hyperparameters.Whitened())
      of_hyperparameters += 0.5 * y * y;
    return value.cost + prior_.Cost(lobes, nullptr) + of_hyperparameters;
  }

  LocalOptimum Refine(const Eigen::VectorXd& parameters,
                      const LightHyperparameters& hyperparameters,
                      int iterations) const {
    LocalOptimum optimum;
    optimum.errors = reflectance_.likelihood().FindErrors(
        reflectance_.Matrices(parameters.data()),
        reflectance_.MatteMatrices(parameters.data()), options_.sigma,
        hyperparameters, MarginalObjective::kModeTolerance, &optimum.mode);
    const MarginalObjective objective =
        Objective(optimum.errors, &optimum.mode);
    optimum.y = objective.Whitened(parameters, hyperparameters);
    MarginalDescentOptions o;
    o.max_iterations = iterations;
    o.should_stop = options_.should_stop;
    const MarginalDescent descent = Descend(objective, o, &optimum.y);
    optimum.ok = descent.ok && !HidesPaint(optimum.errors);
    optimum.cost = descent.cost;
    optimum.value = objective.last_value();
    return optimum;
  }

  // Mean log radiance of a mode's light, by channel.
  Eigen::Array3d LightLevel(const Eigen::VectorXd& parameters,
                            const LightMode& mode) const {
    const std::vector<double> log_radiance =
        reflectance_.LogRadiance(parameters.data(), mode);
    const MarginalResolution& r = reflectance_.resolution();
    return LogMap({r.map_width, r.map_height},
                  {log_radiance.begin(), log_radiance.end()})
        .Mean();
  }

  // Laplace's covariance of the lobe parameters, by the Gauss-Newton Hessian;
  // empty where there is none.
  Eigen::MatrixXd Covariance(LocalOptimum* optimum) const {
    const Eigen::MatrixXd information =
        Objective(optimum->errors, &optimum->mode)
            .Information(optimum->y.data());
    if (information.size() == 0) return {};
    VLOG(1) << "marginal posterior: condition of the information, scaled, "
            << ScaledCondition(information);
    const Eigen::Index n = information.rows();
    const Eigen::MatrixXd inverse =
        information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    const Eigen::MatrixXd factor = prior_.factor.triangularView<Eigen::Lower>();
    return factor * inverse.topLeftCorner(factor.rows(), factor.rows()) *
           factor.transpose();
  }

 private:
  // Whether the object is painted and a reflectance would hardly show it.
  bool HidesPaint(const DataErrors& errors) const {
    return options_.paint &&
           errors.matte_share.mean() < options_.paint->least_matte_share;
  }

  const MaterialPrior& prior_;
  const ReflectanceSearchOptions& options_;
  MarginalReflectance reflectance_;
};

// The search from stage to stage: the materials, the candidates that are left
// of them, and the best local optimum so far.
class Search {
 public:
  Search(const LobeFactory& lobes, const MaterialPrior& prior,
         const std::vector<ShadingPoint>& points, const Observations& observed,
         const ReflectanceSearchOptions& options)
      : options_(options),
        image_(observed),
        unbounced_(observed),
        directional_lights_(DirectionalLights(points, observed, options)),
        level_at_([&](const MarginalResolution& resolution) {
          return std::make_unique<SearchLevel>(lobes, prior, points, unbounced_,
                                               resolution, directional_lights_,
                                               options);
        }) {
    for (const MaterialPrior::Material& m : prior.materials) {
      materials_.push_back(
          {m.name, kInfinity, 0.0, kInfinity, ToVector(m.parameters)});
    }
  }

  // Ranks the materials and refines the best; false where none explains the
  // image.
  bool RankAndRefine() {
    std::vector<Ranking> rankings;
    for (const LightHyperparameters& hyperparameters :
         {LightHyperparameters(), LightHyperparameters::Harsh()}) {
      Ranking& ranking = rankings.emplace_back();
      for (size_t i = 0; i < materials_.size(); ++i) {
        ranking.push_back({static_cast<int>(i), hyperparameters});
      }
    }
    RankAll(*level_at_(options_.screen), &rankings);
    for (MaterialCandidate& material : materials_) {
      material.screen_cost = material.first_cost;
    }
    for (Ranking& ranking : rankings) {
      ranking.resize(std::min<size_t>(ranking.size(), options_.kept));
    }
    coarse_ = level_at_(options_.coarse);
    RankAll(*coarse_, &rankings);
    std::sort(rankings.begin(), rankings.end(),
              [](const Ranking& a, const Ranking& b) {
                return a.front().cost < b.front().cost;
              });
    if (!std::isfinite(rankings.front().front().cost)) return false;
    Report("rank " + std::to_string(materials_.size()) + " materials",
           rankings.front().front().cost, rankings.front().front().misfit);
    for (int k = 0; k < options_.coarse_stages.front().most; ++k) {
      for (const RankedMaterial& ranked : rankings[k % rankings.size()]) {
        if (!std::isfinite(ranked.cost)) break;
        const bool taken = std::any_of(
            candidates_.begin(), candidates_.end(),
            [&](const Candidate& c) { return c.material == ranked.material; });
        if (taken) continue;
        candidates_.push_back(
            {ranked.material,
             coarse_->reflectance().WithDirectionalLights(
                 ToEigen(materials_[ranked.material].parameters)),
             ranked.hyperparameters, 0.0});
        break;
      }
    }
    for (const SearchStage& stage : options_.coarse_stages) {
      candidates_.resize(std::min<size_t>(candidates_.size(), stage.most));
      if (candidates_.empty() || !Refine("", *coarse_, stage.iterations)) {
        return false;
      }
      Report("refine " + std::to_string(candidates_.size()), best_.cost,
             best_.value.misfit);
    }
    return true;
  }

  // Compares the candidates at the fine resolution and finishes the best.
  void FinishBest() {
    if (options_.fine_iterations == 0 || Stopped()) return;
    fine_ = level_at_(options_.fine);
    DropBeyond(options_.coarse_margin);
    if (!Refine("", *fine_, kTrialIterations)) return;
    DropBeyond(options_.margin);
    Refine("finish ", *fine_, options_.fine_iterations);
  }

  // Takes what the object throws on itself out of the image.
  void TakeBouncesOut() {
    if (!options_.bounce_gain || options_.fine_iterations == 0) return;
    for (int round = 0; round < options_.bounce_iterations && !Stopped();
         ++round) {
      const std::vector<double> gain =
          options_.bounce_gain(Lobes(best_candidate_), LogRadiance());
      if (gain.empty()) return;
      unbounced_ = Quotient(image_, gain);
      // The last level stays until the next has an optimum: the best is of it.
      std::unique_ptr<SearchLevel> next =
          level_at_(best_level_->reflectance().resolution());
      candidates_ = {best_candidate_};
      if (!Refine("bounces ", *next, options_.fine_iterations)) return;
      fine_ = std::move(next);
    }
  }

  ReflectanceSearchResult Result() {
    ReflectanceSearchResult result;
    result.parameters = Lobes(best_candidate_);
    result.initial_guess = materials_[best_candidate_.material].name;
    result.cost = best_.cost;
    result.misfit = best_.value.misfit;
    result.hyperparameters = best_candidate_.hyperparameters;
    if (options_.covariance) {
      result.covariance = best_level_->Covariance(&best_);
    }
    const MarginalReflectance& reflectance = best_level_->reflectance();
    result.map_width = reflectance.resolution().map_width;
    result.map_height = reflectance.resolution().map_height;
    result.directional_lights = reflectance.DirectionalLightDirections(
        best_candidate_.parameters.data());
    result.log_radiance = LogRadiance();
    const MarginalLikelihood& likelihood = reflectance.likelihood();
    const Eigen::VectorXd variance = likelihood.LightVariance(
        reflectance.Matrices(best_candidate_.parameters.data()), best_.errors,
        best_candidate_.hyperparameters, best_.mode);
    result.log_radiance_std = ToVector(variance.cwiseSqrt());
    result.log_radiance_variance_left =
        ToVector(variance
                     .cwiseQuotient(likelihood.PriorLightVariance(
                         best_candidate_.hyperparameters))
                     .cwiseMin(1.0));
    std::stable_sort(
        materials_.begin(), materials_.end(),
        [](const MaterialCandidate& a, const MaterialCandidate& b) {
          return std::tie(a.cost, a.first_cost) <
                 std::tie(b.cost, b.first_cost);
        });
    result.candidates = std::move(materials_);
    return result;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  // Where a refinement of materials_[material] led, and the next begins.
  struct Candidate {
    int material = 0;
    Eigen::VectorXd parameters;
    LightHyperparameters hyperparameters;
    double cost = 0.0;
  };

  // Drops the candidates whose costs are not within the margin of the lowest.
  void DropBeyond(double margin) {
    candidates_.erase(std::find_if(candidates_.begin(), candidates_.end(),
                                   [&](const Candidate& c) {
                                     return c.cost >
                                            candidates_.front().cost + margin;
                                   }),
                      candidates_.end());
  }

  std::vector<double> LogRadiance() const {
    return best_level_->reflectance().LogRadiance(
        best_candidate_.parameters.data(), best_.mode);
  }
  // Without the directional lights.
  std::vector<double> Lobes(const Candidate& candidate) const {
    const double* all = candidate.parameters.data();
    return {all, all + best_level_->reflectance().num_lobe_parameters()};
  }
  bool Stopped() const {
    return options_.should_stop && options_.should_stop();
  }
  void Report(const std::string& stage, double cost, double misfit) const {
    if (options_.report) options_.report(stage, cost, misfit);
  }

  // Materials under light of one kind.
  struct RankedMaterial {
    int material = 0;
    LightHyperparameters hyperparameters;
    double cost = kInfinity, misfit = 0.0;
  };
  using Ranking = std::vector<RankedMaterial>;

  // Whole materials in parallel: what each does inside then runs in its thread.
  void RankAll(const SearchLevel& level, std::vector<Ranking>* rankings) {
    // Costs of two resolutions do not compare.
    for (MaterialCandidate& material : materials_)
      material.first_cost = kInfinity;
    for (Ranking& ranking : *rankings) {
      ParallelFor(static_cast<int64_t>(ranking.size()), options_.num_threads,
                  [&](int64_t i, int) {
                    RankedMaterial& ranked = ranking[i];
                    ranked.cost = kInfinity;
                    if (i > 0 && Stopped()) return;
                    ranked.cost = level.Rank(
                        ToEigen(materials_[ranked.material].parameters),
                        ranked.hyperparameters, &ranked.misfit);
                  });
      for (const RankedMaterial& ranked : ranking) {
        MaterialCandidate& material = materials_[ranked.material];
        if (ranked.cost < material.first_cost) {
          material.first_cost = ranked.cost;
          material.first_misfit = ranked.misfit;
        }
      }
      std::stable_sort(ranking.begin(), ranking.end(),
                       [](const RankedMaterial& a, const RankedMaterial& b) {
                         return a.cost < b.cost;
                       });
    }
  }

  // Whole refinements of candidates_ in parallel, joined in order. The
  // candidates that come to something take their places, the best first; false
  // where none does, which leaves all as it was.
  bool Refine(const std::string& what, const SearchLevel& level,
              int iterations) {
    std::vector<LocalOptimum> optima(candidates_.size());
    ParallelFor(static_cast<int64_t>(candidates_.size()), options_.num_threads,
                [&](int64_t k, int) {
                  if (k > 0 && Stopped()) return;
                  optima[k] =
                      level.Refine(candidates_[k].parameters,
                                   candidates_[k].hyperparameters, iterations);
                });
    std::vector<Candidate> reached;
    for (size_t k = 0; k < optima.size(); ++k) {
      LocalOptimum& optimum = optima[k];
      if (!optimum.ok) continue;
      // Costs of two resolutions do not compare.
      if (best_level_ != &level) {
        for (MaterialCandidate& material : materials_)
          material.cost = kInfinity;
      }
      MaterialCandidate& material = materials_[candidates_[k].material];
      const MarginalObjective objective =
          level.Objective(optimum.errors, &optimum.mode);
      reached.push_back(
          {candidates_[k].material, objective.ParametersOf(optimum.y.data()),
           objective.HyperparametersOf(optimum.y.data()), optimum.cost});
      material.cost = optimum.cost;
      material.parameters = ToVector(objective.LobesOf(optimum.y.data()));
      material.light_level =
          level.LightLevel(reached.back().parameters, optimum.mode);
      if (!what.empty())
        Report(what + material.name, optimum.cost, optimum.value.misfit);
      // With the noise taken anew an optimum may cost more than before.
      if (reached.size() == 1 || optimum.cost < best_.cost) {
        best_level_ = &level;
        best_ = std::move(optimum);
        best_candidate_ = reached.back();
      }
    }
    if (reached.empty()) return false;
    std::stable_sort(
        reached.begin(), reached.end(),
        [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    candidates_ = std::move(reached);
    return true;
  }

  const ReflectanceSearchOptions& options_;
  const Observations& image_;
  Observations unbounced_;  // the image without bounces
  const std::vector<Eigen::Vector3d> directional_lights_;
  const std::function<std::unique_ptr<SearchLevel>(const MarginalResolution&)>
      level_at_;
  std::unique_ptr<SearchLevel> coarse_, fine_;
  std::vector<MaterialCandidate> materials_;
  std::vector<Candidate> candidates_;
  const SearchLevel* best_level_ = nullptr;
  LocalOptimum best_;
  Candidate best_candidate_;
};

}  // namespace

StatusOr<ReflectanceSearchResult> SearchReflectance(
    const LobeFactory& lobes, const MaterialPrior& prior,
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options) {
  CHECK(!prior.materials.empty());
  CHECK(options.kept > 0 && options.sigma > 0.0);
  CHECK(options.coarse_margin >= 0.0 && options.margin >= 0.0);
  CHECK(options.fine_iterations >= 0 && options.most_directional_lights >= 0);
  if (BinByNormal(points, observed, options.coarse.bins).num_bins() == 0) {
    return InvalidInput("image",
                        "no pixel of the object, limb aside, is finite and "
                        "positive in all three channels");
  }
  Search search(lobes, prior, points, observed, options);
  if (!search.RankAndRefine()) {
    return Status(StatusCode::kNoImprovement,
                  "no training material explains the image at all");
  }
  search.FinishBest();
  search.TakeBouncesOut();
  return search.Result();
}

}  // namespace ibrdf
