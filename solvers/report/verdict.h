// Whether to trust a result: three plain sentences made from its numbers.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// How well something is known, the best first.
enum class Trust { kKnown, kGood, kFair, kPoor, kNotDetermined };

// "known", "good", "fair", "poor", "not determined".
const char* NameOf(Trust trust);

struct TrustRatings {
  Trust light = Trust::kNotDetermined;  // its directions
  Trust hue = Trust::kNotDetermined;    // of the reflectance
  Trust gloss = Trust::kNotDetermined;  // the reflectance's shape over angles
  Trust level = Trust::kNotDetermined;  // the reflectance's scale: albedo
  // How the albedo varies, after the best scale; unset: no paint was sought.
  std::optional<Trust> paint;
};

struct Verdict {
  std::string trust;  // what can be trusted
  std::string doubt;  // what cannot, and why
  std::string next;   // the most useful thing to do
  TrustRatings ratings;

  std::vector<std::string> Sentences() const { return {trust, doubt, next}; }
};

// What a verdict is made from. A NaN is a number that was not found.
struct VerdictNumbers {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  ProblemKind kind = ProblemKind::kJoint;
  StatusCode status = StatusCode::kOk;
  bool out_of_time = false;
  double misfit = kNone;  // mean |log L_o - log I|
  double floor = 0.0;     // what like normals leave of it for any one material
  MirrorCause mirror = MirrorCause::kNone;
  bool several_materials = false;  // as colours of like normals say
  bool has_paint = false;          // that was estimated
  // Nothing else asked for it than what one material leaves under known light.
  bool paint_by_misfit = false;
  size_t num_photographs = 1;  // views or lights
  size_t num_lights = 1;       // of one view
  bool has_mask = true;
  std::string map_advice;      // where another frame of the known map would be
  std::string normals_advice;  // where other normals would be more plausible
  int64_t object_pixels = 0, used_pixels = 0, clipped_pixels = 0;
  // Errors to expect, natural logarithm: of the reflectance after the best
  // scale; of its hue (ratios of channels) and of its level, given the gauge.
  double reflectance_error = kNone, hue_error = kNone, level_error = kNone;
  // The difference from the best reflectance of another one with a like
  // evidence; 0: there is none.
  double rival_difference = 0.0;
  double structured_misfit = kNone;  // as MaterialSolution has it
  bool may_search_wider = false;  // solver.search: thorough was not asked for
  // Standard deviation of log radiance that half of the light stays below.
  double light_error = kNone;
};

VerdictNumbers NumbersForVerdict(const SolvedProblem& solved);

Verdict MakeVerdict(const VerdictNumbers& numbers);
Verdict MakeVerdict(const SolvedProblem& solved);

}  // namespace ibrdf
