#include "ibrdf/solvers/bench/known_brdf_sweep.h"

#include <memory>
#include <optional>

#include "ibrdf/io/map_file.h"
#include "ibrdf/solvers/bench/sphere_columns.h"

namespace ibrdf {
namespace {

constexpr int kKnownBrdfKeys = 5;

std::string ProblemText(const KnownBrdfSweepOptions& options,
                        const SweepCase& c, const std::string& prior) {
  return "problem: illumination\n" + ImageYaml(options) +
         "reflectance: {known: " + Quoted(c.brdf_path) +
         "}\nillumination: {width: " + std::to_string(kSweepMapWidth) +
         ", height: " + std::to_string(kSweepMapHeight) + ", prior: " + prior +
         "}\n" + SolverYaml(options) +
         "truth: {illumination: " + MapAndFrame(c) + "}\n";
}

Status CompareMaps(const KnownBrdfSweepOptions& options,
                   const SphereGallery& gallery, const SolverRun& run,
                   const std::string& folder, bool solved, NamedRow* row) {
  const StatusOr<Image> truth = TrueMap(options, run.of);
  if (!truth.ok()) return truth.status();
  IBRDF_RETURN_IF_ERROR(SetConstantMap(*truth, row));
  if (!solved) return OkStatus();
  const StatusOr<Image> map =
      ReadMap(folder + "/" + run.estimate + "/illumination.exr", std::nullopt);
  if (!map.ok()) return map.status();
  const auto spheres = gallery.Compare(*map, *truth);
  if (!spheres.ok()) return spheres.status();
  for (int k = 0; k < kNumSpheres; ++k) {
    SetSphere(SphereName(static_cast<Sphere>(k)), (*spheres)[k], row);
  }
  return OkStatus();
}

}  // namespace

const std::vector<std::string>& KnownBrdfColumns() {
  static const std::vector<std::string> columns = {
      "material",
      "map",
      "geometry",
      "prior",
      "method",
      "seconds",
      "cpu_seconds",
      "peak_mb",
      "misfit",
      "illumination_relative_log_rmse",
      "illumination_relative_log_rmse_aligned",
      "status",
      "mirror_log_rmse",
      "mirror_rmse",
      "mirror_dssim",
      "diffuse_log_rmse",
      "diffuse_rmse",
      "diffuse_dssim",
      "glossy_log_rmse",
      "glossy_rmse",
      "glossy_dssim",
      "constant_map_relative_log_rmse",
      "constant_map_relative_log_rmse_aligned"};
  return columns;
}

StatusOr<SolverSweep> KnownBrdfSweep(const KnownBrdfSweepOptions& options) {
  const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
  if (!cases.ok()) return cases.status();
  SolverSweep sweep;
  sweep.title = "Illumination of a known material";
  sweep.columns = &KnownBrdfColumns();
  sweep.key_columns = kKnownBrdfKeys;
  for (const SweepCase& c : *cases) {
    for (const std::string& prior : options.priors) {
      NamedRow row = CaseRow(options, c, KnownBrdfColumns());
      row.Set("prior", prior);
      row.Set("method", options.method);
      sweep.runs.push_back({c, "known_brdf_" + prior + ".yaml",
                            ProblemText(options, c, prior),
                            "known_brdf_" + prior + "_" + options.method, row});
    }
  }
  const auto gallery =
      std::make_shared<const SphereGallery>(options.num_threads);
  sweep.finish = [options, gallery](const SolverRun& run,
                                    const std::string& folder, bool solved,
                                    NamedRow* row) {
    return CompareMaps(options, *gallery, run, folder, solved, row);
  };
  return sweep;
}

}  // namespace ibrdf
