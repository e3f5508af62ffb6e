// What photographs say of an object's paint, if their lights are right.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/paint/neighbours.h"

namespace ibrdf {

// A pixel tells its albedo where at least this share of its radiance is matte.
inline constexpr double kLeastMatteShare = 0.05;

// What the unpainted object would show [points * 3]: the radiance of the part
// that paint scales, and the rest.
struct UnpaintedRadiance {
  std::vector<double> matte, gloss;
};

// One photograph of the points, and what they would show in it without paint.
struct PaintedImage {
  const UnpaintedRadiance* unpainted = nullptr;
  const Observations* observed = nullptr;
};

// Log of what paint must do at each point for the image's value.
struct ApparentPaint {
  std::vector<Eigen::Array2d> chroma;
  std::vector<double> luminance;  // 0 where it is not seen
  std::vector<double> seen;       // 1 or 0: mostly gloss, or nothing observed
};

// A step that images have between two points.
struct ApparentStep {
  double luminance = 0.0;
  Eigen::Array2d chroma = Eigen::Array2d::Zero();
  bool seen = false;  // in one image at least
};

// What each image says, at least one and all of the same points; those beside
// the first are moved to its level and hue.
std::vector<ApparentPaint> ApparentPaintsOf(
    const std::vector<PaintedImage>& images);

// What images of one level say together: the median, of an even number the
// upper of the middle two, as an image has shadows that the render has not.
ApparentPaint Together(const std::vector<ApparentPaint>& images);

// The median of the images' steps; of an even number what is nearest to 0
// between the middle two.
ApparentStep StepOf(const std::vector<ApparentPaint>& images,
                    const NeighbourPair& pair);

}  // namespace ibrdf
