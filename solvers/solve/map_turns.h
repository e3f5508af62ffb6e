// Whether a known map is read in the wrong frame: of an object of one material.
#pragma once
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/solve/turned_maps.h"

namespace ibrdf {

// Misfits, mean |log L_o - log I|, of simple materials, sums of a Lambertian
// and of microfacet lobes with colours of their own. Takes some tenths of a
// second.
MapTurns FindMapTurns(const SolveSetup& setup);

// Whether these say that the frame is wrong, rather than the materials too
// simple.
bool IsFarBetter(const MapTurns& turns);

}  // namespace ibrdf
