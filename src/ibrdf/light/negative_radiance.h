// Values below 0 in environment maps, which lossy files and resampling leave.
#pragma once
#include <cstdint>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// What was below 0.
struct NegativeRadiance {
  int64_t values = 0;   // of 3 per texel
  float lowest = 0.0f;  // W/(m^2 sr), <= 0
  // Its part of the light, over the sphere: the integral of the values below 0
  // over that of all absolute values, of the worst channel, in [0, 1].
  double share = 0.0;
};

// DWA compression and resampling with negative lobes stay far below this: the
// studio lights of Blender 3.4 have a share of at most 2e-4.
constexpr double kMaxNegativeShare = 0.01;

// Sets values below 0 of a map to 0 and counts them. Negative zero is 0. Texels
// that stand for nothing (corners of a cross or a probe) become 0 uncounted,
// whatever they hold. Refuses a value that is not finite, by its row and
// column, a share above kMaxNegativeShare, and sizes that the frame refuses;
// the map is then unchanged. `where` names the file.
StatusOr<NegativeRadiance> ClampNegativeRadiance(const std::string& where,
                                                 MapFrame frame, Image* map);

}  // namespace ibrdf
