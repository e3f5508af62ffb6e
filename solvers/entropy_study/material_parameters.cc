#include "ibrdf/solvers/entropy_study/material_parameters.h"

#include <filesystem>

#include "ibrdf/base/pi.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/metrics/albedo.h"
#include "ibrdf/solvers/baselines/table_fit.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

constexpr double kViewAngle = 15.0 * kPi / 180.0;

Eigen::Array3d AlbedoOf(const MerlTable& table) {
  const AlbedoRule rule(kViewAngle);
  Eigen::Array3d albedo = Eigen::Array3d::Zero();
  for (size_t i = 0; i < rule.angles().size(); ++i) {
    const HalfDiff& a = rule.angles()[i];
    albedo += rule.weights()[i] *
              InterpolateMerl(table, a.theta_h, a.theta_d, a.phi_d);
  }
  return albedo;
}

}  // namespace

const std::vector<std::string>& MaterialParametersColumns() {
  static const std::vector<std::string> columns = {
      "material", "roughness", "ks_red",   "ks_green",
      "ks_blue",  "kd_red",    "kd_green", "kd_blue"};
  return columns;
}

GlossParameters GlossOf(const Disney& fit, const Eigen::Array3d& albedo) {
  GlossParameters out;
  out.roughness = fit.roughness;
  const double matte = 1.0 - fit.metallic;
  const Eigen::Array3d f0 =
      0.08 * matte * fit.specular + fit.metallic * fit.base;
  out.Kd = (matte * fit.base).min(albedo).min(1.0);
  out.Ks = (albedo - out.Kd).max(f0).min(1.0);
  return out;
}

Status RunMaterialParameters(const MaterialParametersOptions& options) {
  const StatusOr<std::vector<std::string>> names =
      ListNames(options.data, {".binary"});
  if (!names.ok()) return names.status();
  if (names->empty()) {
    return InvalidInput(options.data, "expected a folder of .binary tables");
  }
  IBRDF_RETURN_IF_ERROR(PrepareFolder(options.out));
  const std::string path =
      (std::filesystem::path(options.out) / "results.csv").string();
  const auto present = ReadResults(path, MaterialParametersColumns());
  if (!present.ok()) return present.status();
  for (const std::string& name : *names) {
    IBRDF_RETURN_IF_ERROR(CheckCaseName(name));
    if (options.stop != nullptr && *options.stop) {
      return Status(StatusCode::kInterrupted, name + ": interrupted");
    }
    if (HoldsCase(*present, {name}, 1)) continue;
    if (options.report) options.report(name);
    const StatusOr<MerlTable> table =
        ReadMerl(FindFile(options.data, name, {".binary"}));
    if (!table.ok()) return table.status();
    const StatusOr<Disney> fit = FitDisney(*table, {});
    if (!fit.ok()) return fit.status();
    const GlossParameters gloss = GlossOf(*fit, AlbedoOf(*table));
    ResultsRow row = {name, NumberCell(gloss.roughness)};
    for (const Eigen::Array3d& colour : {gloss.Ks, gloss.Kd}) {
      for (int c = 0; c < 3; ++c) row.push_back(NumberCell(colour[c]));
    }
    IBRDF_RETURN_IF_ERROR(AppendResult(path, MaterialParametersColumns(), row));
  }
  return OkStatus();
}

}  // namespace ibrdf
