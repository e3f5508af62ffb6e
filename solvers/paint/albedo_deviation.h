// How far to trust the albedo of each point.
#pragma once
#include <vector>

#include "ibrdf/solvers/paint/albedo_fit.h"

namespace ibrdf {

// Standard deviation [points] of the log luminance of log_albedo [points * 3],
// FitAlbedo's of the same arguments; the object's scale left out. At most
// kMostOfPaint.
//
// What an image says beyond the fitted albedo, r, counts as an error of shading
// in the fit, and may be paint. The variance of a point that is seen is the sum
// of
//   <r^2>                 the mean over the points about it (error_reach);
//   s^2 / n               where n images see it: their mean square deviation
//                         from their median;
//   w shading_std^2 / n   where a share w of what drifts was taken for paint
//                         (PaintShareOfDrift);
//   log(1 + d / E)^2      light that the estimate has not, as much everywhere:
//                         d, the median of |r| E. E is the point's irradiance
//                         over the object's mean, root mean square of the
//                         images;
//   log(1 + g gloss / matte)^2  g, the gloss's relative error: the images'
//                         median.
// Elsewhere it is that of the points around, filled in, and what paint changes
// on the way: a Gaussian random field of independent steps, with the mean
// square of the fitted albedo's, given the points that are seen.
std::vector<double> AlbedoLogStd(const std::vector<PaintedImage>& images,
                                 const std::vector<NeighbourPair>& neighbours,
                                 const std::vector<double>& log_albedo,
                                 const AlbedoFitOptions& options);

}  // namespace ibrdf
