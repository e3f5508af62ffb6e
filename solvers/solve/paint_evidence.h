// Whether an object is painted, where neither the user nor the look before the
// solve says.
#pragma once
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// Light unknown: whether the image is far more probable of a painted object
// than of one material, both at the search's coarse resolution and with the
// light, and of the former the albedo too, integrated out. Takes some seconds.
bool IsProbablyPainted(const SolveSetup& setup, SolveContext* context);

// Light known: what one material leaves of the image.
struct LeftByOneMaterial {
  double misfit = 0.0;
  // The share of it that mirrored light explains (MirroredShare); 0 where the
  // misfit is small.
  double mirrored = 0.0;
  // The mean share of its radiance that paint would scale; likewise.
  double matte = 0.0;

  bool IsMuch() const;
  // Much is left that nothing but the object can be, and paint would be seen.
  bool MayBePaint() const;
  // Paint leaves much less than one material does.
  bool IsExplainedBy(double painted_misfit) const;
};
LeftByOneMaterial LeftBy(const SolveSetup& setup, const Estimate& one_material,
                         const SolveContext& context);

}  // namespace ibrdf
