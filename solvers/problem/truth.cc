#include "ibrdf/solvers/problem/truth.h"

#include <utility>

#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/metrics/illumination_metrics.h"

namespace ibrdf {

StatusOr<Truth> LoadTruth(const TruthSpec& spec, int map_width,
                          int map_height) {
  Truth truth;
  if (!spec.brdf.empty()) {
    StatusOr<MerlTable> table = ReadMerl(spec.brdf);
    if (!table.ok()) return table.status();
    truth.brdf = std::move(table).value();
    const StatusOr<BrdfMetrics> itself = CompareBrdfs(truth.brdf, truth.brdf);
    if (!itself.ok()) return InvalidInput(spec.brdf, itself.status().message());
  }
  if (!spec.illumination.empty()) {
    const StatusOr<Image> map =
        ReadMap(spec.illumination, spec.frame, &truth.warnings);
    if (!map.ok()) return map.status();
    truth.illumination = ResizeMap(*map, map_height, map_width);
    const StatusOr<IlluminationMetrics> itself =
        CompareIlluminations(truth.illumination, truth.illumination);
    if (!itself.ok()) {
      return InvalidInput(spec.illumination, itself.status().message());
    }
  }
  return truth;
}

}  // namespace ibrdf
