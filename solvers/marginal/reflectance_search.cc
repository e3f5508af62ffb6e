#include "ibrdf/solvers/marginal/reflectance_search.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/solvers/marginal/highlight_lights.h"
#include "ibrdf/solvers/marginal/model_search.h"

namespace ibrdf {
namespace {

// Every candidate takes so many steps at the fine resolution.
constexpr int kTrialIterations = 3;

// The searches of all models, stage by stage.
class Search {
 public:
  Search(const std::vector<SearchedModel>& models,
         const std::vector<ShadingPoint>& points, const Observations& observed,
         const ReflectanceSearchOptions& options)
      : options_(options),
        directional_lights_(LightsOfHighlights(points, observed, options)) {
    for (const SearchedModel& model : models) {
      searches_.emplace_back(model, points, observed, directional_lights_,
                             options);
    }
  }

  // Ranks the materials and refines the best; false where none explains the
  // image.
  bool RankAndRefine() {
    const std::vector<SearchStage>& stages = options_.coarse_stages;
    Rank(FirstGuesses());
    for (ModelSearch& search : searches_) {
      TakeBest(stages.front().most, &search);
    }
    if (NumCandidates() == 0) return false;
    for (size_t k = 0; k < stages.size(); ++k) {
      for (ModelSearch& search : searches_) {
        search.KeepCandidates(stages[k].most);
      }
      if (k == 1 && options_.ranked_anew > 0) RankAnew();
      if (!Refine("", stages[k].tolerance, stages[k].iterations)) return false;
      const ModelSearch& best = Best();
      Report("refine " + std::to_string(NumCandidates()), best.best_cost(),
             best.best_misfit());
    }
    return true;
  }

  // Compares the candidates of all models at the fine resolution and finishes
  // the best. Coarse costs say little of a model of plainer shapes, which
  // begins badly and may end best: each model's best is compared.
  void FinishBest() {
    if (options_.fine_iterations == 0 || options_.Stopped()) return;
    DropBeyond(options_.coarse_margin, 1);
    for (ModelSearch& search : searches_) {
      if (!search.candidates().empty()) search.Sharpen();
    }
    if (!Refine("", 1.0, kTrialIterations)) return;
    DropBeyond(options_.margin, 0);
    Refine("finish ", 1.0, options_.fine_iterations);
  }

  void TakeBouncesOut() {
    if (options_.fine_iterations == 0) return;
    for (ModelSearch& search : searches_) {
      if (IsInTheRace(search)) search.TakeBouncesOut();
    }
  }

  std::vector<ReflectanceSearchResult> Results() {
    const ModelSearch* best = &Best();
    std::vector<ReflectanceSearchResult> results;
    for (size_t m = 0; m < searches_.size(); ++m) {
      if (!IsInTheRace(searches_[m])) continue;
      results.push_back(
          searches_[m].Result(options_.covariance && &searches_[m] == best));
      results.back().model = m;
    }
    return results;
  }

 private:
  void Report(const std::string& stage, double cost, double misfit) const {
    if (options_.report) options_.report(stage, cost, misfit);
  }

  // Average light and harsh light, at each tolerance.
  std::vector<LightGuess> FirstGuesses() const {
    std::vector<LightGuess> guesses;
    for (const double tolerance : options_.ranking_tolerances) {
      guesses.push_back({LightHyperparameters(), {}, tolerance});
      guesses.push_back({LightHyperparameters::Harsh(), {}, tolerance});
    }
    return guesses;
  }

  // Each model's materials under these lights.
  void Rank(const std::vector<LightGuess>& lights) {
    for (ModelSearch& search : searches_) search.Rank(lights);
    ReportRanking();
  }

  // Each model's materials under the light of its best candidate: others may
  // explain the image there.
  void RankAnew() {
    for (ModelSearch& search : searches_) {
      if (search.candidates().empty()) continue;
      search.Rank({search.LightAt(search.candidates().front())});
      TakeBest(options_.ranked_anew, &search);
    }
    ReportRanking();
  }

  void ReportRanking() const {
    const MaterialUnderLight* best = nullptr;
    size_t count = 0;
    for (const ModelSearch& search : searches_) {
      for (const Ranking& ranking : search.rankings()) {
        const MaterialUnderLight& first = ranking.front();
        if (best == nullptr || first.cost < best->cost) best = &first;
      }
      count += search.num_materials();
    }
    if (!std::isfinite(best->cost)) return;
    Report("rank " + std::to_string(count) + " materials", best->cost,
           best->misfit);
  }

  // Makes the best of a model's rankings candidates, in turns, the best ranking
  // first.
  static void TakeBest(int most, ModelSearch* search) {
    std::vector<const Ranking*> rankings;
    for (const Ranking& r : search->rankings()) rankings.push_back(&r);
    std::stable_sort(rankings.begin(), rankings.end(),
                     [](const Ranking* a, const Ranking* b) {
                       return a->front().cost < b->front().cost;
                     });
    for (int k = 0; k < most; ++k) {
      for (const MaterialUnderLight& ranked : *rankings[k % rankings.size()]) {
        if (!std::isfinite(ranked.cost) || search->Take(ranked)) break;
      }
    }
  }

  size_t NumCandidates() const {
    size_t count = 0;
    for (const ModelSearch& search : searches_) {
      count += search.candidates().size();
    }
    return count;
  }

  // Drops the candidates whose costs are not within the margin of the lowest of
  // all models, but for the best few of each.
  void DropBeyond(double margin, size_t least_of_model) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const ModelSearch& search : searches_) {
      if (search.candidates().empty()) continue;
      lowest = std::min(lowest, search.candidates().front().cost);
    }
    for (ModelSearch& search : searches_) {
      const auto& all = search.candidates();
      const auto within = static_cast<size_t>(std::count_if(
          all.begin(), all.end(),
          [&](const auto& c) { return c.cost <= lowest + margin; }));
      search.KeepCandidates(std::max(within, least_of_model));
    }
  }

  // Whole refinements of all candidates in parallel. False where none comes to
  // anything.
  bool Refine(const std::string& what, double tolerance, int iterations) {
    std::vector<std::vector<LocalOptimum>> optima;
    std::vector<std::pair<size_t, size_t>> tasks;  // search, candidate
    for (size_t m = 0; m < searches_.size(); ++m) {
      optima.emplace_back(searches_[m].candidates().size());
      for (size_t k = 0; k < optima[m].size(); ++k) tasks.emplace_back(m, k);
    }
    ParallelFor(static_cast<int64_t>(tasks.size()), options_.num_threads,
                [&](int64_t task, int) {
                  if (task > 0 && options_.Stopped()) return;
                  const auto& [m, k] = tasks[task];
                  optima[m][k] = searches_[m].Refine(
                      searches_[m].candidates()[k], tolerance, iterations);
                });
    bool any = false;
    for (size_t m = 0; m < searches_.size(); ++m) {
      if (searches_[m].Join(std::move(optima[m]), what)) {
        any = true;
      }
    }
    return any;
  }

  // Whether the model's best optimum is of the finest resolution of all.
  bool IsInTheRace(const ModelSearch& search) const {
    return search.has_optimum() &&
           search.num_texels() ==
               std::max_element(searches_.begin(), searches_.end(),
                                [](const auto& a, const auto& b) {
                                  return a.num_texels() < b.num_texels();
                                })
                   ->num_texels();
  }

  const ModelSearch& Best() const {
    const ModelSearch* best = nullptr;
    for (const ModelSearch& search : searches_) {
      if (IsInTheRace(search) &&
          (best == nullptr || search.best_cost() < best->best_cost())) {
        best = &search;
      }
    }
    return *best;
  }

  const ReflectanceSearchOptions& options_;
  const std::vector<Eigen::Vector3d> directional_lights_;
  std::vector<ModelSearch> searches_;
};

}  // namespace

void SortByCost(std::vector<MaterialCandidate>* candidates) {
  std::stable_sort(candidates->begin(), candidates->end(),
                   [](const MaterialCandidate& a, const MaterialCandidate& b) {
                     return std::tie(a.cost, a.first_cost) <
                            std::tie(b.cost, b.first_cost);
                   });
}

StatusOr<std::vector<ReflectanceSearchResult>> SearchReflectances(
    const std::vector<SearchedModel>& models,
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options) {
  CHECK(!models.empty());
  for (const SearchedModel& model : models) {
    CHECK(!model.prior->materials.empty());
  }
  CHECK(options.kept > 0 && options.sigma > 0.0);
  CHECK(options.coarse_margin >= 0.0 && options.margin >= 0.0);
  CHECK(options.fine_iterations >= 0 && options.most_directional_lights >= 0);
  if (BinByNormal(points, observed, options.coarse.bins).num_bins() == 0) {
    return InvalidInput("image",
                        "no pixel of the object, limb aside, is finite and "
                        "positive in all three channels");
  }
  Search search(models, points, observed, options);
  if (!search.RankAndRefine()) {
    return Status(StatusCode::kNoImprovement,
                  "no training material explains the image at all");
  }
  search.FinishBest();
  search.TakeBouncesOut();
  return search.Results();
}

StatusOr<ReflectanceSearchResult> SearchReflectance(
    const SearchedModel& model, const std::vector<ShadingPoint>& points,
    const Observations& observed, const ReflectanceSearchOptions& options) {
  StatusOr<std::vector<ReflectanceSearchResult>> results =
      SearchReflectances({model}, points, observed, options);
  if (!results.ok()) return results.status();
  return std::move(results->front());
}

}  // namespace ibrdf
