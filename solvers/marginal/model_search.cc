#include "ibrdf/solvers/marginal/model_search.h"

#include <glog/logging.h>

#include <algorithm>
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

// What is ranked, by material, as its matrices serve all light without other
// offsets. The first ranking's best comes first: it is ranked even where time
// is up.
std::vector<std::vector<MaterialUnderLight*>> ByMaterial(
    size_t num_materials, std::vector<Ranking>* rankings) {
  std::vector<std::vector<MaterialUnderLight*>> groups;
  std::vector<int> group_of(num_materials, -1);
  for (Ranking& ranking : *rankings) {
    for (MaterialUnderLight& ranked : ranking) {
      int& group = group_of[ranked.material];
      if (group < 0) {
        group = static_cast<int>(groups.size());
        groups.emplace_back();
      }
      groups[group].push_back(&ranked);
    }
  }
  return groups;
}

// For std::stable_sort.
template <typename Costed>
bool CostsLess(const Costed& a, const Costed& b) {
  return a.cost < b.cost;
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

void ModelSearch::Rank(const std::vector<LightGuess>& lights) {
  rankings_.clear();
  for (const LightGuess& light : lights) {
    Ranking& ranking = rankings_.emplace_back();
    for (size_t i = 0; i < materials_.size(); ++i) {
      ranking.push_back({static_cast<int>(i), light});
    }
  }
  if (screen_ == nullptr) screen_ = LevelAt(options_.screen);
  if (level_ == nullptr) level_ = LevelAt(options_.coarse);
  RankAll(*screen_);
  for (Ranking& ranking : rankings_) {
    for (const MaterialUnderLight& ranked : ranking) {
      double& least = materials_[ranked.material].screen_cost;
      least = std::min(least, ranked.cost);
    }
    ranking.resize(std::min<size_t>(ranking.size(), options_.kept));
  }
  RankAll(*level_);
  for (const Ranking& ranking : rankings_) {
    for (const MaterialUnderLight& ranked : ranking) {
      MaterialCandidate& material = materials_[ranked.material];
      if (!(ranked.cost < material.first_cost)) continue;
      material.first_cost = ranked.cost;
      material.first_misfit = ranked.misfit;
    }
  }
}

Eigen::VectorXd ModelSearch::ParametersOf(const MaterialUnderLight& ranked,
                                          const SearchLevel& level) const {
  Eigen::VectorXd parameters = level.reflectance().WithDirectionalLights(
      model_.prior->materials[ranked.material].parameters);
  const Eigen::VectorXd& offsets = ranked.light.offsets;
  if (offsets.size() > 0) parameters.tail(offsets.size()) = offsets;
  return parameters;
}

void ModelSearch::RankAll(const SearchLevel& level) {
  const std::vector<std::vector<MaterialUnderLight*>> groups =
      ByMaterial(materials_.size(), &rankings_);
  // Whole materials in parallel: what each does inside then runs in its thread.
  ParallelFor(
      static_cast<int64_t>(groups.size()), options_.num_threads,
      [&](int64_t i, int) {
        TabulatedReflectance material;
        for (MaterialUnderLight* ranked : groups[i]) {
          ranked->cost = kInfinity;
          if (i > 0 && options_.Stopped()) continue;
          const Eigen::VectorXd parameters = ParametersOf(*ranked, level);
          if (material.parameters.size() == 0 ||
              material.parameters != parameters) {
            material = level.Tabulate(parameters);
          }
          ranked->cost = level.Rank(material, ranked->light.hyperparameters,
                                    ranked->light.tolerance * options_.sigma,
                                    &ranked->misfit);
        }
      });
  for (Ranking& ranking : rankings_) {
    std::stable_sort(ranking.begin(), ranking.end(),
                     CostsLess<MaterialUnderLight>);
  }
}

bool ModelSearch::Take(const MaterialUnderLight& ranked) {
  for (const Candidate& c : candidates_) {
    if (c.material == ranked.material) return false;
  }
  candidates_.push_back({ranked.material, ParametersOf(ranked, *level_),
                         ranked.light.hyperparameters, ranked.cost});
  return true;
}

LightGuess ModelSearch::LightAt(const Candidate& candidate) const {
  return {
      candidate.hyperparameters,
      candidate.parameters.tail(Eigen::Index{2} * directional_lights_.size())};
}

void ModelSearch::KeepCandidates(size_t most) {
  candidates_.resize(std::min(candidates_.size(), most));
}

void ModelSearch::Sharpen() {
  last_level_ = std::move(level_);
  level_ = LevelAt(options_.fine);
  coarse_ = false;
}

bool ModelSearch::Join(std::vector<LocalOptimum> optima,
                       const std::string& what) {
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
    if (coarse_) KeepCoarse(reached.back());
    if (!what.empty() && options_.report) {
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
  std::stable_sort(reached.begin(), reached.end(), CostsLess<Candidate>);
  candidates_ = std::move(reached);
  return true;
}

void ModelSearch::KeepCoarse(const Candidate& candidate) {
  const std::string& name = materials_[candidate.material].name;
  auto at = std::find_if(
      coarse_optima_.begin(), coarse_optima_.end(),
      [&](const CoarseOptimum& optimum) { return optimum.name == name; });
  if (at == coarse_optima_.end()) {
    at = coarse_optima_.insert(at, CoarseOptimum());
  }
  at->name = name;
  at->cost = candidate.cost;
  at->parameters = materials_[candidate.material].parameters;
}

void ModelSearch::TakeBouncesOut() {
  if (!model_.bounce_gain) return;
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
    optima[0] = Refine(candidates_[0], 1.0, options_.fine_iterations);
    if (!Join(std::move(optima), "bounces ")) {
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
  std::stable_sort(coarse_optima_.begin(), coarse_optima_.end(),
                   CostsLess<CoarseOptimum>);
  result.coarse_optima = std::move(coarse_optima_);
  SortByCost(&materials_);
  result.candidates = std::move(materials_);
  return result;
}

}  // namespace ibrdf
