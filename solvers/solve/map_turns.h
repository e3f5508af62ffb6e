// Whether a known map is read in the wrong frame.
#pragma once
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// A latlong map of the library's frame, mirrored in the plane x = 0 and then
// turned about +y by `columns` of its width: what was at +z comes to +x after a
// quarter of them.
Image Turned(const Image& map, bool mirrored, int columns);

// What simple materials, sums of a Lambertian and of microfacet lobes with
// colours of their own, leave of an image under each turn of a known map.
struct MapTurns {
  double as_given = 0.0;  // misfit, mean |log L_o - log I|
  MapTurn best;           // of all turns

  // Whether the frame is wrong, rather than the materials too simple.
  bool IsFarBetter() const;
};

// In steps of 360 / 64 degrees, and no finer than the map; light from no
// direction but the map's, without bounces. Takes some tenths of a second.
MapTurns FindMapTurns(const SolveSetup& setup);

}  // namespace ibrdf
