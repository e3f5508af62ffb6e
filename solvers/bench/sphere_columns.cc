#include "ibrdf/solvers/bench/sphere_columns.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

// Empty: there is no other.
StatusOr<std::string> NextMap(const SweepOptions& options,
                              const std::string& map) {
  const StatusOr<std::vector<std::string>> names =
      ListNames(options.maps, MapExtensions());
  if (!names.ok()) return names.status();
  auto next = std::upper_bound(names->begin(), names->end(), map);
  if (next == names->end()) next = names->begin();
  return next == names->end() || *next == map ? std::string() : *next;
}

}  // namespace

void SetSphere(const std::string& name, const SphereMetrics& metrics,
               NamedRow* row) {
  row->Set(name + "_log_rmse", NumberCell(metrics.log_rmse));
  row->Set(name + "_rmse", NumberCell(metrics.rmse));
  row->Set(name + "_dssim", NumberCell(metrics.dssim));
}

Status SetMirror(const SweepOptions& options, const SolverRun& run,
                 const std::string& folder, NamedRow* row) {
  const StatusOr<Image> truth = TrueMap(options, run.of);
  if (!truth.ok()) return truth.status();
  const StatusOr<Image> map =
      ReadMap(folder + "/" + run.estimate + "/illumination.exr", std::nullopt);
  if (!map.ok()) return map.status();
  const StatusOr<SphereMetrics> sphere = CompareMirrors(*map, *truth);
  if (!sphere.ok()) return sphere.status();
  SetSphere("mirror", *sphere, row);
  return OkStatus();
}

Status SetRelit(const SweepOptions& options, const SolverRun& run,
                const std::string& folder, NamedRow* row) {
  const StatusOr<std::string> name = NextMap(options, run.of.map);
  if (!name.ok()) return name.status();
  if (name->empty()) return OkStatus();
  SweepCase relit = run.of;
  relit.map = *name;
  relit.map_path = FindFile(options.maps, *name, MapExtensions());
  const StatusOr<Image> map = TrueMap(options, relit);
  if (!map.ok()) return map.status();
  const StatusOr<MerlTable> estimate =
      ReadMerl(folder + "/" + run.estimate + "/brdf.binary");
  if (!estimate.ok()) return estimate.status();
  const StatusOr<MerlTable> truth = ReadMerl(run.of.brdf_path);
  if (!truth.ok()) return truth.status();
  const StatusOr<SphereMetrics> sphere =
      CompareRelit(*estimate, *truth, *map, options.num_threads);
  if (!sphere.ok()) return sphere.status();
  SetSphere("relit", *sphere, row);
  return OkStatus();
}

}  // namespace ibrdf
