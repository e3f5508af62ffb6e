#include "ibrdf/solvers/report/map_advice.h"

#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr double kTolerance = 6.0;  // degrees, a step of the search

// The turn in words, as seen in a picture of the background.
std::string InWords(const MapTurn& turn) {
  const double left =
      turn.degrees > 180.0 ? turn.degrees - 360.0 : turn.degrees;
  std::string words = turn.mirrored ? "mirrored left to right" : "";
  if (std::abs(left) >= 1.0) {
    words += (words.empty() ? "" : " and ") + std::string("turned by ") +
             Format("%.0f", std::abs(left)) + " degrees to the " +
             (left > 0.0 ? "left" : "right");
  }
  return words;
}

}  // namespace

std::optional<MapFrame> FrameAfter(MapFrame given, const MapTurn& turn,
                                   double tolerance) {
  constexpr MapSize kAnySize = {4, 2};
  const auto latlong = [&](MapFrame frame) {
    return CheckMapSize("", frame, kAnySize).ok()
               ? MapGrid(frame, kAnySize).latlong()
               : std::nullopt;
  };
  const std::optional<MapGrid::LatLong> from = latlong(given);
  if (!from.has_value()) return std::nullopt;
  const double quarters = turn.degrees / 90.0;
  const double whole = std::round(quarters);
  if (90.0 * std::abs(quarters - whole) > tolerance) return std::nullopt;
  if (!turn.mirrored && std::fmod(whole, 4.0) == 0.0) return std::nullopt;
  const int sign = turn.mirrored ? -from->sign : from->sign;
  const int after = (turn.mirrored ? -from->quarters : from->quarters) -
                    static_cast<int>(whole);
  for (const MapFrame frame : kMapFrames) {
    const std::optional<MapGrid::LatLong> to = latlong(frame);
    // A header says openexr by itself.
    if (to.has_value() && !to->nodes && to->sign == sign &&
        (to->quarters - after) % 4 == 0) {
      return frame;
    }
  }
  return std::nullopt;
}

std::string MapTurnAdvice(const SolvedProblem& solved) {
  if (!solved.solution.better_map_turn.has_value()) return "";
  const MapTurn& turn = *solved.solution.better_map_turn;
  const std::optional<MapFrame> frame =
      FrameAfter(solved.inverse.known_map_frame, turn, kTolerance);
  const std::string advice =
      solved.problem.illumination.sky.has_value() ? "check the sky's directions"
      : frame.has_value()
          ? std::string("try illumination.frame: ") + MapFrameName(*frame)
          : "check illumination.frame";
  const bool paint = solved.solution.map_turn_of_paint;
  const std::string by = paint ? "by " : "";
  return advice + ", as " +
         (paint ? "places of like paint differ " : "simple materials leave ") +
         by + Format("%.2g", turn.misfit) + " under the map " + InWords(turn) +
         ", and " + by + Format("%.2g", solved.solution.misfit_of_given_map) +
         " under the map as it is given";
}

}  // namespace ibrdf
