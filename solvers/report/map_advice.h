// What to do about a known map that is read in the wrong frame, in words.
#pragma once
#include <optional>
#include <string>

#include "ibrdf/light/map_frame.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// Another frame in which a file that was read in `given` would show what it
// does after the turn; none: no latlong frame but by more than `tolerance`
// degrees.
std::optional<MapFrame> FrameAfter(MapFrame given, const MapTurn& turn,
                                   double tolerance);

// "try illumination.frame: mitsuba, ..."; empty where the map as it is given is
// as plausible as any.
std::string MapTurnAdvice(const SolvedProblem& solved);

}  // namespace ibrdf
