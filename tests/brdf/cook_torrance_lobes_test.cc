#include "ibrdf/brdf/cook_torrance_lobes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/sample_merl.h"
#include "tests/support/coloured_paint.h"

namespace ibrdf {
namespace {

constexpr BrdfGridShape kCookTorranceGrid{10, 6, 5};

CookTorrance CookTorrancePaint() {
  return testing::ColouredPaint({0.2, 0.2, 0.2}, {0.3, 0.3, 0.3});
}

TEST(CookTorranceLobes, GridAndTableAreTheModels) {
  const CookTorrance paint = CookTorrancePaint();
  const CookTorranceLobes lobes(kCookTorranceGrid, 1);
  ASSERT_EQ(10, lobes.num_parameters());
  const std::vector<double> parameters = CookTorranceLobes::ToParameters(paint);
  ASSERT_EQ(10u, parameters.size());
  const BrdfGrid grid = lobes.Grid(parameters.data());
  for (int i = 0; i < kCookTorranceGrid.num_nodes(); ++i) {
    const Eigen::Vector3d a = kCookTorranceGrid.NodeAngles(i);
    const Eigen::Array3d f = paint.Evaluate(a[0], a[1], a[2]);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(f[c], grid.Channel(c)[i], 1e-6 * f[c]);  // floats
    }
  }
  const MerlTable table = lobes.ToMerl(parameters.data());
  const MerlTable expected = SampleMerl(paint.Function());
  ASSERT_EQ(expected.raw.size(), table.raw.size());
  for (size_t i = 0; i < table.raw.size(); i += 101) {
    EXPECT_NEAR(expected.raw[i], table.raw[i],
                1e-10 * std::abs(expected.raw[i]));
  }
  // Channels with lobes of their own give the red one's shape.
  CookTorrance mixed = paint;
  mixed.roughness[1] = 0.7;
  mixed.f0[2] = 0.9;
  EXPECT_EQ(parameters, CookTorranceLobes::ToParameters(mixed));
}

// At ordinary points, a mirror's and beyond what any surface has.
TEST(CookTorranceLobes, DerivativesMatchDifferences) {
  const CookTorranceLobes lobes(kCookTorranceGrid, 2);
  const size_t n = kCookTorranceGrid.num_nodes();
  for (const double log_roughness : {-1.5, -5.0, 1.0, 7.0}) {
    for (const double logit_f0 : {-3.0, 0.5, 12.0, -30.0}) {
      std::vector<double> x(10, 0.4);
      x[5] = log_roughness;
      x[6] = logit_f0;
      std::vector<float> fields, values;
      lobes.Tabulate(x.data(), true, &fields);
      lobes.Tabulate(x.data(), false, &values);
      ASSERT_EQ(6 * n, fields.size());
      ASSERT_EQ(2 * n, values.size());
      for (size_t i = 0; i < n; ++i) {
        EXPECT_EQ(static_cast<float>(1.0 / kPi), fields[i]);
        EXPECT_EQ(fields[i], values[i]);
        EXPECT_EQ(0.0f, fields[n + i]);
        EXPECT_EQ(0.0f, fields[2 * n + i]);
        EXPECT_EQ(fields[3 * n + i], values[n + i]);
      }
      for (int d = 0; d < 2; ++d) {
        for (size_t i = 0; i < n; ++i) {
          const Eigen::Vector3d a =
              kCookTorranceGrid.NodeAngles(static_cast<int>(i));
          const auto at = [&](double t) {
            CookTorranceLog p(-1000.0, 0.0, log_roughness, logit_f0);
            p[2 + d] += t;
            return EvaluateCookTorrance(p, a[0], a[1], a[2], nullptr);
          };
          const double h = 1e-4, value = at(0.0);
          const double numeric = (at(h) - at(-h)) / (2 * h);
          // Slopes of exp(-tan^2 / m^2) far out are large beside the value.
          const double scale = std::abs(numeric) + value;
          EXPECT_NEAR(numeric, fields[(4 + d) * n + i], 1e-4 * scale + 1e-30)
              << log_roughness << " " << logit_f0 << " " << d << " " << i;
        }
      }
    }
  }
}

TEST(CookTorranceLobes, ExtremeParametersStayFinite) {
  const CookTorranceLobes lobes(kCookTorranceGrid, 1);
  for (const double extreme : {1e3, -1e3}) {
    const std::vector<double> x(10, extreme);
    std::vector<float> fields;
    lobes.Tabulate(x.data(), true, &fields);
    for (const float v : fields) ASSERT_TRUE(std::isfinite(v)) << extreme;
    for (const float v : lobes.Grid(x.data()).values) {
      ASSERT_TRUE(std::isfinite(v)) << extreme;
    }
    for (const double v : lobes.ToMerl(x.data()).raw) {
      ASSERT_TRUE(std::isfinite(v)) << extreme;
    }
  }
  // Colours that are no light's have parameters, too.
  CookTorrance black = CookTorrancePaint();
  black.diffuse.setZero();
  black.specular.setZero();
  black.f0.setOnes();
  for (const double v : CookTorranceLobes::ToParameters(black)) {
    EXPECT_TRUE(std::isfinite(v));
  }
}

}  // namespace
}  // namespace ibrdf
