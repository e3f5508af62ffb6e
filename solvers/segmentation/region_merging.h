// Regions of like material brought together, while that makes the picture more
// probable.
#pragma once
#include <vector>

#include "ibrdf/solvers/segmentation/material_pixels.h"

namespace ibrdf {

struct MergeSetting {
  double step = 0.12;  // of log radiance, that parts regions (FindRegions)
  int degree = 2;      // of the materials' polynomials (NormalPolynomials)
  // The share of the pixels that counts, in (0, 1]: neighbours are not
  // independent.
  double share = 0.15;
};

// A material for each pixel, from 0; -1: none yet.
struct Labelling {
  std::vector<int> labels;  // [pixels]
  int count = 0;            // of materials
};

// Each material's log colours are a polynomial of the normal with normal noise
// of its own covariance; both are integrated out (normal inverse Wishart). The
// two regions are merged that gain the most evidence, until one is left. What
// is there at `most` materials and fewer, down to 2, the most first; regions of
// a few pixels have none. Fewer where the regions are fewer.
std::vector<Labelling> MergeRegions(const MaterialPixels& pixels,
                                    const MergeSetting& setting, int most);

}  // namespace ibrdf
