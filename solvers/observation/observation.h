// The image as points with radiance: every pixel of the object, or fewer that
// say nearly as much.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

struct Observation {
  std::vector<ShadingPoint> points;
  Observations observed;  // radiance of the points, and which can be used
};

// The points with what the image says of the radiance of their pixels. bounds:
// the ends of its intervals; null: the image is radiance.
Observation Observe(const Image& image, const RadianceBounds* bounds,
                    const std::vector<ShadingPoint>& points);

// One synthetic point for each bin of like normals (MeanByNormal); bins_across
// > 0 bins span the diameter of the disc of normals. All pixels where the image
// has none away from the limb.
Observation MeansByNormal(const Observation& pixels, int bins_across);

// Some 4000 pixels at most as they are, every so many rows and columns of an
// image of this width; all where none of those can be used.
Observation Thin(const Observation& pixels, int image_width);

// One pixel, as it is, of each bin of like normals; all where there is none
// away from the limb.
Observation OnePixelPerBin(const Observation& pixels, int bins_across);

// Some of the pixels that mirror one of `lights` (unit, towards them) to the
// camera: their normals are within `angle`, radians, of the half vector. Of
// many usable ones some 240, spread over them.
Observation Highlights(const Observation& pixels,
                       const std::vector<Eigen::Vector3d>& lights,
                       double angle);

// Those of the first, then those of the second that the first does not have.
Observation Union(const Observation& first, const Observation& second);

// A ninth of the image, or less of a large one, binned and pixel by pixel.
struct ObservationPair {
  Observation bins, pixels;
};
ObservationPair MakePair(const Observation& pixels, int image_width,
                         int bins_across);

// What binning leaves out of an image: mean |log bin - mean log of its pixels|
// of the radiance [points * 3] that a model gives a pair's points. 0 where it
// gives a pixel none.
double BinningError(const Observation& pixels,
                    const std::vector<double>& of_pixels,
                    const std::vector<double>& of_bins, int bins_across);

}  // namespace ibrdf
