// How much pixels of like normals differ between places of the object: what no
// single material under one distant light explains, if nothing shadows or
// lights the object from itself.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

// Within this angle, radians, all pixels are seen from one direction.
inline constexpr double kOneDirection = 0.0175;

struct LikeNormalsSpread {
  // Mean absolute deviations, natural logarithm, over the pixels whose normals
  // are seen at several places. The first is the mean over the channels, the
  // second over log R/G and log B/G.
  double log_radiance = 0.0, log_colour = 0.0;
  // Those pixels, and their share of all samples. A convex object shows every
  // normal at one place, where noise and a sharp reflection look alike.
  size_t pixels = 0;
  double share = 0.0;
  // Per point of the list that the samples were made of, at several places or
  // one: the length of its deviation in (log R/G, log B/G); NaN where it is no
  // sample.
  std::vector<float> colour_of_point;

  // The largest angle between two directions from which a view sees the object,
  // radians, at least half of it.
  double view_angle = 0.0;

  // Before a near camera like normals mirror different light: what they differ
  // by may be explained.
  bool HasFloor() const { return view_angle <= kOneDirection; }
  // A floor of the misfit (mean |log L_o - log I| over pixels and channels):
  // the other pixels may be explained without any. 0 where there is none.
  double Floor() const { return HasFloor() ? share * log_radiance : 0.0; }
};

// From this share of the object's size on, the square root of its pixels in
// number, two pixels are at different places.
inline constexpr double kOtherPlace = 0.1;

// Divides the disc of normals into cells of 6 to 12 samples of most alike
// normals. Within each, log radiance is a linear function of the normal, so
// that what normals explain is no spread; deviations from it are scaled for the
// degrees of freedom that it takes. Cells twice as large say how much of the
// deviation is a reflection that changes within a cell; it is taken off.
// `points`: what the samples are of.
LikeNormalsSpread SpreadOfLikeNormals(const std::vector<NormalSample>& samples,
                                      const std::vector<ShadingPoint>& points);

}  // namespace ibrdf
