// From where on a number is worth a warning.
#pragma once
#include <cstdint>

#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// A misfit above this is more than noise and the lobes' limits explain
// (experiments/joint_grid).
inline constexpr double kLargeMisfit = 0.1;
// Whether the last stage was cut short: from this share of the limit on.
inline bool IsOutOfTime(const SolvedProblem& solved) {
  constexpr double kTimeShare = 0.8;
  return solved.metrics.seconds > kTimeShare * solved.problem.solver.seconds;
}
// Another reflectance counts as an explanation of its own within a factor of
// 20 of the evidence and beyond a tenth in the logarithm.
inline constexpr double kRivalCost = 3.0;
inline constexpr double kRivalDifference = 0.1;
// Expected error: of joint_grid's cases above it three quarters are off by more
// than 0.6, a quarter of the others.
inline constexpr double kUncertain = 0.84;

// What leaves the misfit of an object that mirrors known light.
enum class MirrorCause { kNone, kMapTakenCoarser, kNoLobeAsSharp };
inline MirrorCause CauseInMirror(const SolvedProblem& solved) {
  constexpr double kMostlyMirrored = 0.5;
  const InverseProblem& inverse = solved.inverse;
  if (!(solved.metrics.misfit > kLargeMisfit) ||
      !(solved.solution.mirrored_share > kMostlyMirrored)) {
    return MirrorCause::kNone;
  }
  return inverse.fine_known_map != nullptr &&
                 inverse.fine_known_map->width > inverse.map_width
             ? MirrorCause::kMapTakenCoarser
             : MirrorCause::kNoLobeAsSharp;
}

// Whether so few of the object's pixels took part that an estimate from them
// tells nothing: two lobes alone have about as many numbers, and a fiftieth of
// an object shows hardly any of its normals.
inline bool TooFewPixels(int64_t used, int64_t of_object) {
  constexpr int64_t kFewPixels = 20, kFewOf = 50;
  return used < kFewPixels || kFewOf * used < of_object;
}

}  // namespace ibrdf
