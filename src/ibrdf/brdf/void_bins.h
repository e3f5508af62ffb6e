// Bins of a table that are not to be trusted.
#pragma once
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Marks as invalid, by -1, the bins that have either direction further from the
// normal than this, degrees in (0, 90].
void VoidBeyond(double degrees, MerlTable* table);

}  // namespace ibrdf
