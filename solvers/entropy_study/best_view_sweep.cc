#include "ibrdf/solvers/entropy_study/best_view_sweep.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/solvers/entropy_study/brute_force.h"
#include "ibrdf/solvers/entropy_study/statistics.h"
#include "ibrdf/uncertainty/best_view.h"

namespace ibrdf {
namespace {

constexpr int kInitial = 10, kMost = 20;  // views

struct ViewSearch {
  std::string name;  // no comma
  BestViewOptions options;
};

std::vector<ViewSearch> ViewSearches() {
  std::vector<ViewSearch> out;
  const auto add = [&](std::string name, const BestViewOptions& options) {
    out.push_back({std::move(name), options});
  };
  add("best view", {});
  BestViewOptions o;
  o.spectrum = SpectrumOptions::Published(1e-4);
  add("published 0.0001", o);
  o.published_alpha = true;
  o.published_mask = true;
  add("published 0.0001 its alpha and mask", o);
  o.spectrum = SpectrumOptions::Published(1e-2);
  add("published 0.01 its alpha and mask", o);
  o = {};
  o.trusted_views = 1000;
  add("parameters uniform", o);
  o = {};
  o.spectrum.fit.constant_penalty = 1.0;
  add("constant penalised", o);
  o = {};
  o.spectrum.fit.lambda = 1e-2;
  add("lambda 0.01", o);
  for (const double sigma : {0.05, 0.1, 0.2}) {
    o = {};
    o.spectrum.sigma = sigma;
    add(Format("sigma %g", sigma), o);
  }
  return out;
}

// Means over texels and channels of brute force with the first `count` views.
struct Score {
  double entropy, error;
};
Score ScoreOf(const StudyScene& scene, const std::vector<int>& views, int count,
              int num_threads) {
  const BruteForce brute = EvaluateBruteForce(
      scene, std::vector<int>(views.begin(), views.begin() + count),
      kBruteForceSharpness, num_threads);
  return {Mean(brute.entropy), Mean(brute.error)};
}

// With how many of the views the entropy falls to the goal; kMost where it does
// not before.
int ViewsToReach(const StudyScene& scene, const std::vector<int>& views,
                 double goal, int num_threads) {
  int reached = kInitial;
  while (reached < kMost &&
         ScoreOf(scene, views, reached, num_threads).entropy > goal) {
    ++reached;
  }
  return reached;
}

// Greedy on brute force itself, which knows every photograph before it is
// taken: what no search can know.
std::vector<int> OracleViews(const StudyScene& scene,
                             const std::vector<int>& initial, int num_threads) {
  std::vector<int> views = initial;
  while (static_cast<int>(views.size()) < kMost) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < scene.samples.num_views; ++k) {
      if (std::count(views.begin(), views.end(), k) > 0) continue;
      views.push_back(k);
      const double entropy =
          ScoreOf(scene, views, static_cast<int>(views.size()), num_threads)
              .entropy;
      views.pop_back();
      if (entropy < least) {
        least = entropy;
        best = k;
      }
    }
    views.push_back(best);
  }
  return views;
}

// The rows of one scene.
class SearchRows {
 public:
  SearchRows(const StudyOptions& options, const StudyCase& c,
             const StudyScene& scene, const AppendStudyRow& append)
      : options_(options),
        case_(c),
        scene_(scene),
        append_(append),
        farthest_(FarthestPoints(scene.cameras, {}, kMost)),
        goal_(ScoreOf(scene, farthest_, kMost, options.num_threads)) {}

  Status Append() const {
    const std::vector<int> initial(farthest_.begin(),
                                   farthest_.begin() + kInitial);
    // The light is known, and so is what the surface hides of it.
    TexelSamples samples = scene_.samples;
    samples.incoming = scene_.unhidden_incoming;
    if (options_.oracle) {
      IBRDF_RETURN_IF_ERROR(AppendRow(
          "oracle", OracleViews(scene_, initial, options_.num_threads), 0.0));
    }
    for (const ViewSearch& search : ViewSearches()) {
      const Stopwatch clock;
      const std::vector<int> best = BestViews(
          samples, initial, kMost, true, search.options, options_.num_threads);
      IBRDF_RETURN_IF_ERROR(
          AppendRow(search.name, best, clock.Seconds() / (kMost - kInitial)));
    }
    return OkStatus();
  }

 private:
  Status AppendRow(const std::string& name, const std::vector<int>& views,
                   double seconds) const {
    const Score last = ScoreOf(scene_, views, kMost, options_.num_threads);
    NamedRow row(BestViewColumns());
    SetStudyCase(case_, &row);
    row.Set("search", name);
    row.Set("views_that_reach_20",
            std::to_string(ViewsToReach(scene_, views, goal_.entropy,
                                        options_.num_threads)));
    row.Set("entropy_farthest", NumberCell(goal_.entropy));
    row.Set("entropy_best", NumberCell(last.entropy));
    row.Set("error_farthest", NumberCell(goal_.error));
    row.Set("error_best", NumberCell(last.error));
    row.Set("seconds_a_view", NumberCell(seconds));
    return append_(row.cells());
  }

  const StudyOptions& options_;
  const StudyCase& case_;
  const StudyScene& scene_;
  const AppendStudyRow& append_;
  const std::vector<int> farthest_;
  const Score goal_;
};

int CountLess(const std::vector<double>& a, const std::vector<double>& b) {
  int count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] < b[i];
  return count;
}

Status WriteViewSummary(const StudyOptions& options) {
  const std::filesystem::path out(options.out);
  const auto rows =
      ReadResults((out / "results.csv").string(), BestViewColumns());
  if (!rows.ok()) return rows.status();
  const auto values = [&](const char* column) {
    return ValuesByName(BestViewColumns(), *rows, column);
  };
  const ColumnByName views = values("views_that_reach_20");
  const ColumnByName farthest = values("entropy_farthest"),
                     best = values("entropy_best"),
                     farthest_error = values("error_farthest"),
                     best_error = values("error_best");
  std::vector<ResultsRow> table;
  for (size_t i = 0; i < views.size(); ++i) {
    const std::vector<double>&a = farthest[i].second, &b = best[i].second;
    ResultsRow row = {
        views[i].first,
        Format("%g", Median(views[i].second)),
        Format("%.4f", Mean(a) - Mean(b)),
        std::to_string(CountLess(b, a)) + " of " + std::to_string(a.size()),
        std::to_string(
            CountLess(best_error[i].second, farthest_error[i].second)),
        "-",
        "-"};
    if (a.size() > 1) {
      const TTest test = PairedTTest(a, b);
      row[5] = Format("%.2f", test.t);
      row[6] = Format("%.2g", test.p);
    }
    table.push_back(std::move(row));
  }
  return WriteFileAtomically(
      (out / "results.md").string(),
      ResultsMarkdown(
          "# Best views beside farthest points\n\nEntropy of brute force with "
          "twenty views.\n",
          {"search", "views to the goal, median", "entropy less by",
           "scenes with less entropy", "with less error", "t", "p"},
          table));
}

}  // namespace

const std::vector<std::string>& BestViewColumns() {
  static const std::vector<std::string> columns = {"scene",
                                                   "seed",
                                                   "search",
                                                   "shape",
                                                   "map",
                                                   "light",
                                                   "views_that_reach_20",
                                                   "entropy_farthest",
                                                   "entropy_best",
                                                   "error_farthest",
                                                   "error_best",
                                                   "seconds_a_view"};
  return columns;
}

Status RunBestViewSweep(const StudyOptions& options) {
  IBRDF_RETURN_IF_ERROR(
      RunStudy(options, BestViewColumns(), ViewSearches().back().name,
               [&](const StudyCase& c, const StudyScene& scene,
                   const AppendStudyRow& append) {
                 return SearchRows(options, c, scene, append).Append();
               }));
  return WriteViewSummary(options);
}

}  // namespace ibrdf
