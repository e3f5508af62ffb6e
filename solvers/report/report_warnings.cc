#include "ibrdf/solvers/report/report_warnings.h"

#include <cmath>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/report/light_results.h"
#include "ibrdf/solvers/report/map_advice.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/report/view_results.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

std::string StatusWarning(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return "";
    case StatusCode::kNoImprovement:
      return "The solver could not improve on its initial guess: the result is "
             "that guess.";
    case StatusCode::kInterrupted:
      return "The solver was stopped early: the result is the best state it "
             "had reached.";
    default:
      return "The solver ended with an error.";
  }
}

std::string TimeWarning(const SolvedProblem& solved) {
  if (!IsOutOfTime(solved)) return "";
  return "The time limit of " + ShortNumber(solved.problem.solver.seconds) +
         " s was nearly used up. With more time (solver.seconds) the result "
         "may still change.";
}

std::string MisfitWarning(const SolvedProblem& solved) {
  const double misfit = solved.metrics.misfit;
  if (!std::isfinite(misfit)) return "The misfit is not a number.";
  if (misfit <= kLargeMisfit || solved.solution.better_map_turn.has_value()) {
    return "";
  }
  const std::string found =
      "The estimate does not explain the image: its misfit, the mean absolute "
      "log error, is " +
      Format("%.2g", misfit) + ", far above usual noise. ";
  const MirrorCause cause = CauseInMirror(solved);
  if (cause != MirrorCause::kNone) {
    return found + "Most of it is the light, mirrored more sharply. " +
           (cause == MirrorCause::kMapTakenCoarser
                ? "The map is finer than it is taken: set illumination.width."
                : "No lobe of the models is as sharp as this mirror.");
  }
  return found +
         (IsOutOfTime(solved) ? "If more time does not help, check" : "Check") +
         " the shape, the mask, the camera, and that the image is linear "
         "radiance.";
}

std::string MapFrameWarning(const SolvedProblem& solved) {
  const std::string advice = MapTurnAdvice(solved);
  if (advice.empty()) return "";
  return "The known map may be in another frame: " + advice + ".";
}

// One view that the others contradict.
std::string ViewWarning(const SolvedProblem& solved) {
  const std::vector<ViewMisfit> odd = OddViews(solved.metrics.views);
  if (odd.empty()) return "";
  std::string names;
  for (const ViewMisfit& view : odd) {
    names += (names.empty() ? "" : ", ") + view.name + " (misfit " +
             Format("%.2g", view.misfit) + ")";
  }
  return "The other views contradict " + names +
         ": check its camera and its exposure.";
}

// A photograph under another light that does not fit the first.
std::string PhotographWarning(const SolvedProblem& solved) {
  const std::string odd = OddPhotographs(solved);
  if (odd.empty()) return "";
  return "The albedo does not explain " + odd + " as it explains " +
         solved.problem.image.file +
         ": is it of the same object, from the same place?";
}

// Pixels that the known light reaches and that cannot be used.
std::string PixelWarning(const SolvedProblem& solved) {
  const auto used = static_cast<double>(solved.solution.pixels_used);
  const auto all = static_cast<double>(solved.inverse.points.size());
  const double missing = all - used - solved.inverse.dark.num_unlit;
  if (missing <= 0.0) return "";
  return ShortNumber(missing) + " of the object's " + ShortNumber(all) +
         " pixels took no part: they are not finite and positive in all three "
         "channels.";
}

std::string UnlitWarning(const SolvedProblem& solved) {
  const int unlit = solved.inverse.dark.num_unlit;
  if (unlit == 0) return "";
  return ShortNumber(unlit) + " of the object's " +
         ShortNumber(static_cast<double>(solved.inverse.points.size())) +
         " pixels took no part: the known light does not reach them.";
}

std::string StrayLightWarning(const SolvedProblem& solved) {
  const DarkPixels& dark = solved.inverse.dark;
  const Eigen::Array3d& ambient = solved.solution.ambient;
  if (!(dark.ambient_deviation > 0.0).any()) return "";
  std::string text =
      "Pixels in the known light's shadow are not black: stray light of "
      "radiance " +
      ShortNumber(ambient[0]) + ", " + ShortNumber(ambient[1]) + ", " +
      ShortNumber(ambient[2]) +
      " was estimated for all pixels (illumination.ambient).";
  if (dark.num_below_floor > 0) {
    text += " " + ShortNumber(dark.num_below_floor) +
            " lit pixels hold nothing else, and bound the known light's "
            "radiance from above.";
  }
  return text;
}

std::string FewPixelsWarning(const SolvedProblem& solved) {
  const int64_t used = solved.solution.pixels_used;
  const auto all = static_cast<int64_t>(solved.inverse.points.size());
  if (!TooFewPixels(used, all)) return "";
  return "The estimate tells nothing: it was made from " +
         std::to_string(used) + " of the object's " + std::to_string(all) +
         " pixels.";
}

std::string UncertainWarning(const Solution& solution, bool light_unknown) {
  if (!std::isfinite(solution.spread)) return "";
  const double expected = ExpectError(solution, light_unknown).median;
  if (!(expected > kUncertain)) return "";
  if (expected > kLargestKnownError) {
    return "This image does not determine the reflectance.";
  }
  return "This image does not tell the reflectance well. It is expected to be "
         "off by " +
         ErrorInWords(expected) +
         " (root mean square of its logarithm over all angles" +
         (light_unknown ? ", after the best scale)." : ").");
}

// A curve in words: aces, gamma 0.52 (known to some 10 % at best).
std::string CurveWords(const CurveEstimate& estimate) {
  const ResponseDefinition& curve = estimate.curve;
  std::string words = NameOf(curve.kind);
  if (!curve.parameter) return words;
  words += std::string(", ") + ParameterOf(curve.kind)->name + " " +
           ShortNumber(*curve.parameter);
  if (std::isfinite(estimate.log_parameter_std)) {
    words +=
        " (known to " + ErrorInWords(estimate.log_parameter_std) + " at best)";
  }
  return words;
}

// Pale, plain objects under known light have had another gamma's gloss with
// far more evidence than the true one's.
std::string CurveWarning(const SolvedProblem& solved) {
  const std::vector<CurveEstimate>& curves = solved.solution.curves;
  if (curves.empty()) return "";
  std::string text =
      "The response curve was estimated: " + CurveWords(curves.front()) + ".";
  if (solved.problem.kind != ProblemKind::kIllumination) {
    text +=
        " Another gloss may explain the image by another curve: if the curve "
        "is known, say so (image.response).";
  }
  for (size_t k = 1; k < curves.size(); ++k) {
    if (!(curves[k].cost < kRivalCost)) continue;
    text +=
        " The image's codes do not tell it from " + CurveWords(curves[k]) + ".";
  }
  return text;
}

std::string RivalWarning(const std::vector<Alternative>& alternatives) {
  for (const Alternative& other : alternatives) {
    const double difference = other.difference_from_best;
    if (!(other.cost < kRivalCost && difference > kRivalDifference)) continue;
    return "Several reflectances explain the image nearly as well. The one "
           "found from " +
           other.start + " is " + ProbabilityInWords(other.cost) +
           " as the best one, and its logarithm differs from that one's by " +
           Format("%.2g", difference) + " (root mean square).";
  }
  return "";
}

std::string PaintWarning(const SolvedProblem& solved) {
  if (solved.inverse.variation != ReflectanceVariation::kAuto) return "";
  const bool edges = solved.inverse.look != nullptr &&
                     solved.inverse.look->check.MayBePainted();
  const std::string one_material =
      " Its albedo was taken to vary; for one material set "
      "reflectance.variation: none.";
  if (solved.solution.has_paint()) {
    return edges ? "The object looks painted: its colour has sharp edges, and "
                   "paint explains the image better than mirrored light "
                   "does." +
                       one_material
                 : "One material does not explain the image under the known "
                   "light, and paint does." +
                       one_material +
                       " Then check the light's frame, the shape and the "
                       "curve of the image's values.";
  }
  return edges ? "The object's colour has sharp edges. They were taken for "
                 "what one material mirrors; if it is painted, set "
                 "reflectance.variation: albedo."
               : "";
}

// Labels that were found are a guess: one picture shows what is alike, not what
// is one material.
std::string FoundLabelsWarning(const SolvedProblem& solved) {
  const FoundLabels& found = solved.solution.found_labels;
  if (found.labels.empty()) return "";
  const std::string early =
      found.cut_short ? " The search for labels was cut short." : "";
  const size_t count = solved.inverse.materials.size();
  if (count < 2) {
    return "No labels were found: the object is taken to be of one material." +
           early;
  }
  return "The labels were found in the photograph: " + std::to_string(count) +
         " materials, more probable than " + std::to_string(count - 1) +
         " by " + Format("%.0f", found.gain) +
         " nats. Look at labels.png; where it is wrong, draw "
         "reflectance.labels." +
         early;
}

}  // namespace

std::string EffectsNote(const SolvedProblem& solved) {
  const EffectsPlan& effects = solved.inverse.effects;
  if (solved.problem.geometry.kind == GeometryKind::kSphere ||
      effects.visibility) {
    return "";
  }
  return "Effects: " + Describe(effects) + ".";
}

std::vector<std::string> ResultWarnings(const SolvedProblem& solved) {
  std::vector<std::string> warnings = solved.inverse.warnings;
  warnings.insert(warnings.end(), solved.truth.warnings.begin(),
                  solved.truth.warnings.end());
  for (std::string warning :
       {StatusWarning(solved.solution.status), TimeWarning(solved),
        MisfitWarning(solved), MapFrameWarning(solved), ViewWarning(solved),
        PhotographWarning(solved), PixelWarning(solved), UnlitWarning(solved),
        StrayLightWarning(solved), PaintWarning(solved),
        FoundLabelsWarning(solved), FewPixelsWarning(solved),
        CurveWarning(solved),
        UncertainWarning(solved.solution,
                         !solved.inverse.known_map.has_value()),
        RivalWarning(solved.solution.alternatives)}) {
    if (!warning.empty()) warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace ibrdf
