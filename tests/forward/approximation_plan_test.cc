#include "ibrdf/solvers/forward/approximation_plan.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(ApproximationPlan, ThatConsidersNothingSaysNothing) {
  EXPECT_EQ("", Describe(ApproximationPlan()));
}

TEST(ApproximationPlan, SaysWhatIsTaken) {
  ApproximationPlan plan;
  plan.verdict = ApproximationVerdict::kTaken;
  plan.approximation = Approximation::kHarmonics;
  plan.order = 5;
  plan.log_error = 0.003;
  plan.predicted_error = 0.0011;
  plan.found_error = 0.0012;
  plan.quadrature_error = 0.0004;
  plan.checked = 64;
  plan.seconds = 0.02;
  plan.quadrature_seconds = 1.5;
  const std::string errors =
      ": predicted error of log radiance 0.0011, found 0.0012 at 64 points "
      "(allowed 0.0030; point by point 0.0004), about 0.02 s of a core for "
      "1.50 s";
  EXPECT_EQ("; light in spherical harmonics up to l = 5" + errors,
            Describe(plan));
  plan.approximation = Approximation::kGaussians;
  plan.gaussians = 67;
  plan.spots = 2;
  plan.forced = true;
  EXPECT_EQ("; light in 67 spherical Gaussians, 2 for bright spots, as asked" +
                errors,
            Describe(plan));
}

TEST(ApproximationPlan, SaysWhyNothingIsTaken) {
  ApproximationPlan plan;
  plan.log_error = 0.003;
  plan.lobe_half_width = 0.035;
  plan.predicted_error = 0.02;
  plan.quadrature_error = 0.001;
  const std::string both = "; spherical harmonics and spherical Gaussians are ";
  plan.verdict = ApproximationVerdict::kNarrowLobe;
  EXPECT_EQ(both + "not within 0.0030 for a lobe of 2.0 degrees",
            Describe(plan));
  plan.verdict = ApproximationVerdict::kPredictedOff;
  EXPECT_EQ(both + "not within 0.0030: predicted at best 0.0200",
            Describe(plan));
  plan.verdict = ApproximationVerdict::kNonePays;
  EXPECT_EQ(both +
                "slower or not within 0.0030: predicted at best 0.0200, point "
                "by point 0.0010",
            Describe(plan));
}

}  // namespace
}  // namespace ibrdf
