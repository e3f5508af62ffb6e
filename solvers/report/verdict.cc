#include "ibrdf/solvers/report/verdict.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/report/map_advice.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

// Expected errors, natural logarithm, up to which something is known well and
// fairly: 30 %, and the error from which on a warning is given.
constexpr double kGoodError = 0.3;
constexpr double kFairError = kUncertain;
// An eye sees a difference of hue of 4 %; twice that is fair.
constexpr double kGoodHue = 0.1, kFairHue = 0.3;
// The hue's error (root mean square of log ratios of two channels) where the
// light's mean radiance was taken for grey or for 1, in the median of
// experiments/gauge. Maps for training deviate from grey by 0.11.
constexpr double kGreyLightHueError = 0.2;
// A misfit that is hardly an explanation at all.
constexpr double kHugeMisfit = 0.3;
// A misfit that is worth a word where its reason is known.
constexpr double kMisfitWord = 0.05;
// A structured misfit above which more than half of held-out reflectances were
// off by 0.6 (docs/notes/posterior_is_overconfident.md).
constexpr double kUnexplained = 0.02;
// A floor explains a misfit from this share of it on.
constexpr double kFloorShare = 0.5;
// Clipped shares of the object: worth a word, and a loss of trust in what
// highlights tell.
constexpr double kClippedWord = 0.01, kClippedDoubt = 0.05;

double ClippedShare(const VerdictNumbers& n) {
  return n.object_pixels > 0 ? static_cast<double>(n.clipped_pixels) /
                                   static_cast<double>(n.object_pixels)
                             : 0.0;
}

// What is left in log albedo, after the best scale, of photographed objects: of
// one under a lamp, in the mean over both lamps of six objects; of those under
// several (experiments/painted). Under known light, of a ball
// (docs/notes/paint.md).
constexpr double kPaintErrorOfOneLight = 0.29;
constexpr double kPaintErrorOfSeveral = 0.18;
constexpr double kPaintErrorUnderKnownLight = 0.1;
// So many lights tell shadows from paint: a shadow is in less than half of
// them.
constexpr size_t kSeveralLights = 3;

// Whether there is no estimate to speak of.
bool TellsNothing(const VerdictNumbers& n) {
  return (n.status != StatusCode::kOk &&
          n.status != StatusCode::kInterrupted) ||
         !std::isfinite(n.misfit) ||
         TooFewPixels(n.used_pixels, n.object_pixels);
}

bool FloorExplains(const VerdictNumbers& n) {
  return n.floor >= kFloorShare * n.misfit;
}

// And like normals do not say why.
bool LeavesMoreThanNoise(const VerdictNumbers& n) {
  return n.structured_misfit > kUnexplained && !FloorExplains(n);
}

Trust Lower(Trust trust, int levels) {
  if (trust == Trust::kKnown) return trust;
  const int lowest = static_cast<int>(Trust::kNotDetermined);
  return static_cast<Trust>(std::min(static_cast<int>(trust) + levels, lowest));
}

// An error that was not found says no more than that the image is explained.
Trust Rate(double error, double good, double fair) {
  if (!std::isfinite(error)) return Trust::kFair;
  return error <= good                 ? Trust::kGood
         : error <= fair               ? Trust::kFair
         : error <= kLargestKnownError ? Trust::kPoor
                                       : Trust::kNotDetermined;
}

// What an image that is not explained, or by a map in a wrong frame, takes from
// all that was found in it.
int LevelsLost(const VerdictNumbers& n) {
  if (!n.map_advice.empty()) return 2;
  return n.misfit > kHugeMisfit ? 2 : n.misfit > kLargeMisfit ? 1 : 0;
}

// Under known light a test ball's gloss has the right energy to 3 %
// (docs/notes/paint.md).
bool PaintMayBeGloss(const VerdictNumbers& n) {
  return n.has_paint && n.kind == ProblemKind::kJoint;
}

// What one light leaves unexplained may be in the paint; a median of several
// lights leaves it out.
Trust RatePaint(const VerdictNumbers& n) {
  if (TellsNothing(n)) return Trust::kNotDetermined;
  if (n.num_lights >= kSeveralLights) {
    return Rate(kPaintErrorOfSeveral, kGoodError, kFairError);
  }
  const bool known = n.kind == ProblemKind::kReflectance;
  return Lower(Rate(known ? kPaintErrorUnderKnownLight : kPaintErrorOfOneLight,
                    kGoodError, kFairError),
               LevelsLost(n) + (known ? 0 : 1) + (n.paint_by_misfit ? 1 : 0));
}

TrustRatings RatingsOf(const VerdictNumbers& n) {
  TrustRatings ratings;
  if (n.has_paint) ratings.paint = RatePaint(n);
  if (!TellsNothing(n)) {
    const int lost = LevelsLost(n);
    const int clipped = ClippedShare(n) > kClippedDoubt ? 1 : 0;
    // Paint comes out as mirrored light.
    const int painted = n.several_materials ? 2 : 0;
    const int rival = n.rival_difference > kRivalDifference ? 1 : 0;
    // The energy of gloss is off by up to 3.3 times (experiments/painted).
    const int under_paint = PaintMayBeGloss(n) ? 1 : 0;
    ratings.light = Lower(Rate(n.light_error, kGoodError, kFairError),
                          lost + clipped + painted);
    ratings.gloss = Lower(Rate(n.reflectance_error, kGoodError, kFairError),
                          lost + clipped + painted + rival + under_paint);
    ratings.hue = Lower(Rate(n.hue_error, kGoodHue, kFairHue), lost + painted);
    ratings.level = Lower(Rate(n.level_error, kGoodError, kFairError), lost);
    if (n.kind == ProblemKind::kJoint) {
      // The image holds products of light and reflectance alone.
      ratings.hue = std::max(ratings.hue, Trust::kFair);
      ratings.level = Trust::kNotDetermined;
    }
  }
  if (n.kind == ProblemKind::kReflectance) ratings.light = Trust::kKnown;
  if (n.kind == ProblemKind::kIllumination) {
    ratings.hue = ratings.gloss = ratings.level = Trust::kKnown;
  }
  return ratings;
}

struct Rated {
  const char* name;
  Trust trust;
};

std::vector<Rated> ListRatings(const TrustRatings& r) {
  std::vector<Rated> all = {{"the light's directions", r.light},
                            {"the object's hue", r.hue},
                            {"the object's gloss", r.gloss},
                            {"the object's brightness (albedo)", r.level}};
  if (r.paint) all.insert(all.begin(), {"the object's paint", *r.paint});
  return all;
}

std::string Capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] -= 'a' - 'A';
  return text;
}

// "a, b and c"; empty: none has one of these ratings.
std::string NamesRated(const std::vector<Rated>& all,
                       const std::vector<Trust>& trusts) {
  std::vector<std::string> names;
  for (const Rated& rated : all) {
    for (const Trust trust : trusts) {
      if (rated.trust == trust) names.emplace_back(rated.name);
    }
  }
  std::string text;
  for (size_t k = 0; k < names.size(); ++k) {
    if (k > 0) text += k + 1 < names.size() ? ", " : " and ";
    text += names[k];
  }
  return text;
}

std::string TrustSentence(const VerdictNumbers& n,
                          const TrustRatings& ratings) {
  const std::vector<Rated> all = ListRatings(ratings);
  const std::string good = NamesRated(all, {Trust::kGood});
  const std::string fair = NamesRated(all, {Trust::kFair});
  if (good.empty() && fair.empty()) {
    return "Nothing that was estimated can be trusted.";
  }
  std::string text = good.empty() ? "" : "Trust " + good;
  if (!fair.empty()) {
    text += (good.empty() ? "Trust, with care, " : "; with care, ") + fair;
  }
  const bool gloss =
      ratings.gloss == Trust::kGood || ratings.gloss == Trust::kFair;
  if (gloss && std::isfinite(n.reflectance_error)) {
    text += ": the reflectance is expected to be off by " +
            ErrorInWords(n.reflectance_error) +
            (n.kind == ProblemKind::kJoint ? ", its scale left out" : "");
  } else if (n.kind == ProblemKind::kIllumination &&
             std::isfinite(n.light_error)) {
    text += ": half of the light is known to " + ErrorInWords(n.light_error);
  }
  return text + ".";
}

std::string FewPixels(const VerdictNumbers& n) {
  if (n.used_pixels == n.object_pixels) {
    return "the object has only " + std::to_string(n.object_pixels) +
           (n.object_pixels == 1 ? " pixel" : " pixels");
  }
  return "only " + std::to_string(n.used_pixels) + " of the object's " +
         std::to_string(n.object_pixels) + " pixels can be used";
}

std::string MisfitReason(const VerdictNumbers& n) {
  const std::string misfit = "the misfit of " + Format("%.2f", n.misfit);
  if (n.mirror != MirrorCause::kNone) {
    return misfit + " is mostly light, mirrored more sharply than in the " +
           "estimate";
  }
  if (!FloorExplains(n)) return misfit + " is far above noise";
  return "one material in distant light cannot explain " +
         Format("%.2f", std::min(n.floor, n.misfit)) + " of " + misfit +
         ", as pixels of like normals differ by that much";
}

// Why there is no estimate to speak of.
std::vector<std::string> ReasonsForNothing(const VerdictNumbers& n) {
  std::vector<std::string> reasons;
  if (TooFewPixels(n.used_pixels, n.object_pixels)) {
    reasons.push_back(FewPixels(n));
  }
  if (n.status == StatusCode::kNoImprovement) {
    reasons.emplace_back(
        "the solver found nothing better than its first guess");
  } else if (!std::isfinite(n.misfit)) {
    reasons.emplace_back("the misfit is not a number");
  } else if (reasons.empty()) {
    reasons.emplace_back("the solver ended with an error");
  }
  return reasons;
}

std::vector<std::string> Reasons(const VerdictNumbers& n) {
  if (TellsNothing(n)) return ReasonsForNothing(n);
  std::vector<std::string> reasons;
  if (!n.map_advice.empty()) {
    reasons.emplace_back("the known map may be in another frame");
  }
  if (n.misfit > kLargeMisfit || (n.misfit > kMisfitWord && FloorExplains(n))) {
    reasons.push_back(MisfitReason(n));
  }
  if (n.several_materials) {
    reasons.emplace_back(
        "the object looks painted or of several materials, and paint is taken "
        "for light");
  }
  if (PaintMayBeGloss(n)) {
    reasons.emplace_back("paint and broad gloss explain each other");
  }
  if (n.paint_by_misfit) {
    reasons.emplace_back(
        "what no single material explains is taken for paint, and a wrong "
        "curve, light or shape looks the same");
  }
  if (ClippedShare(n) > kClippedWord) {
    reasons.push_back(Format("%.0f", 100.0 * ClippedShare(n)) +
                      " % of the object is clipped");
  }
  if (n.rival_difference > kRivalDifference) {
    reasons.emplace_back("another reflectance explains the image as well");
  } else if (LeavesMoreThanNoise(n)) {
    reasons.emplace_back("what the estimate leaves of the image is not noise");
  } else if (n.reflectance_error > kUncertain) {
    reasons.emplace_back("many reflectances explain this image");
  }
  if (n.light_error > kFairError) {
    reasons.emplace_back(
        "so rough a surface tells little of where light comes from");
  }
  if (n.status == StatusCode::kInterrupted) {
    reasons.emplace_back("the solver was stopped early");
  } else if (n.out_of_time) {
    reasons.emplace_back("the time was used up");
  }
  if (n.kind == ProblemKind::kJoint) {
    reasons.emplace_back(
        "the scale between light and reflectance is not in the image, and an "
        "assumption divides the hue between them");
  }
  return reasons;
}

std::string DoubtSentence(const VerdictNumbers& n,
                          const TrustRatings& ratings) {
  const std::string names =
      NamesRated(ListRatings(ratings), {Trust::kPoor, Trust::kNotDetermined});
  const std::vector<std::string> reasons = Reasons(n);
  std::string why;
  for (const std::string& reason : reasons) {
    why += (why.empty() ? "" : "; ") + reason;
  }
  if (names.empty()) {
    return why.empty() ? "Nothing stands against it." : Capitalised(why) + ".";
  }
  return "Do not trust " + names + (why.empty() ? "" : ": " + why) + ".";
}

// The first of these that applies would help most.
std::string NextSentence(const VerdictNumbers& n) {
  if (TooFewPixels(n.used_pixels, n.object_pixels)) {
    return "Next, see in check.png why so few pixels can be used, and take a "
           "picture with the object larger and better exposed.";
  }
  if (!n.normals_advice.empty()) {
    return "Next, check the frame of the normals: " + n.normals_advice + ".";
  }
  if (!n.map_advice.empty()) return "Next, " + n.map_advice + ".";
  if (TellsNothing(n)) {
    return "Next, check in check.png that shape, mask and image belong "
           "together.";
  }
  const bool misfit = n.misfit > kLargeMisfit;
  if (n.mirror == MirrorCause::kMapTakenCoarser) {
    return "Next, take the known light as fine as it is: --set "
           "illumination.width=...";
  }
  if (n.mirror == MirrorCause::kNoLobeAsSharp) {
    return "Next, take the object for a sharper mirror than the estimate: no "
           "lobe of the models is as sharp.";
  }
  if (n.several_materials || (misfit && FloorExplains(n))) {
    return "Next, mask one material alone, without shadows of other parts.";
  }
  if (ClippedShare(n) > kClippedDoubt) {
    return "Next, take a shorter exposure or an HDR image, as clipped "
           "highlights hide the lamps.";
  }
  if (PaintMayBeGloss(n) && n.num_photographs == 1) {
    return "Next, leave camera and object, move the lamp, and give three or "
           "four "
           "photographs at once: paint is what they share.";
  }
  if (misfit && !n.has_mask) return "Next, give a mask of the object.";
  if (n.out_of_time) return "Next, give it more time: --set solver.seconds=...";
  if (misfit || n.paint_by_misfit) {
    return "Next, check the shape, the mask, the camera and the curve of the "
           "image's values (--response).";
  }
  if (n.may_search_wider && LeavesMoreThanNoise(n)) {
    return "Next, search wider for the gloss: --set solver.search=thorough "
           "--set solver.seconds=300.";
  }
  if (n.kind == ProblemKind::kJoint) {
    return "Next, for brightness and hue give the light where you can measure "
           "it (--known-light), as with a mirror ball.";
  }
  return "Next, nothing is needed: compare input and render in the report.";
}

// Covariance of the log of the lobes' summed colours, to first order; NaN where
// the lobes' is not known. With exponent 1 the lobes' shapes have one integral,
// so that colours say which lobe counts in a channel.
Eigen::Matrix3d CovarianceOfLogColour(const InverseProblem& inverse,
                                      const Solution& solution) {
  const size_t size = solution.lobe_parameters.size();
  if (size == 0 || solution.lobe_covariance.size() != size * size) {
    return Eigen::Matrix3d::Constant(VerdictNumbers::kNone);
  }
  const LobeLayout layout =
      LobeLayout::OfSize(size, inverse.model->shape.code_size());
  const LobeMixture lobes(layout, solution.lobe_parameters.data());
  const Eigen::Array3Xd colours = lobes.RawColours();
  const Eigen::Array3d sums = colours.rowwise().sum();
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(3, layout.num_parameters());
  for (int k = 0; k < layout.num_lobes; ++k) {
    for (int c = 0; c < 3; ++c) {
      slopes(c, layout.log_colour(k) + c) = colours(c, k) / sums[c];
    }
  }
  const auto side = static_cast<Eigen::Index>(size);
  const Eigen::Map<const Eigen::MatrixXd> covariance(
      solution.lobe_covariance.data(), side, side);
  return slopes * covariance * slopes.transpose();
}

void FindColourErrors(const SolvedProblem& solved, VerdictNumbers* n) {
  const Eigen::Matrix3d covariance =
      CovarianceOfLogColour(solved.inverse, solved.solution);
  const double level = covariance.sum() / 9.0;  // of the mean over channels
  // The mean over the three ratios of two channels.
  const double hue = (3.0 * covariance.trace() - covariance.sum()) / 3.0;
  // Posteriors are too sure, see ExpectError; a negative variance is NaN.
  n->level_error = ExpectError(std::sqrt(level)).median;
  n->hue_error = ExpectError(std::sqrt(hue)).median;
  // The gauge sets the hue, in spite of the posterior.
  if (n->kind == ProblemKind::kJoint &&
      solved.problem.solver.gauge != SolverGauge::kPrior) {
    n->hue_error = kGreyLightHueError;
  }
}

// The deviation (mean of the channels, at a resolution of its own) that half of
// the map's light stays below; NaN where there is none.
double MedianOverLight(const Image& map, const Image& deviation) {
  if (map.empty() || deviation.empty()) return VerdictNumbers::kNone;
  struct Texel {
    double deviation, light;
  };
  std::vector<Texel> texels;
  double all = 0.0;
  for (int y = 0; y < map.height; ++y) {
    const double solid_angle = TexelSolidAngle(y, map.height, map.width);
    for (int x = 0; x < map.width; ++x) {
      const float* L = map.At(x, y);
      const float* d = deviation.At(x * deviation.width / map.width,
                                    y * deviation.height / map.height);
      const double light = solid_angle * (double{L[0]} + L[1] + L[2]);
      const double value = (double{d[0]} + d[1] + d[2]) / 3.0;
      if (!std::isfinite(value) || !std::isfinite(light)) continue;
      texels.push_back({value, light});
      all += light;
    }
  }
  std::sort(texels.begin(), texels.end(), [](const Texel& a, const Texel& b) {
    return a.deviation < b.deviation;
  });
  double below = 0.0;
  for (const Texel& texel : texels) {
    below += texel.light;
    if (2.0 * below >= all) return texel.deviation;
  }
  return VerdictNumbers::kNone;
}

bool IsPaintByMisfit(const SolvedProblem& solved) {
  const Problem& problem = solved.problem;
  if (problem.kind != ProblemKind::kReflectance ||
      problem.reflectance.variation != ReflectanceVariation::kAuto ||
      solved.inverse.look == nullptr) {
    return false;
  }
  const PhotographCheck& check = solved.inverse.look->check;
  return !check.SeveralMaterials() && !check.MayBePainted();
}

void TakeLook(const PhotographCheck& check, VerdictNumbers* n) {
  n->floor = check.like_normals.Floor();
  n->several_materials = check.SeveralMaterials();
  n->has_mask = check.has_mask;
  n->clipped_pixels = static_cast<int64_t>(check.counts.clipped);
  if (const NormalScore* better = check.BetterNormals()) {
    n->normals_advice = AdviceFor(better->hypothesis);
  }
}

}  // namespace

const char* NameOf(Trust trust) {
  switch (trust) {
    case Trust::kKnown:
      return "known";
    case Trust::kGood:
      return "good";
    case Trust::kFair:
      return "fair";
    case Trust::kPoor:
      return "poor";
    case Trust::kNotDetermined:
      break;
  }
  return "not determined";
}

VerdictNumbers NumbersForVerdict(const SolvedProblem& solved) {
  const Solution& solution = solved.solution;
  VerdictNumbers n;
  n.kind = solved.problem.kind;
  n.status = solution.status.code();
  n.out_of_time = IsOutOfTime(solved);
  n.misfit = solved.metrics.misfit;
  n.mirror = CauseInMirror(solved);
  n.object_pixels = static_cast<int64_t>(solved.inverse.points.size());
  n.used_pixels = solution.pixels_used;
  if (solved.inverse.look != nullptr) TakeLook(solved.inverse.look->check, &n);
  n.has_paint = solution.has_paint();
  n.paint_by_misfit = n.has_paint && IsPaintByMisfit(solved);
  n.map_advice = MapTurnAdvice(solved);
  n.num_photographs = std::max<size_t>(solved.inverse.sheet.views.size(), 1) +
                      solved.inverse.other_photographs.size();
  n.num_lights = 1 + solution.other_lights.size();
  // What is sought is not taken for light.
  if (solution.has_paint() || solution.materials.size() > 1) {
    n.several_materials = false;
    n.floor = 0.0;
  }
  if (std::isfinite(solution.spread)) {
    n.reflectance_error =
        ExpectError(solution, !solved.inverse.known_map.has_value()).median;
  }
  FindColourErrors(solved, &n);
  n.structured_misfit = solution.structured_misfit;
  const SolverSpec& solver = solved.problem.solver;
  n.may_search_wider = n.kind == ProblemKind::kJoint && !n.has_paint &&
                       solution.materials.size() < 2 &&
                       solver.estimator == SolverEstimator::kMarginal &&
                       solver.search != SolverSearch::kThorough;
  for (const Alternative& other : solution.alternatives) {
    if (other.cost < kRivalCost) {
      n.rival_difference =
          std::max(n.rival_difference, other.difference_from_best);
    }
  }
  n.light_error = MedianOverLight(solution.map, solution.map_std);
  return n;
}

Verdict MakeVerdict(const VerdictNumbers& numbers) {
  Verdict verdict;
  verdict.ratings = RatingsOf(numbers);
  verdict.trust = TrustSentence(numbers, verdict.ratings);
  verdict.doubt = DoubtSentence(numbers, verdict.ratings);
  verdict.next = NextSentence(numbers);
  return verdict;
}

Verdict MakeVerdict(const SolvedProblem& solved) {
  return MakeVerdict(NumbersForVerdict(solved));
}

}  // namespace ibrdf
