// How well a normal map agrees with being the normals of what is seen.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/solvers/photograph_check/normal_hypotheses.h"

namespace ibrdf {

// How a map of normals disagrees with a surface seen by an orthographic camera,
// from 0 (not at all) to 1. The image does not come in: a flip maps normals one
// to one, so it explains the image as well.
struct NormalScore {
  NormalHypothesis hypothesis = NormalHypothesis::kAsGiven;
  // Share of the normals that face away from the camera.
  double away = 0.0;
  // (1 - mean n . o) / 2 over the mask's outline, o pointing out of it in the
  // image: a round surface ends where its normals lie in the image's plane and
  // point outwards. 0.5 where nothing can be said, as for a flat piece. NaN: no
  // outline inside the image.
  double outline = 0.0;
  // Mean |n . curl n| over the mean of its two parts' magnitudes: 0 for the
  // normals of any surface z(x, y) (Frobenius), 1 for one flipped axis. NaN: no
  // curvature.
  double curl = 0.0;
  // Mean of the three, of those that are numbers.
  double disagreement = 0.0;
};

// Hypotheses closer than this are not told apart.
inline constexpr double kToldApart = 0.05;
// Another hypothesis is worth a warning from here on.
inline constexpr double kClearlyBetter = 0.1;

// normals: unit, zero outside. mask: of the object; empty: all.
NormalScore ScoreNormals(const Image& normals, const Mask& mask);

// The hypotheses, the most plausible first; ties as in the enumeration.
// `normals` as UnderHypothesis has them.
std::vector<NormalScore> RankNormalHypotheses(const Image& normals,
                                              const Mask& mask);

}  // namespace ibrdf
