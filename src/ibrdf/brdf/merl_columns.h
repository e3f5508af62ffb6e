// The grid of the MERL database as columns of the flow's cube.
#pragma once
#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// Bin centres, [theta_h][theta_d * kMerlPhiD + phi_d], the order of a table's
// file. Points below the horizon lie at x_h = 1.
FlowColumns MerlColumns();

}  // namespace ibrdf
