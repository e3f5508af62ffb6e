// Any BRDF as a table on the MERL grid.
#pragma once
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Samples at the bin centres; bins below the horizon hold -1 as in measured
// tables.
MerlTable SampleMerl(const BrdfFunction& brdf);

}  // namespace ibrdf
