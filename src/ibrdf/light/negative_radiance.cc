#include "ibrdf/light/negative_radiance.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace ibrdf {
namespace {

std::string Number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

StatusOr<NegativeRadiance> ClampNegativeRadiance(const std::string& where,
                                                 MapFrame frame, Image* map) {
  const MapSize size = {map->width, map->height};
  IBRDF_RETURN_IF_ERROR(CheckMapSize(where, frame, size));
  const std::vector<double> angles = MapGrid(frame, size).SolidAngles();
  NegativeRadiance found;
  double negative[3] = {0.0, 0.0, 0.0}, all[3] = {0.0, 0.0, 0.0};
  for (size_t i = 0; i < map->rgb.size(); ++i) {
    const float value = map->rgb[i];
    const size_t texel = i / 3;
    if (angles[texel] == 0.0) continue;
    if (!std::isfinite(value)) {
      return InvalidInput(
          where, "row " + std::to_string(texel / size.width) + ", column " +
                     std::to_string(texel % size.width) +
                     ": expected finite radiance, found " + Number(value));
    }
    all[i % 3] += angles[texel] * std::abs(value);
    if (value >= 0.0f) continue;
    negative[i % 3] -= angles[texel] * value;
    found.lowest = std::min(found.lowest, value);
    ++found.values;
  }
  for (int k = 0; k < 3; ++k) {
    if (all[k] > 0.0) found.share = std::max(found.share, negative[k] / all[k]);
  }
  if (found.share > kMaxNegativeShare) {
    return InvalidInput(
        where, "expected radiance >= 0, found " + std::to_string(found.values) +
                   " values below 0, the lowest " + Number(found.lowest) +
                   ", which hold " + Number(100.0 * found.share) +
                   " % of a channel's light");
  }
  for (size_t i = 0; i < map->rgb.size(); ++i) {
    if (angles[i / 3] == 0.0 || !(map->rgb[i] > 0.0f)) map->rgb[i] = 0.0f;
  }
  return found;
}

}  // namespace ibrdf
