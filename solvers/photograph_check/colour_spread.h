// Paint or light: the colours of pixels that have the same normal and lie far
// apart.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

// Under distant light and without shadows, pixels of one material that have the
// same normal have the same colour. Light from the object to itself moves
// colours along the material's own: each bounce multiplies by it. So deviations
// are taken across the object's median colour, in the plane of log R/G and log
// B/G.
//
// Standard deviations, natural logarithm, from mean absolute differences.
struct ColourSpread {
  // Pixels with a partner of like normal (2 degrees, where they face the
  // camera) that lies a tenth of the object's size away or more, over all. A
  // convex object shows every normal once and has none.
  double share = 0.0;
  size_t pairs = 0;
  Eigen::Vector2d own = Eigen::Vector2d::Zero();  // median (log R/G, log B/G)
  double far = 0.0;   // of these pairs, across `own`
  double near = 0.0;  // of pairs of like normals side by side: noise, mostly
  // sqrt(far^2 - near^2), 0 where that is no number.
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
