// The materials of one model on their way through a search.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/marginal/search_level.h"

namespace ibrdf {

// What a ranking takes the light for.
struct LightGuess {
  LightHyperparameters hyperparameters;
  Eigen::VectorXd offsets;  // of the directional lights; empty: where they are
  // Deviation of bins over ReflectanceSearchOptions::sigma.
  double tolerance = 1.0;
};

// A material under light of one kind.
struct MaterialUnderLight {
  int material = 0;
  LightGuess light;
  double cost = std::numeric_limits<double>::infinity(), misfit = 0.0;
};
using Ranking = std::vector<MaterialUnderLight>;  // by cost

// The materials of a model, the candidates that are left of them, and the best
// local optimum so far. What SearchReflectances calls in turn, for each model.
class ModelSearch {
 public:
  // A material that is refined, from where its last refinement led.
  struct Candidate {
    int material = 0;
    Eigen::VectorXd parameters;
    LightHyperparameters hyperparameters;
    double cost = 0.0;
  };

  // All must outlive it. image: with bounces.
  ModelSearch(const SearchedModel& model,
              const std::vector<ShadingPoint>& points,
              const Observations& image,
              const std::vector<Eigen::Vector3d>& directional_lights,
              const ReflectanceSearchOptions& options);

  // Ranks all materials at the screen's resolution, and the best of them at the
  // coarse one: under each guess of the light.
  void Rank(const std::vector<LightGuess>& lights);
  const std::vector<Ranking>& rankings() const { return rankings_; }
  // Makes a ranked material a candidate; false where it is one.
  bool Take(const MaterialUnderLight& ranked);

  const std::vector<Candidate>& candidates() const { return candidates_; }
  void KeepCandidates(size_t most);

  // The light where a candidate is.
  LightGuess LightAt(const Candidate& candidate) const;

  // What follows refines at the fine resolution.
  void Sharpen();
  // Refines a candidate at the present resolution; any thread may call it.
  LocalOptimum Refine(const Candidate& candidate, double tolerance,
                      int iterations) const {
    return level_->Refine(candidate.parameters, candidate.hyperparameters,
                          tolerance * options_.sigma, iterations);
  }
  // Refinements of all candidates, in order: those that came to something take
  // their places, the best first. False where none did, which leaves all as it
  // was. The end of each is reported under its name behind `what`; empty: not.
  bool Join(std::vector<LocalOptimum> optima, const std::string& what);

  // Takes what the object throws on itself out of the image.
  void TakeBouncesOut();

  size_t num_materials() const { return materials_.size(); }
  bool has_optimum() const { return best_level_ != nullptr; }
  // Texels of the best optimum's map; 0: there is none.
  int num_texels() const {
    return has_optimum() ? best_level_->reflectance().likelihood().num_texels()
                         : 0;
  }
  double best_cost() const { return best_.cost; }
  double best_misfit() const { return best_.value.misfit; }
  // The best optimum; it must have one. covariance: with that of its
  // parameters.
  ReflectanceSearchResult Result(bool covariance);

 private:
  std::unique_ptr<SearchLevel> LevelAt(
      const MarginalResolution& resolution) const;
  // Ranks again what is in the rankings.
  void RankAll(const SearchLevel& level);
  Eigen::VectorXd ParametersOf(const MaterialUnderLight& ranked,
                               const SearchLevel& level) const;
  std::vector<double> LogRadiance() const;
  // Without the directional lights.
  std::vector<double> Lobes(const Candidate& candidate) const;
  // In place of an earlier one of its material.
  void KeepCoarse(const Candidate& candidate);

  const SearchedModel& model_;
  const std::vector<ShadingPoint>& points_;
  const Observations& image_;
  Observations unbounced_;  // the image without bounces
  const std::vector<Eigen::Vector3d>& directional_lights_;
  const ReflectanceSearchOptions& options_;
  std::unique_ptr<SearchLevel> screen_;
  std::unique_ptr<SearchLevel> level_;       // the present resolution
  bool coarse_ = true;                       // which is that
  std::unique_ptr<SearchLevel> last_level_;  // kept while the best is of it
  std::vector<MaterialCandidate> materials_;
  std::vector<Ranking> rankings_;
  std::vector<Candidate> candidates_;
  std::vector<CoarseOptimum> coarse_optima_;  // one of a material at most
  const SearchLevel* best_level_ = nullptr;
  LocalOptimum best_;
  Candidate best_candidate_;
};

}  // namespace ibrdf
