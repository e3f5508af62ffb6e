// The gloss of a photographed painted object, pixel by pixel.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/apparent_paint.h"
#include "ibrdf/solvers/paint/neighbours.h"

namespace ibrdf {

// Radiance [points * 3] of the gloss in an image: at each point the e^t g of
// the most probable t, I = e^m e^p E + e^t g (the dichromatic model, Shafer
// 1985). g is the render's gloss with two corrections. A coat reflects all
// colours alike, so g has the light's colour; a channel of the render's gloss
// counts the more the less paint is in it. And g shares the point's error of
// shading, as image over render: what shadows the paint shadows the gloss. p is
// the paint's chroma, as around the point; what pixels differ by from theirs
// around says how well it is known. So a vivid paint tells its gloss by what
// the gloss takes from its saturation, and of a grey one g is returned.
//
// log_albedo [points * 3]: of the paint, as found so far. matte_albedo: what
// image.unpainted->matte has of the irradiance, > 0.
std::vector<double> SeparateGloss(const PaintedImage& image,
                                  const std::vector<double>& log_albedo,
                                  const Eigen::Array3d& matte_albedo,
                                  const std::vector<NeighbourPair>& neighbours,
                                  const AlbedoFitOptions& options);

}  // namespace ibrdf
