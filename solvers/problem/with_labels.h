// A problem with labels that were found.
#pragma once
#include <vector>

#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// More materials are not told apart.
inline constexpr int kMostFoundLabels = 5;

// Whether a pixel beside a point's, by side or corner, has another label.
// labels: of each point; image_width > 0.
std::vector<bool> BesideOtherLabels(const std::vector<ShadingPoint>& points,
                                    int image_width,
                                    const std::vector<int>& labels);

// labels: of each of the problem's points, from 0. They are called "1", "2",
// ... Points beside another label are mixed, but for labels of such points
// alone: a found label is a pixel or two off.
InverseProblem WithLabels(InverseProblem problem,
                          const std::vector<int>& labels);

// All that may be found, "1" to kMostFoundLabels, without pixels.
std::vector<MaterialLabel> LabelsToBeFound();

}  // namespace ibrdf
