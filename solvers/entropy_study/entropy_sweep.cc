#include "ibrdf/solvers/entropy_study/entropy_sweep.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ibrdf/base/format.h"
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/solvers/entropy_study/brute_force.h"
#include "ibrdf/solvers/entropy_study/evaluator_variants.h"
#include "ibrdf/solvers/entropy_study/statistics.h"
#include "ibrdf/uncertainty/harmonic_fit.h"

namespace ibrdf {
namespace {

using Numbers = std::vector<double>;

// What the uncertainty of a texel is compared with: -log of the power of B.
Numbers TrivialPredictor(const TexelSamples& samples, int num_threads) {
  const PowerSpectra spectra = FitPowerSpectra(samples, {}, 1.0, num_threads);
  Numbers out(spectra.num_signals);
  for (int texel = 0; texel < samples.num_texels; ++texel) {
    for (int c = 0; c < 3; ++c) {
      double sum = 1e-9;
      for (int l = 1; l <= spectra.order; ++l) {
        sum += spectra.outgoing[l * spectra.num_signals +
                                c * samples.num_texels + texel];
      }
      out[3 * texel + c] = -std::log(sum);
    }
  }
  return out;
}

// Mean |roughness error| and |Ks error| of the most probable parameters.
void SetParameterErrors(const EntropyMaps& maps, const StudyScene& scene,
                        NamedRow* row) {
  double roughness = 0.0, Ks = 0.0;
  for (size_t k = 0; k < maps.alpha.size(); ++k) {
    const StudyMaterial& m = scene.materials[k / 3];
    roughness += std::abs(std::sqrt(maps.alpha[k]) - m.roughness);
    Ks += std::abs(maps.Ks[k] - m.Ks[k % 3]);
  }
  const auto n = static_cast<double>(maps.alpha.size());
  row->Set("roughness_error", NumberCell(roughness / n));
  row->Set("ks_error", NumberCell(Ks / n));
}

// The rows of one scene.
class SceneRows {
 public:
  SceneRows(const StudyCase& c, const StudyScene& scene, int num_threads,
            const AppendStudyRow& append)
      : case_(c),
        scene_(scene),
        num_threads_(num_threads),
        append_(append),
        brute_(
            EvaluateBruteForce(scene, {}, kBruteForceSharpness, num_threads)),
        trivial_(TrivialPredictor(scene.samples, num_threads)) {}

  Status Append() const {
    IBRDF_RETURN_IF_ERROR(append_(RowOf("trivial", trivial_).cells()));
    IBRDF_RETURN_IF_ERROR(append_(RowOf("Laplace", brute_.laplace).cells()));
    for (const EvaluatorVariant& v : EvaluatorVariants()) {
      const Stopwatch clock;
      const StatusOr<EntropyMaps> maps =
          EvaluateVariant(v, scene_, num_threads_);
      if (!maps.ok()) return maps.status();
      const double seconds = clock.Seconds();
      NamedRow row =
          RowOf(v.name, Numbers(maps->entropy.begin(), maps->entropy.end()));
      SetParameterErrors(*maps, scene_, &row);
      row.Set("seconds", NumberCell(seconds));
      IBRDF_RETURN_IF_ERROR(append_(row.cells()));
    }
    return OkStatus();
  }

 private:
  NamedRow RowOf(const std::string& evaluator, const Numbers& H) const {
    NamedRow row(EntropyColumns());
    SetStudyCase(case_, &row);
    row.Set("evaluator", evaluator);
    row.Set("pearson", NumberCell(Pearson(H, brute_.entropy)));
    row.Set("spearman", NumberCell(Spearman(H, brute_.entropy)));
    row.Set("partial",
            NumberCell(PartialCorrelation(H, brute_.entropy, trivial_)));
    row.Set("auc", NumberCell(AreaForTopFifth(H, brute_.entropy)));
    row.Set("with_error", NumberCell(Pearson(H, brute_.error)));
    return row;
  }

  const StudyCase& case_;
  const StudyScene& scene_;
  const int num_threads_;
  const AppendStudyRow& append_;
  const BruteForce brute_;
  const Numbers trivial_;
};

// Mean and least of a column, by evaluator.
Status WriteEntropySummary(const StudyOptions& options) {
  const std::filesystem::path out(options.out);
  const auto rows =
      ReadResults((out / "results.csv").string(), EntropyColumns());
  if (!rows.ok()) return rows.status();
  std::vector<ResultsRow> table;
  const std::vector<std::string> columns = {
      "evaluator", "correlation", "least", "partial",
      "least",     "AUC",         "least", "error of roughness"};
  for (const auto& [name, values] :
       ValuesByName(EntropyColumns(), *rows, "pearson")) {
    table.push_back({name});
  }
  for (const char* column : {"pearson", "partial", "auc", "roughness_error"}) {
    const ColumnByName found = ValuesByName(EntropyColumns(), *rows, column);
    for (size_t i = 0; i < found.size(); ++i) {
      const Numbers& x = found[i].second;
      table[i].push_back(Format("%.3f", Mean(x)));
      if (table[i].size() < columns.size()) {
        table[i].push_back(
            Format("%.3f", *std::min_element(x.begin(), x.end())));
      }
    }
  }
  return WriteFileAtomically(
      (out / "results.md").string(),
      ResultsMarkdown("# Entropy beside brute force\n\nMeans over scenes, and "
                      "the least of them.\n",
                      columns, table));
}

}  // namespace

const std::vector<std::string>& EntropyColumns() {
  static const std::vector<std::string> columns = {
      "scene",    "seed",   "evaluator",  "shape",
      "map",      "light",  "pearson",    "spearman",
      "partial",  "auc",    "with_error", "roughness_error",
      "ks_error", "seconds"};
  return columns;
}

Status RunEntropySweep(const StudyOptions& options) {
  IBRDF_RETURN_IF_ERROR(RunStudy(
      options, EntropyColumns(), EvaluatorVariants().back().name,
      [&](const StudyCase& c, const StudyScene& scene,
          const AppendStudyRow& append) {
        return SceneRows(c, scene, options.num_threads, append).Append();
      }));
  return WriteEntropySummary(options);
}

}  // namespace ibrdf
