// Omission errors of the effects of a known scene, by rendering a few points.
#pragma once
#include <vector>

#include "ibrdf/render/scene_probe.h"
#include "ibrdf/solvers/forward/scene_radiance.h"

namespace ibrdf {

// As PredictEffects, for light and reflectance as they are: `bare` simulates no
// effect, `all` shadows and kMostBounces. Slower: for lobes so narrow that
// patches do not tell what they show of the object (kNarrowLobe). Leaves `all`
// with as many bounces as it had.
OmissionErrors MeasureEffects(const SceneRadiance& bare,
                              const std::vector<ShadingPoint>& points,
                              SceneRadiance* all);

// Doubles the rays along which narrow lobes see the object, up to those of
// reference quality, where that changes the points' log radiance by more than
// `log_error` in the mean; returns by how much it last did.
double ChooseLobeRays(const std::vector<ShadingPoint>& points, double log_error,
                      SceneRadiance* all);

}  // namespace ibrdf
