#include "ibrdf/solvers/marginal/model_search.h"

#include <glog/logging.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/solvers/marginal/light_degrees.h"

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

}  // namespace

ModelSearch::ModelSearch(const SearchedModel& model,
                         const std::vector<ShadingPoint>& points,
                         const Observations& image,
                         const std::vector<Eigen::Vector3d>& directional_lights,
                         const ReflectanceSearchOptions& options)
    : model_(model),
      points_(points),
      image_(image),
      unbounced_(image),
      directional_lights_(directional_lights),
      options_(options) {
  for (const MaterialPrior::Material& m : model.prior->materials) {
    materials_.push_back(
        {m.name, kInfinity, 0.0, kInfinity, ToVector(m.parameters)});
  }
}

std::unique_ptr<SearchLevel> ModelSearch::LevelAt(
    const MarginalResolution& resolution) const {
  return std::make_unique<SearchLevel>(model_.lobes, *model_.prior, points_,
                                       unbounced_, resolution,
                                       directional_lights_, options_);
}

void ModelSearch::Rank() {
  for (const LightHyperparameters& hyperparameters :
       {LightHyperparameters(), LightHyperparameters::Harsh()}) {
    Ranking& ranking = rankings_.emplace_back();
    for (size_t i = 0; i < materials_.size(); ++i) {
      ranking.push_back({static_cast<int>(i), hyperparameters});
    }
  }
  RankAll(*LevelAt(options_.screen));
  for (MaterialCandidate& material : materials_) {
    material.screen_cost = material.first_cost;
  }
  for (Ranking& ranking : rankings_) {
    ranking.resize(std::min<size_t>(ranking.size(), options_.kept));
  }
  level_ = LevelAt(options_.coarse);
  RankAll(*level_);
}

// Whole materials in parallel: what each does inside then runs in its thread.
void ModelSearch::RankAll(const SearchLevel& level) {
  // Costs of two resolutions do not compare.
  for (MaterialCandidate& material : materials_)
    material.first_cost = kInfinity;
  for (Ranking& ranking : rankings_) {
    ParallelFor(static_cast<int64_t>(ranking.size()), options_.num_threads,
                [&](int64_t i, int) {
                  MaterialUnderLight& ranked = ranking[i];
                  ranked.cost = kInfinity;
                  if (i > 0 && options_.Stopped()) return;
                  ranked.cost = level.Rank(
                      ToEigen(materials_[ranked.material].parameters),
                      ranked.hyperparameters, &ranked.misfit);
                });
    for (const MaterialUnderLight& ranked : ranking) {
      MaterialCandidate& material = materials_[ranked.material];
      if (ranked.cost < material.first_cost) {
        material.first_cost = ranked.cost;
        material.first_misfit = ranked.misfit;
      }
    }
    std::stable_sort(
        ranking.begin(), ranking.end(),
        [](const MaterialUnderLight& a, const MaterialUnderLight& b) {
          return a.cost < b.cost;
        });
  }
}

bool ModelSearch::Take(const MaterialUnderLight& ranked) {
  for (const Candidate& c : candidates_) {
    if (c.material == ranked.material) return false;
  }
  candidates_.push_back({ranked.material,
                         level_->reflectance().WithDirectionalLights(
                             ToEigen(materials_[ranked.material].parameters)),
                         ranked.hyperparameters, 0.0});
  return true;
}

void ModelSearch::KeepCandidates(size_t most) {
  candidates_.resize(std::min(candidates_.size(), most));
}

void ModelSearch::Sharpen() {
  last_level_ = std::move(level_);
  level_ = LevelAt(options_.fine);
}

bool ModelSearch::Join(std::vector<LocalOptimum> optima,
                       const std::string& what, bool report) {
  CHECK_EQ(optima.size(), candidates_.size());
  std::vector<Candidate> reached;
  for (size_t k = 0; k < optima.size(); ++k) {
    LocalOptimum& optimum = optima[k];
    if (!optimum.ok) continue;
    // Costs of two resolutions do not compare.
    if (best_level_ != level_.get()) {
      for (MaterialCandidate& material : materials_) material.cost = kInfinity;
    }
    MaterialCandidate& material = materials_[candidates_[k].material];
    const MarginalObjective objective =
        level_->Objective(optimum.errors, &optimum.mode);
    reached.push_back(
        {candidates_[k].material, objective.ParametersOf(optimum.y.data()),
         objective.HyperparametersOf(optimum.y.data()), optimum.cost});
    material.cost = optimum.cost;
    material.parameters = ToVector(objective.LobesOf(optimum.y.data()));
    material.light_level =
        level_->LightLevel(reached.back().parameters, optimum.mode);
    if (report && options_.report) {
      options_.report(what + material.name, optimum.cost, optimum.value.misfit);
    }
    // With the noise taken anew an optimum may cost more than before.
    if (reached.size() == 1 || optimum.cost < best_.cost) {
      best_level_ = level_.get();
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

void ModelSearch::TakeBouncesOut() {
  if (!model_.bounce_gain || !has_optimum()) return;
  for (int round = 0; round < options_.bounce_iterations && !options_.Stopped();
       ++round) {
    const std::vector<double> gain =
        model_.bounce_gain(Lobes(best_candidate_), LogRadiance());
    if (gain.empty()) return;
    unbounced_ = Quotient(image_, gain);
    candidates_ = {best_candidate_};
    // The last level stays until the next has an optimum: the best is of it.
    std::unique_ptr<SearchLevel> next =
        LevelAt(best_level_->reflectance().resolution());
    std::swap(level_, next);
    std::vector<LocalOptimum> optima(1);
    optima[0] = Refine(candidates_[0], options_.fine_iterations);
    if (!Join(std::move(optima), "bounces ", true)) {
      std::swap(level_, next);
      return;
    }
    last_level_ = nullptr;
  }
}

std::vector<double> ModelSearch::LogRadiance() const {
  return best_level_->reflectance().LogRadiance(
      best_candidate_.parameters.data(), best_.mode);
}

std::vector<double> ModelSearch::Lobes(const Candidate& candidate) const {
  const double* all = candidate.parameters.data();
  return {all, all + best_level_->reflectance().num_lobe_parameters()};
}

ReflectanceSearchResult ModelSearch::Result(bool covariance) {
  ReflectanceSearchResult result;
  result.parameters = Lobes(best_candidate_);
  result.initial_guess = materials_[best_candidate_.material].name;
  result.cost = best_.cost;
  result.misfit = best_.value.misfit;
  result.hyperparameters = best_candidate_.hyperparameters;
  if (covariance) result.covariance = best_level_->Covariance(&best_);
  const MarginalReflectance& reflectance = best_level_->reflectance();
  result.map_width = reflectance.resolution().map_width;
  result.map_height = reflectance.resolution().map_height;
  result.directional_lights =
      reflectance.DirectionalLightDirections(best_candidate_.parameters.data());
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
  result.variance_left_by_degree = VarianceLeftByDegree(
      likelihood, reflectance.Matrices(best_candidate_.parameters.data()),
      best_.errors, best_candidate_.hyperparameters, best_.mode,
      result.map_height, result.map_width);
  std::stable_sort(materials_.begin(), materials_.end(),
                   [](const MaterialCandidate& a, const MaterialCandidate& b) {
                     return std::tie(a.cost, a.first_cost) <
                            std::tie(b.cost, b.first_cost);
                   });
  result.candidates = std::move(materials_);
  return result;
}

}  // namespace ibrdf
