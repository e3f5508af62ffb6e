// A reflectance as a problem file gives it.
#pragma once
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// An analytic BRDF, which is evaluated, or a measured table, which is
// interpolated.
struct KnownBrdf {
  BrdfFunction function;  // empty: the table
  MerlTable table;

  BrdfGrid Grid() const;
  // Either as a function. It must not outlive this.
  BrdfFunction Lookup() const;
};

}  // namespace ibrdf
