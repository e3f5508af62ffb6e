// The grid of the MERL database as columns of the flow's cube.
#pragma once
#include <Eigen/Core>

#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// Bin centres, [theta_h][theta_d * kMerlPhiD + phi_d], the order of a table's
// file. Points below the horizon lie at x_h = 1.
FlowColumns MerlColumns();

// The point of the cube nearest to x whose theta_h is no smaller than that of a
// table's first bins and whose theta_d is no larger than that of its last ones.
// A flow that learned from bin centres is evaluated there: beyond them nothing
// holds it, and log q was found to rise by 8 in the mirror direction and by up
// to 21 at theta_d = 90 degrees (docs/notes/beyond_the_bins.md).
Eigen::Vector3d WithinMerlBins(const Eigen::Vector3d& x);

}  // namespace ibrdf
