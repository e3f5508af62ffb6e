#include "ibrdf/uncertainty/reflection_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// The transform of an isotropic density of slopes at frequency w, by the
// midpoint rule: int D(s) J_0(w s) 2 pi s ds.
template <typename Density>
double Transform(double w, const Density& density) {
  constexpr int kSteps = 40000;
  constexpr double kFarthest = 40.0;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) * kFarthest / kSteps;
    sum += density(s) * std::cyl_bessel_j(0.0, w * s) * 2.0 * kPi * s;
  }
  return sum * kFarthest / kSteps;
}

TEST(FilterOf, IsTheTransformOfTheSlopes) {
  // A slope s turns the mirror direction by 2 s: degree l has frequency 2 l.
  const double alpha = 0.3;
  for (const int l : {1, 2, 4}) {
    const double beckmann = Transform(2.0 * l, [&](double s) {
      return std::exp(-s * s / (alpha * alpha)) / (kPi * alpha * alpha);
    });
    EXPECT_NEAR(beckmann, FilterOf(GlossFilter::kBeckmann, alpha, l), 1e-6);
    const double ggx = Transform(2.0 * l, [&](double s) {
      const double q = 1.0 + s * s / (alpha * alpha);
      return 1.0 / (kPi * alpha * alpha * q * q);
    });
    // The tail beyond the last slope is below alpha^2 / 40^2.
    EXPECT_NEAR(ggx, FilterOf(GlossFilter::kGgx, alpha, l), 1e-4);
  }
}

TEST(FilterOf, LeavesMirrorsAndTheMeanAlone) {
  for (const GlossFilter filter : {GlossFilter::kBeckmann, GlossFilter::kGgx}) {
    EXPECT_EQ(1.0, FilterOf(filter, 0.0, 7));
    EXPECT_EQ(1.0, FilterOf(filter, 0.4, 0));
    double before = 1.0;
    for (int l = 1; l <= 10; ++l) {
      const double e = FilterOf(filter, 0.2, l);
      EXPECT_GT(before, e);
      before = e;
    }
  }
}

TEST(AlphaValues, SpanTheUnitInterval) {
  EXPECT_EQ((std::vector<double>{0.0, 0.25, 1.0}),
            AlphaValues(AlphaGrid::kUniformRoughness, 3));
  EXPECT_EQ((std::vector<double>{0.0, 0.5, 1.0}),
            AlphaValues(AlphaGrid::kUniformAlpha, 3));
}

}  // namespace
}  // namespace ibrdf
