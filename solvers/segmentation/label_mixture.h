// A material for every pixel: a mixture of regressions whose neighbours are
// drawn to each other.
#pragma once
#include "ibrdf/solvers/segmentation/material_pixels.h"
#include "ibrdf/solvers/segmentation/region_merging.h"

namespace ibrdf {

struct RefinedLabelling {
  Labelling labelling;
  double energy = 0.0;  // lower is better, among labellings of as many
};

// Each material's log colours are a polynomial of degree 2 of the normal with
// noise of Student's t, found by `rounds` of expectation and maximisation from
// `start`; the expectation is a mean field over neighbours. Materials that no
// pixel is left of are dropped.
RefinedLabelling RefineLabels(const MaterialPixels& pixels,
                              const Labelling& start, int rounds);

}  // namespace ibrdf
