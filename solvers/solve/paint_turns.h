// Whether a known map is read in the wrong frame: of a painted object.
#pragma once
#include <optional>

#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/solve/turned_maps.h"

namespace ibrdf {

// Places of one paint beside each other differ by their shading alone. Misfits
// are the difference of their log radiance that a matte object's shading under
// a turn leaves, at the third of the pairs that is most alike: sharp edges of
// paint and highlights have no part in it. Empty where too few edges of colour
// are sharp: paint that fades looks like shading, and other turns explain it
// better than the right one does. Takes a tenth of a second.
std::optional<MapTurns> FindPaintTurns(const SolveSetup& setup);

// Whether these say that the frame is wrong.
bool IsBetterOfPaint(const MapTurns& turns);

// Adds to the deviation of the albedo what it would be under the turned map,
// its scale left out.
void DoubtAlbedo(const SolveSetup& setup, const MapTurn& turn,
                 Solution* solution);

}  // namespace ibrdf
