#include "ibrdf/solvers/bench/albedo_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/brdf_sampler.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/metrics/albedo.h"
#include "ibrdf/solvers/bench/model_materials.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/sweep_files.h"
#include "ibrdf/solvers/problem/open_model.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

constexpr double kSampledView = kPi / 4;

std::string ViewColumn(double degrees) {
  return "albedo_" + std::to_string(static_cast<int>(degrees));
}

std::string ResultsPath(const AlbedoSweepOptions& options) {
  return options.out + "/results.csv";
}

NamedRow KeyOf(const AlbedoSweepOptions& options, const std::string& material,
               const std::string& source) {
  NamedRow row(AlbedoColumns());
  row.Set("material", material);
  row.Set("source", source);
  row.Set("model", fs::path(options.model).filename().string());
  return row;
}

void SetFigures(const FurnaceFigures& figures, NamedRow* row) {
  for (int i = 0; i < FurnaceRules::kNumViews; ++i) {
    row->Set(ViewColumn(FurnaceRules::kViewDegrees[i]),
             NumberCell(figures.albedo[i].mean()));
  }
  row->Set("largest", NumberCell(figures.largest.maxCoeff()));
  row->Set("views_above_one", std::to_string(figures.above_one));
  const char* channels[] = {"red", "green", "blue"};
  for (int c = 0; c < 3; ++c) {
    row->Set(std::string("hemispherical_") + channels[c],
             NumberCell(figures.hemispherical[c]));
  }
}

// Relative standard deviations of f cos / pdf, f the mean of the channels: of
// the sampler by drawing, for its pdf has steps; cosine-weighted by the rule.
void SetDeviations(const BrdfBatch& brdf, NamedRow* row) {
  constexpr int kDraws = 20000;
  const BrdfSampler sampler(brdf);
  const Eigen::Vector3d wo(std::sin(kSampledView), 0, std::cos(kSampledView));
  std::mt19937_64 rng(1);
  const auto uniform = [&rng] {
    return static_cast<double>(rng() >> 11) * 0x1p-53;
  };
  std::vector<HalfDiff> angles;
  std::vector<double> weights;
  for (int i = 0; i < kDraws; ++i) {
    const double u1 = uniform(), u2 = uniform(), u3 = uniform();
    const BrdfSampler::Sample sample = sampler.Draw(wo, u1, u2, u3);
    if (sample.pdf <= 0.0) continue;  // worth nothing
    angles.push_back(ToHalfDiff(sample.wi, wo));
    weights.push_back(sample.wi.z() / sample.pdf);
  }
  const auto set = [row](const char* column, double mean, double square) {
    row->Set(
        column,
        NumberCell(std::sqrt(std::max(square / (mean * mean) - 1.0, 0.0))));
  };
  double mean = 0.0, square = 0.0;
  std::vector<Eigen::Array3d> f = brdf(angles);
  for (size_t i = 0; i < f.size(); ++i) {
    const double value = weights[i] * f[i].mean() / kDraws;
    mean += value;
    square += value * value * kDraws;
  }
  set("deviation_sampler", mean, square);
  const AlbedoRule rule(kSampledView);
  f = brdf(rule.angles());
  mean = square = 0.0;
  for (size_t i = 0; i < f.size(); ++i) {
    const double value = rule.weights()[i] * f[i].mean();
    mean += value;
    square += value * f[i].mean() * kPi;
  }
  set("deviation_cosine", mean, square);
}

double Number(const ResultsRow& row, const std::string& column) {
  const std::vector<std::string>& columns = AlbedoColumns();
  const size_t at =
      std::find(columns.begin(), columns.end(), column) - columns.begin();
  return row[at].empty() ? std::nan("") : std::strtod(row[at].c_str(), nullptr);
}

// Rows of one source: how much energy is made.
std::string EnergyLine(const std::string& source,
                       const std::vector<ResultsRow>& rows) {
  int materials = 0, with = 0;
  double views = 0.0, largest = 0.0;
  std::string worst;
  for (const ResultsRow& row : rows) {
    if (row[1] != source) continue;
    ++materials;
    const double above = Number(row, "views_above_one");
    with += above > 0.0;
    views += above;
    if (Number(row, "largest") > largest) {
      largest = Number(row, "largest");
      worst = row[0];
    }
  }
  if (materials == 0) return "";
  return "- " + source + ": " + std::to_string(with) + " of " +
         std::to_string(materials) + " materials, " +
         Format("%.0f of %.0f", views, 54.0 * materials) +
         " views and channels above 1; the largest is " +
         Format("%.3f", largest) + " (" + worst + ").\n";
}

// How far the model's albedo is from its table's; empty where there are none.
std::string DifferenceLine(const std::vector<ResultsRow>& rows) {
  std::map<std::string, const ResultsRow*> tables;
  for (const ResultsRow& row : rows) {
    if (row[1] == "table") tables[row[0]] = &row;
  }
  std::string differences;
  for (const double degrees : FurnaceRules::kViewDegrees) {
    std::vector<double> ratios;
    for (const ResultsRow& row : rows) {
      const auto table = tables.find(row[0]);
      if (row[1] != "model" || table == tables.end()) continue;
      const std::string column = ViewColumn(degrees);
      ratios.push_back(
          std::abs(Number(row, column) / Number(*table->second, column) - 1.0));
    }
    if (ratios.empty()) continue;
    differences +=
        Format(differences.empty() ? " %.0f deg %.1f %%" : ", %.0f deg %.1f %%",
               degrees, 100.0 * Median(ratios));
  }
  if (differences.empty()) return "";
  return "- Median difference of the model's albedo from the table's:" +
         differences + ".\n";
}

// What importance sampling saves; empty where there is no model.
std::string SamplingLine(const std::vector<ResultsRow>& rows) {
  std::vector<double> sampler, cosine, gain;
  for (const ResultsRow& row : rows) {
    if (row[1] != "model") continue;
    sampler.push_back(Number(row, "deviation_sampler"));
    cosine.push_back(Number(row, "deviation_cosine"));
    gain.push_back(std::pow(cosine.back() / sampler.back(), 2));
  }
  if (gain.empty()) return "";
  return "- Relative deviation of one sample at 45 degrees, median: " +
         Format("%.3f by importance, %.3f cosine-weighted; ", Median(sampler),
                Median(cosine)) +
         Format("variance ratio %.3g (median), %.3g (least).\n", Median(gain),
                *std::min_element(gain.begin(), gain.end()));
}

std::string Summary(const std::vector<ResultsRow>& rows) {
  return "Views every 5 degrees from 0 to 85, three channels each.\n\n" +
         EnergyLine("model", rows) + EnergyLine("table", rows) +
         DifferenceLine(rows) + SamplingLine(rows);
}

// Appends the row of a model's material, where it is not there yet.
Status AddModelRow(const AlbedoSweepOptions& options,
                   const NeuralBrdfModel& model, const ModelMaterial& material,
                   const FurnaceRules& rules,
                   const std::vector<ResultsRow>& present) {
  NamedRow row = KeyOf(options, material.name, "model");
  if (HoldsCase(present, row.cells(), kAlbedoKeyColumns)) return OkStatus();
  const BrdfBatch brdf =
      FlowBrdf(model, MaterialLobes(model, material.first_code).data(), 3,
               options.num_threads)
          .Batch();
  SetFigures(rules.Measure(brdf), &row);
  SetDeviations(brdf, &row);
  return AppendResult(ResultsPath(options), AlbedoColumns(), row.cells());
}

// Appends the row of a material's table, where there is one and it is not there
// yet.
Status AddTableRow(const AlbedoSweepOptions& options,
                   const std::string& material, const FurnaceRules& rules,
                   const std::vector<ResultsRow>& present) {
  if (options.data.empty()) return OkStatus();
  const std::string file = FindFile(options.data, material, {".binary"});
  NamedRow row = KeyOf(options, material, "table");
  if (file.empty() || HoldsCase(present, row.cells(), kAlbedoKeyColumns)) {
    return OkStatus();
  }
  const StatusOr<MerlTable> table = ReadMerl(file);
  if (!table.ok()) return table.status();
  SetFigures(rules.Measure(BatchOf([&](double h, double d, double p) {
    return InterpolateMerl(*table, h, d, p);
  })),
             &row);
  return AppendResult(ResultsPath(options), AlbedoColumns(), row.cells());
}

Status WriteTable(const AlbedoSweepOptions& options) {
  const auto rows = ReadResults(ResultsPath(options), AlbedoColumns());
  if (!rows.ok()) return rows.status();
  return WriteFileAtomically(
      options.out + "/results.md",
      ResultsMarkdown("# Directional albedo\n\n    " + options.command +
                          "\n\n" + Summary(*rows) + "\n## All materials\n",
                      AlbedoColumns(), *rows));
}

}  // namespace

const std::vector<std::string>& AlbedoColumns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> c = {"material", "source", "model"};
    for (const double degrees : FurnaceRules::kViewDegrees) {
      c.push_back(ViewColumn(degrees));
    }
    for (const char* name : {"largest", "views_above_one", "hemispherical_red",
                             "hemispherical_green", "hemispherical_blue",
                             "deviation_sampler", "deviation_cosine"}) {
      c.push_back(name);
    }
    return c;
  }();
  return columns;
}

Status RunAlbedoSweep(const AlbedoSweepOptions& options) {
  const StatusOr<OpenedModel> opened = OpenModel(options.model);
  if (!opened.ok()) return opened.status();
  const auto materials =
      ListModelMaterials(opened->model, opened->path, options.materials);
  if (!materials.ok()) return materials.status();
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return InvalidInput(options.out, error.message());
  const auto present = ReadResults(ResultsPath(options), AlbedoColumns());
  if (!present.ok()) return present.status();

  const FurnaceRules rules;
  for (size_t i = 0; i < materials->size(); ++i) {
    const ModelMaterial& m = (*materials)[i];
    IBRDF_RETURN_IF_ERROR(CheckCaseName(m.name));
    if (options.stop != nullptr && *options.stop) {
      return Status(StatusCode::kInterrupted, m.name + ": interrupted");
    }
    if (options.report) {
      options.report("material " + std::to_string(i + 1) + " / " +
                     std::to_string(materials->size()) + "  " + m.name);
    }
    IBRDF_RETURN_IF_ERROR(
        AddModelRow(options, opened->model, m, rules, *present));
    IBRDF_RETURN_IF_ERROR(AddTableRow(options, m.name, rules, *present));
  }
  return WriteTable(options);
}

}  // namespace ibrdf
