// What is dark in an image.
#pragma once

namespace ibrdf {

// In log errors of radiance, values below this share of the mean over the image
// count as that bright: nobody sees how dark the darkest parts are.
inline constexpr double kDarkestShare = 1e-3;

}  // namespace ibrdf
