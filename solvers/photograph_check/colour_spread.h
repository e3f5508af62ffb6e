// Paint or light: the colours of pixels that have the same normal and lie far
// apart.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

// Under distant light and without shadows, pixels of one material that have the
// same normal have the same colour. Light from the object to itself moves
// colours along the material's own: a bounce multiplies by it. So deviations
// count in full across the object's median colour, in the plane of log R/G and
// log B/G, and along it beyond what bounces can do.
//
// Standard deviations, natural logarithm, from mean absolute differences.
struct ColourDeviation {
  double across = 0.0, along = 0.0;
};

struct ColourSpread {
  // Pixels with a partner of like normal (2 degrees, where they face the
  // camera) at another place (kOtherPlace), over all. A convex object shows
  // every normal once and has none.
  double share = 0.0;
  size_t pairs = 0;
  Eigen::Vector2d own = Eigen::Vector2d::Zero();  // median (log R/G, log B/G)
  ColourDeviation far;                            // of these pairs
  ColourDeviation near;  // of like normals side by side: noise, mostly
  // sqrt(far^2 - near^2) across, or along less a quarter of |own|, the larger;
  // at least 0. A quarter: light that was bounced once changes in share from
  // pixel to pixel by no more.
  double excess = 0.0;

  // Enough pairs of both kinds to say something.
  bool observable = false;
};

// From here on ColourSpread::excess means paint. A difference of 4 % between
// two channels is what an eye begins to see. Bounces, normals off by some
// degrees and masks off by a pixel stay below it
// (experiments/photograph_check).
inline constexpr double kSeveralMaterials = 0.04;

ColourSpread SpreadOfColours(const std::vector<NormalSample>& samples);

bool SaysSeveralMaterials(const ColourSpread& spread);

}  // namespace ibrdf
