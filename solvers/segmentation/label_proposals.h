// Where several materials may be, from the photograph alone.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/segmentation/label_mixture.h"

namespace ibrdf {

struct LabelProposalOptions {
  int most_materials = 5;
  size_t most_of_count = 3;  // proposals of as many materials
  int num_threads = 0;
};

// A material of each point, >= 0.
struct LabelProposal {
  std::vector<int> labels;  // [points]
  int count = 0;            // of materials, at least 2
  double energy = 0.0;      // RefineLabels', among proposals of as many
};

// Labels of 2 to most_materials materials, by their number and then by energy,
// those of lowest energy of each number. Any two differ by more than a few
// pixels, however their labels are called. Labels are in order of their pixels,
// the most first. Points that tell nothing have their neighbours' labels. Empty
// where nothing parts the object, or no pixel can be used.
//
// Before its light is known, what one material's log radiance is of the normal
// is smooth. Regions without sharp steps are merged by evidence in several
// ways (MergeRegions), then pixels choose (RefineLabels). Large images are
// looked at in blocks first.
std::vector<LabelProposal> ProposeLabels(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    int image_width, const LabelProposalOptions& options);

}  // namespace ibrdf
