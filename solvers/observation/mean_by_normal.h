// An image as a few synthetic points: what an estimate of the light needs of
// it.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

struct BinMeans {
  std::vector<ShadingPoint> points;  // mean normal and view; pixel of a member
  // Geometric means of radiance and of interval ends. An end is open where a
  // member's is.
  Observations observed;
};

// Joins points of one view, material and like normals, seen along like
// directions: a point of distant light without shadows says no more than these
// two, so that a bin's mean radiance is that of its mean normal but for the
// second order in the bin's size, and the noise of its pixels averages out.
// bins_across > 0: of the diameter of the disc of normals seen along an
// orthographic view. Points at a cosine below min_cosine are left out (at the
// limb a pixel's centre stands badly for its area), as are those that are not
// valid.
BinMeans MeanByNormal(const std::vector<ShadingPoint>& points,
                      const Observations& observed, int bins_across,
                      double min_cosine);

}  // namespace ibrdf
