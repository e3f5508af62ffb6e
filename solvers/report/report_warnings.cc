#include "ibrdf/solvers/report/report_warnings.h"

#include <cmath>

#include "ibrdf/solvers/report/json_values.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

// A misfit above this is more than noise and the lobes' limits explain
// (experiments/joint_grid).
constexpr double kLargeMisfit = 0.1;
// Of the time limit: from here on the last stage was cut short.
constexpr double kTimeShare = 0.8;
// Another reflectance counts as an explanation of its own within a factor of
// 20 of the evidence and beyond a tenth in the logarithm.
constexpr double kRivalCost = 3.0;
constexpr double kRivalDifference = 0.1;
// Of the expected error: of joint_grid's cases above it three quarters are off
// by more than 0.6, a quarter of the others.
constexpr double kUncertain = 0.84;

std::string StatusWarning(const std::string& status) {
  if (status == "no_improvement") {
    return "The solver could not improve on its start: what is shown is the "
           "start.";
  }
  if (status == "interrupted") {
    return "The solver was stopped early: what is shown is the best state it "
           "had reached.";
  }
  return status == "ok" ? "" : "The solver ended with status " + status + ".";
}

std::string PixelWarning(const Json& result) {
  const double used = NumberAt(result, "pixels_used");
  const double all = NumberAt(result, "pixels_of_object");
  if (!(used < all)) return "";
  return ShortNumber(all - used) + " of the object's " + ShortNumber(all) +
         " pixels took no part: they are not finite and positive in all three "
         "channels.";
}

std::string UncertainWarning(const Json& result) {
  const double expected =
      NumberAt(MemberAt(result, "posterior"), "brdf_log_rmse_expected");
  if (!(expected > kUncertain)) return "";
  return "This image does not tell the reflectance well: its logarithm is "
         "expected to be off by " +
         ShortNumber(expected) + ", a factor of " +
         ShortNumber(std::exp(expected)) +
         " (root mean square over all angles, after the best scale).";
}

std::string RivalWarning(const Json& result) {
  const Json alternatives =
      MemberAt(MemberAt(result, "posterior"), "alternatives");
  if (!alternatives.is_array()) return "";
  for (const Json& other : alternatives) {
    const double cost = NumberAt(other, "cost_above_best");
    const double difference = NumberAt(other, "brdf_log_difference");
    if (!(cost < kRivalCost && difference > kRivalDifference)) continue;
    return "Another reflectance explains the image nearly as well: the one "
           "found from " +
           TextAt(other, "start") + " has " + ShortNumber(std::exp(-cost)) +
           " of the best one's evidence and differs from the estimate by " +
           ShortNumber(difference) + " in the logarithm.";
  }
  return "";
}

}  // namespace

std::vector<std::string> ResultWarnings(const Json& result) {
  const Json problem = MemberAt(result, "problem");
  const Json metrics = MemberAt(result, "metrics");
  std::vector<std::string> warnings;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) warnings.push_back(text);
  };
  add(StatusWarning(TextAt(result, "status")));
  const double limit = NumberAt(MemberAt(problem, "solver"), "seconds");
  const bool out_of_time = NumberAt(metrics, "seconds") > kTimeShare * limit;
  if (out_of_time) {
    add("The time limit of " + ShortNumber(limit) +
        " s was nearly used up: with more (solver.seconds) the result may "
        "still "
        "change.");
  }
  const double misfit = NumberAt(metrics, "misfit");
  if (!std::isfinite(misfit)) {
    add("The misfit is not a number.");
  } else if (misfit > kLargeMisfit) {
    add("The estimate does not explain the image: its misfit of " +
        ShortNumber(misfit) + " is far above usual noise. " +
        (out_of_time ? "If more time does not help, check" : "Check") +
        " the shape, the mask, the camera, and that the image is linear "
        "radiance.");
  }
  add(PixelWarning(result));
  add(UncertainWarning(result));
  add(RivalWarning(result));
  const std::string effects = TextAt(result, "effects");
  const Json geometry = MemberAt(problem, "geometry");
  if (geometry.is_object() && !geometry.contains("sphere") &&
      effects.compare(0, 4, "none") == 0) {
    add("Effects: " + effects + ".");
  }
  return warnings;
}

}  // namespace ibrdf
