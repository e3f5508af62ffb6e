#include "ibrdf/solvers/problem/unknown_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

TEST(FamiliesOf, UnknownChoicesAlone) {
  EXPECT_TRUE(FamiliesOf(ResponseChoice::kAuto).empty());
  EXPECT_TRUE(FamiliesOf(ResponseChoice::kAces).empty());
  EXPECT_EQ(3u, FamiliesOf(ResponseChoice::kUnknown).size());
  for (const ResponseChoice choice :
       {ResponseChoice::kUnknownPower, ResponseChoice::kUnknownAces}) {
    const std::vector<CurveFamily> families = FamiliesOf(choice);
    ASSERT_EQ(1u, families.size());
    EXPECT_TRUE(families[0].has_parameter);
    // The prior's mean is a curve.
    ResponseDefinition curve;
    curve.kind = families[0].kind;
    curve.parameter = std::exp(families[0].log_mean);
    EXPECT_TRUE(curve.Check("test").ok());
  }
}

// Radiance that was encoded is in the interval of its code, whatever the curve.
TEST(DecodeCodes, IntervalsHoldWhatWasEncoded) {
  for (const ResponseKind kind :
       {ResponseKind::kLinear, ResponseKind::kSrgb, ResponseKind::kPower,
        ResponseKind::kAces, ResponseKind::kReinhard, ResponseKind::kLog}) {
    ResponseDefinition definition;
    definition.kind = kind;
    const ResponseCurve curve(definition);
    CodeLevels levels = CodeLevels::OfBits(8);
    levels.exposure = 3.0;
    constexpr int kValues = 600;
    Image truth(kValues, 1), codes(kValues, 1);
    for (size_t k = 0; k < truth.rgb.size(); ++k) {
      truth.rgb[k] = static_cast<float>(
          std::exp(-9.0 + 12.0 * static_cast<double>(k) / (3 * kValues)));
      codes.rgb[k] = static_cast<float>(std::lround(
          255.0 *
          std::min(curve.Encode(levels.exposure * double{truth.rgb[k]}), 1.0)));
    }
    const DecodedCodes decoded = DecodeCodes(curve, levels, codes);
    for (size_t k = 0; k < truth.rgb.size(); ++k) {
      // Floats round the ends.
      EXPECT_LE(decoded.bounds.low.rgb[k], truth.rgb[k] * (1.0f + 1e-6f));
      EXPECT_GE(decoded.bounds.high.rgb[k], truth.rgb[k] * (1.0f - 1e-6f));
      if (codes.rgb[k] == 0.0f) {
        EXPECT_EQ(0.0f, decoded.bounds.low.rgb[k]);
        EXPECT_EQ(decoded.bounds.high.rgb[k], decoded.radiance.rgb[k]);
      } else if (codes.rgb[k] == 255.0f) {
        EXPECT_TRUE(std::isinf(decoded.bounds.high.rgb[k]));
        EXPECT_EQ(decoded.bounds.low.rgb[k], decoded.radiance.rgb[k]);
      } else {
        EXPECT_LE(decoded.bounds.low.rgb[k], decoded.radiance.rgb[k]);
        EXPECT_GE(decoded.bounds.high.rgb[k], decoded.radiance.rgb[k]);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
