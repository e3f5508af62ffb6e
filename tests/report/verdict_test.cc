#include "ibrdf/solvers/report/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"
#include "tests/report/contains.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

constexpr double kNone = VerdictNumbers::kNone;

// A joint problem that went well.
VerdictNumbers Good() {
  VerdictNumbers n;
  n.misfit = 0.02;
  n.floor = 0.01;
  n.object_pixels = n.used_pixels = 10000;
  n.reflectance_error = n.hue_error = n.level_error = n.light_error = 0.08;
  return n;
}

TEST(Verdict, AGoodJointEstimateLacksItsScale) {
  const Verdict v = MakeVerdict(Good());
  EXPECT_EQ(
      "Trust the light's directions and the object's gloss; with care, the "
      "object's hue: the reflectance is expected to be off by some 8 %, its "
      "scale left "
      "out.",
      v.trust);
  EXPECT_EQ(
      "Do not trust the object's brightness (albedo): the scale between "
      "light and reflectance is not in the image, and an assumption divides "
      "the hue "
      "between them.",
      v.doubt);
  EXPECT_TRUE(Contains(v.next, "--known-light")) << v.next;
  EXPECT_EQ(Trust::kGood, v.ratings.light);
  EXPECT_EQ(Trust::kFair, v.ratings.hue);
  EXPECT_EQ(Trust::kGood, v.ratings.gloss);
  EXPECT_EQ(Trust::kNotDetermined, v.ratings.level);
}

TEST(Verdict, KnownLightTellsTheScale) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kReflectance;
  n.light_error = kNone;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kKnown, v.ratings.light);
  EXPECT_EQ(Trust::kGood, v.ratings.hue);
  EXPECT_EQ(Trust::kGood, v.ratings.level);
  EXPECT_EQ("Nothing stands against it.", v.doubt);
  EXPECT_FALSE(Contains(v.trust, "scale")) << v.trust;
  EXPECT_TRUE(Contains(v.next, "nothing is needed")) << v.next;
}

TEST(Verdict, KnownReflectanceTellsOfTheLightAlone) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kIllumination;
  n.reflectance_error = kNone;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kKnown, v.ratings.gloss);
  EXPECT_EQ(
      "Trust the light's directions: half of the light is known to some 8 %.",
      v.trust);
}

TEST(Verdict, PaintIsTheReasonOfAMisfit) {
  VerdictNumbers n = Good();
  n.misfit = 0.11;
  n.floor = 0.104;
  n.several_materials = true;
  const Verdict v = MakeVerdict(n);
  EXPECT_TRUE(Contains(
      v.doubt,
      "one material in distant light cannot explain 0.10 of the misfit of "
      "0.11, as pixels of like normals differ by that much"))
      << v.doubt;
  EXPECT_TRUE(Contains(v.next, "mask one material")) << v.next;
  // Paint is taken for light that a glossy surface mirrors.
  EXPECT_EQ("Nothing that was estimated can be trusted.", v.trust);
  n.misfit = 0.04;
  EXPECT_EQ(Trust::kPoor, MakeVerdict(n).ratings.gloss);
  EXPECT_EQ(Trust::kPoor, MakeVerdict(n).ratings.light);
}

// The shape and the camera are not to blame for what a mirror shows sharply.
TEST(Verdict, AMirrorIsTheReasonOfAMisfit) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kReflectance;
  n.misfit = 0.12;
  n.floor = 0.1;
  EXPECT_TRUE(Contains(MakeVerdict(n).doubt, "like normals"));
  n.mirror = MirrorCause::kMapTakenCoarser;
  Verdict v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "misfit of 0.12 is mostly light, mirrored"))
      << v.doubt;
  EXPECT_TRUE(Contains(v.next, "--set illumination.width=")) << v.next;
  n.mirror = MirrorCause::kNoLobeAsSharp;
  v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "mostly light, mirrored")) << v.doubt;
  EXPECT_TRUE(Contains(v.next, "no lobe of the models is as sharp")) << v.next;
}

TEST(Verdict, CauseInMirrorIsThatOfALargeMisfitAndAMirror) {
  const Problem problem;
  InverseProblem inverse;
  inverse.model = std::make_shared<const NeuralBrdfModel>(TinyModel(4));
  const Truth truth;
  Solution solution;
  ResultMetrics metrics;
  const SolvedProblem solved = {problem, inverse, truth, solution, metrics};
  metrics.misfit = 0.2;
  solution.mirrored_share = 0.4;
  EXPECT_EQ(MirrorCause::kNone, CauseInMirror(solved));
  solution.mirrored_share = 0.6;
  EXPECT_EQ(MirrorCause::kNoLobeAsSharp, CauseInMirror(solved));
  inverse.fine_known_map = std::make_shared<const Image>(512, 256);
  inverse.map_width = 512;
  EXPECT_EQ(MirrorCause::kNoLobeAsSharp, CauseInMirror(solved));
  inverse.map_width = 256;
  EXPECT_EQ(MirrorCause::kMapTakenCoarser, CauseInMirror(solved));
  EXPECT_EQ(MirrorCause::kMapTakenCoarser, NumbersForVerdict(solved).mirror);
  metrics.misfit = 0.09;
  EXPECT_EQ(MirrorCause::kNone, CauseInMirror(solved));
}

TEST(Verdict, PaintThatOnlyAMisfitAskedForIsTrustedLess) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kReflectance;
  n.has_paint = true;
  EXPECT_EQ(Trust::kGood, MakeVerdict(n).ratings.paint);
  n.paint_by_misfit = true;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kFair, v.ratings.paint);
  EXPECT_TRUE(Contains(v.doubt, "a wrong curve, light or shape looks the same"))
      << v.doubt;
  EXPECT_TRUE(Contains(v.next, "the curve")) << v.next;
}

// Nobody asked for it, no edge of colour is seen, and nobody gave the light.
TEST(Verdict, PaintByMisfitIsThatOfKnownLightAndNoEdges) {
  Problem problem;
  problem.kind = ProblemKind::kReflectance;
  InverseProblem inverse;
  inverse.model = std::make_shared<const NeuralBrdfModel>(TinyModel(4));
  ObjectLook look;
  const Truth truth;
  Solution solution;
  const ResultMetrics metrics;
  const auto by_misfit = [&] {
    inverse.look = std::make_shared<const ObjectLook>(look);
    return NumbersForVerdict({problem, inverse, truth, solution, metrics})
        .paint_by_misfit;
  };
  EXPECT_FALSE(by_misfit());
  solution.albedo = Image(2, 2);
  EXPECT_TRUE(by_misfit());
  look.check.colour_steps = 2.0 * kMayBePainted;
  EXPECT_FALSE(by_misfit());
  look.check.colour_steps = 0.0;
  problem.reflectance.variation = ReflectanceVariation::kAlbedo;
  EXPECT_FALSE(by_misfit());
  problem.reflectance.variation = ReflectanceVariation::kAuto;
  problem.kind = ProblemKind::kJoint;
  EXPECT_FALSE(by_misfit());
}

TEST(Verdict, AnotherFrameOfTheMapComesFirst) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kReflectance;
  n.misfit = 0.3;
  n.mirror = MirrorCause::kMapTakenCoarser;
  n.map_advice = "try illumination.frame: mitsuba";
  EXPECT_EQ("Next, try illumination.frame: mitsuba.", MakeVerdict(n).next);
  // A small misfit in a wrong frame, or none better than the first guess, is as
  // wrong.
  n.misfit = 0.05;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kPoor, v.ratings.gloss);
  EXPECT_TRUE(Contains(v.doubt, "he known map may be in another frame"))
      << v.doubt;
  n.status = StatusCode::kNoImprovement;
  EXPECT_EQ(v.next, MakeVerdict(n).next);
}

TEST(Verdict, PaintTakesFromWhatIsKnownOfGlossAlone) {
  VerdictNumbers n = Good();
  n.has_paint = true;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kFair, v.ratings.gloss);
  EXPECT_EQ(Trust::kGood, v.ratings.light);
  EXPECT_EQ(MakeVerdict(Good()).ratings.hue, v.ratings.hue);
  EXPECT_TRUE(Contains(v.doubt, "paint and broad gloss explain each other"))
      << v.doubt;
}

TEST(Verdict, OnePhotographOfPaintAsksForMoreLights) {
  VerdictNumbers n = Good();
  n.has_paint = true;
  n.misfit = 0.2;
  EXPECT_TRUE(Contains(MakeVerdict(n).next, "move the lamp"));
  n.num_photographs = 3;
  EXPECT_FALSE(Contains(MakeVerdict(n).next, "move the lamp"));
  n.num_photographs = 1;
  n.kind = ProblemKind::kReflectance;
  EXPECT_FALSE(Contains(MakeVerdict(n).next, "move the lamp"));
}

// A shadow is left out by the median of three lights, and in the paint of one.
TEST(Verdict, SeveralLightsTellPaintInSpiteOfTheMisfit) {
  VerdictNumbers n = Good();
  EXPECT_FALSE(MakeVerdict(n).ratings.paint.has_value());
  n.has_paint = true;
  EXPECT_EQ(Trust::kFair, MakeVerdict(n).ratings.paint);
  n.misfit = 0.35;
  EXPECT_EQ(Trust::kNotDetermined, MakeVerdict(n).ratings.paint);
  EXPECT_TRUE(Contains(MakeVerdict(n).doubt, "the object's paint"));
  n.num_lights = 3;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kGood, v.ratings.paint);
  EXPECT_TRUE(Contains(v.trust, "Trust the object's paint")) << v.trust;
  n.num_lights = 1;
  n.misfit = 0.02;
  n.kind = ProblemKind::kReflectance;
  EXPECT_EQ(Trust::kGood, MakeVerdict(n).ratings.paint);
}

TEST(Verdict, KnownLightTellsGlossFromPaint) {
  VerdictNumbers n = Good();
  n.kind = ProblemKind::kReflectance;
  n.has_paint = true;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kGood, v.ratings.gloss);
  EXPECT_FALSE(Contains(v.doubt, "paint")) << v.doubt;
}

TEST(Verdict, AKnownReasonIsSaidOfASmallMisfitToo) {
  VerdictNumbers n = Good();
  n.misfit = 0.07;
  n.floor = 0.06;
  EXPECT_TRUE(Contains(MakeVerdict(n).doubt, "0.06 of the misfit of 0.07"));
  EXPECT_EQ(Trust::kGood, MakeVerdict(n).ratings.gloss);
  n.floor = 0.01;
  EXPECT_FALSE(Contains(MakeVerdict(n).doubt, "misfit"));
}

TEST(Verdict, AMisfitWithoutThatReasonIsSaidToo) {
  VerdictNumbers n = Good();
  n.misfit = 0.5;
  const Verdict v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "misfit of 0.50 is far above noise"))
      << v.doubt;
  EXPECT_TRUE(Contains(v.next, "check the shape")) << v.next;
  EXPECT_EQ(Trust::kPoor, v.ratings.gloss);
  n.has_mask = false;
  EXPECT_TRUE(Contains(MakeVerdict(n).next, "give a mask"));
}

TEST(Verdict, ClippedPixelsAreCounted) {
  VerdictNumbers n = Good();
  n.clipped_pixels = 1400;
  const Verdict v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "14 % of the object is clipped")) << v.doubt;
  EXPECT_TRUE(Contains(v.next, "shorter exposure")) << v.next;
  EXPECT_EQ(Trust::kFair, v.ratings.light);
}

TEST(Verdict, AnotherReflectanceIsAReason) {
  VerdictNumbers n = Good();
  n.rival_difference = 0.6;
  const Verdict v = MakeVerdict(n);
  EXPECT_TRUE(
      Contains(v.doubt, "another reflectance explains the image as well"))
      << v.doubt;
  EXPECT_EQ(Trust::kFair, v.ratings.gloss);
}

TEST(Verdict, WhatIsLeftUnexplainedAsksForAWiderSearch) {
  VerdictNumbers n = Good();
  n.misfit = 0.04;
  const Verdict before = MakeVerdict(n);
  n.structured_misfit = 0.019;
  n.may_search_wider = true;
  EXPECT_EQ(before.Sentences(), MakeVerdict(n).Sentences());
  n.structured_misfit = 0.021;
  Verdict v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "is not noise")) << v.doubt;
  EXPECT_TRUE(Contains(v.next, "solver.search=thorough")) << v.next;
  n.may_search_wider = false;
  v = MakeVerdict(n);
  EXPECT_TRUE(Contains(v.doubt, "is not noise")) << v.doubt;
  EXPECT_TRUE(Contains(v.next, "--known-light")) << v.next;
  // Like normals that differ say more.
  n.floor = n.misfit;
  n.may_search_wider = true;
  v = MakeVerdict(n);
  EXPECT_FALSE(Contains(v.doubt, "is not noise")) << v.doubt;
  EXPECT_FALSE(Contains(v.next, "solver.search")) << v.next;
}

TEST(Verdict, WhatIsNotKnownHasNoNumbers) {
  VerdictNumbers n = Good();
  n.reflectance_error = std::log(58.87);
  n.light_error = std::log(110.7);
  n.misfit = 5.739e-08;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kNotDetermined, v.ratings.gloss);
  EXPECT_EQ(Trust::kNotDetermined, v.ratings.light);
  for (const std::string& sentence : v.Sentences()) {
    EXPECT_EQ(std::string::npos, sentence.find_first_of("0123456789"))
        << sentence;
  }
}

TEST(Verdict, NoImprovementAndNanTellNothing) {
  VerdictNumbers n = Good();
  n.status = StatusCode::kNoImprovement;
  Verdict v = MakeVerdict(n);
  EXPECT_EQ("Nothing that was estimated can be trusted.", v.trust);
  EXPECT_TRUE(Contains(v.doubt, "nothing better than its first guess"));
  EXPECT_TRUE(Contains(v.next, "belong together")) << v.next;
  n = Good();
  n.misfit = kNone;
  v = MakeVerdict(n);
  EXPECT_EQ(Trust::kNotDetermined, v.ratings.hue);
  EXPECT_TRUE(Contains(v.doubt, "not a number")) << v.doubt;
}

TEST(Verdict, FewPixelsTellNothing) {
  VerdictNumbers n = Good();
  n.object_pixels = 861;
  n.used_pixels = 1;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ("Nothing that was estimated can be trusted.", v.trust);
  EXPECT_TRUE(
      Contains(v.doubt, "only 1 of the object's 861 pixels can be used"))
      << v.doubt;
  n.object_pixels = 1;
  EXPECT_TRUE(Contains(MakeVerdict(n).doubt, "the object has only 1 pixel."));
  EXPECT_TRUE(TooFewPixels(19, 19));
  EXPECT_FALSE(TooFewPixels(20, 1000));
  EXPECT_TRUE(TooFewPixels(199, 10000));
  EXPECT_FALSE(TooFewPixels(200, 10000));
}

TEST(Verdict, DoubtfulNormalsComeFirst) {
  VerdictNumbers n = Good();
  n.misfit = 0.4;
  n.normals_advice = "geometry.frame: opencv";
  EXPECT_TRUE(Contains(MakeVerdict(n).next, n.normals_advice));
}

TEST(Verdict, NumbersThatWereNotFoundAreFairAtBest) {
  VerdictNumbers n = Good();
  n.reflectance_error = n.hue_error = n.level_error = n.light_error = kNone;
  const Verdict v = MakeVerdict(n);
  EXPECT_EQ(Trust::kFair, v.ratings.gloss);
  EXPECT_FALSE(Contains(v.trust, "off by")) << v.trust;
}

// Half of the light, not of the sphere, and the summed colours of the lobes.
TEST(VerdictNumbers, AreThoseOfWhatIsSeen) {
  Problem problem;
  problem.solver.gauge = SolverGauge::kPrior;
  InverseProblem inverse;
  inverse.model = std::make_shared<const NeuralBrdfModel>(TinyModel(1));
  inverse.points.resize(50);
  const Truth truth;
  Solution solution;
  solution.pixels_used = 40;
  solution.map = Image(8, 4);
  solution.map_std = Image(4, 2);
  std::fill(solution.map.rgb.begin(), solution.map.rgb.end(), 0.01f);
  std::fill(solution.map_std.rgb.begin(), solution.map_std.rgb.end(), 2.0f);
  for (int c = 0; c < 3; ++c) {
    solution.map.At(3, 1)[c] = 10.0f;  // the lamp
    solution.map_std.At(1, 0)[c] = 0.125f;
  }
  // Two lobes of codes of four entries: the first is black but in red, where
  // its deviation counts alone.
  const double high = 10.0, low = -20.0;
  solution.lobe_parameters = {0, 0, 0, 0, high, low, low,
                              0, 0, 0, 0, low,  0.0, 0.0};
  solution.lobe_covariance.assign(14 * 14, 0.0);
  const auto variance = [&](int i) -> double& {
    return solution.lobe_covariance[static_cast<size_t>(15) * i];
  };
  variance(4) = 0.09;
  variance(5) = variance(6) = variance(11) = 30.0;
  const ResultMetrics metrics;
  const VerdictNumbers n =
      NumbersForVerdict({problem, inverse, truth, solution, metrics});
  EXPECT_NEAR(0.125, n.light_error, 1e-6);
  EXPECT_NEAR(ExpectError(std::sqrt(0.09 / 9)).median, n.level_error, 1e-3);
  EXPECT_NEAR(ExpectError(std::sqrt(2 * 0.09 / 3)).median, n.hue_error, 1e-3);
  EXPECT_EQ(50, n.object_pixels);
  EXPECT_EQ(40, n.used_pixels);
  // Where the gauge sets the hue its error is that of the gauge.
  problem.solver.gauge = SolverGauge::kGreyLight;
  EXPECT_EQ(0.2, NumbersForVerdict({problem, inverse, truth, solution, metrics})
                     .hue_error);
  EXPECT_TRUE(std::isnan(n.misfit));
}

}  // namespace
}  // namespace ibrdf
