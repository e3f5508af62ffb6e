// The image as sets of points: every pixel, or fewer that say nearly as much.
// Internal.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/solvers/costs/log_likelihood.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A set of points with its observations and transport.
struct Level {
  std::vector<ShadingPoint> points;
  Observations observed;
  std::unique_ptr<Transport> transport;  // null until first used
};

// Radiance of the points' pixels, [points * 3].
std::vector<double> RadianceOf(const Image& image,
                               const std::vector<ShadingPoint>& points);

// All of the problem's points.
std::unique_ptr<Level> MakeFullLevel(const InverseProblem& problem);

// Points of like normals joined, bins_across > 0 of the diameter of the disc
// of normals; all pixels where the image has none away from the limb. With
// shadows, which points of like normals do not share, some pixels as they are:
// every so many rows and columns.
std::unique_ptr<Level> MakeBinnedLevel(const InverseProblem& problem,
                                       int bins_across);

// A ninth of the image, of a large one less, as MakeBinnedLevel's and pixel by
// pixel.
struct LevelPair {
  std::unique_ptr<Level> bins, pixels;
};
LevelPair MakeLevelPair(const InverseProblem& problem, int bins_across);

// What joining leaves out of an image: mean |log bin - mean log of its pixels|
// of the radiance [points * 3] that a model gives a pair's points. 0 where it
// gives a pixel none.
double BinningError(const Level& pixels, const std::vector<double>& of_pixels,
                    const std::vector<double>& of_bins, int bins_across);

// One pixel, as it is, of each bin of like normals; all where there is none
// away from the limb.
std::unique_ptr<Level> MakeSampleLevel(const InverseProblem& problem,
                                       int bins_across);

}  // namespace ibrdf
