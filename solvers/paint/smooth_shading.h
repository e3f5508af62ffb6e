// The shading of a painted object under natural light, from how pixels of one
// colour and pixels beside each other differ.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/paint/neighbours.h"

namespace ibrdf {

// Radiance [points * 3] of a white matte object, up to a scale of each channel:
// e^s, s of the harmonics of the normal up to degree 2, as irradiance nearly
// has no others (Ramamoorthi and Hanrahan 2001, Sec. 3). Paint is what is left,
// however it runs; but points of one colour, and neighbours, are mostly of one
// paint, and s explains what they differ by, robustly. All ones where too few
// points face the camera.
std::vector<double> SmoothShading(const std::vector<ShadingPoint>& points,
                                  const Observations& observed,
                                  const std::vector<NeighbourPair>& neighbours);

// How many colours a paint has, as Renyi's entropy of log albedo [points * 3]
// over the points that are observed and face the camera: of one colour 0, of n
// equal shares log n.
double ColourEntropy(const std::vector<ShadingPoint>& points,
                     const Observations& observed,
                     const std::vector<double>& log_albedo);

}  // namespace ibrdf
