// What several views saw of the texels of a surface.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Samples of outgoing and incoming radiance, a row of `num_views` for each
// texel. A large texture is cut into blocks of texels, each its own
// TexelSamples: nothing here couples two texels.
//
// The frame of a texel has its normal for +z; where the two other axes lie does
// not matter, as long as they are the same for all views.
struct TexelSamples {
  int num_texels = 0;
  int num_views = 0;

  // [num_texels, num_views, 3]: unit direction from the texel to the camera,
  // in the frame of the texel.
  std::vector<float> directions;
  // [num_texels, num_views, 3]: RGB radiance that leaves along the direction.
  std::vector<float> outgoing;
  // [num_texels, num_views, 3]: RGB radiance of the prefiltered map in the
  // *mirror* direction, 2 (n.w) n - w. Both radiances are functions of the
  // outgoing direction so, with the same samples missing.
  std::vector<float> incoming;
  // [num_texels, num_views], in [0, 1]: 0 where the camera does not see the
  // texel, 1 where it does.
  std::vector<float> weight;
  // [num_texels, 3], optional: RGB irradiance. Where it is missing, the angular
  // evaluator finds it from its fit to `incoming`.
  std::vector<float> irradiance;

  // Mean radiance of the map, over directions and channels: the unit of
  // radiance in which noise is stated. > 0.
  double mean_radiance = 1.0;
  // The map was smoothed so that its harmonics of degree l have
  // exp(-(prefilter_alpha l)^2) of their amplitude; 0: it was not.
  double prefilter_alpha = 0.0;

  // All sizes and numbers as above, 1 <= num_views. A direction below the
  // horizon, and radiance that is not finite, is no error: it counts as not
  // seen.
  Status Check() const;
};

// What a sample takes part with: its weight, and 0 where its direction is not
// above the horizon, or where radiance times `scale` is above 1e15 or not
// finite.
float UsableWeight(const TexelSamples& samples, int64_t texel, int view,
                   float scale);

}  // namespace ibrdf
