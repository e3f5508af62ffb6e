#include "ibrdf/brdf/table_lobes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/brdf/sample_merl.h"
#include "tests/support/coloured_paint.h"

namespace ibrdf {
namespace {

constexpr BrdfGridShape kTableShape{12, 8, 6};

BrdfGrid PaintTable() {
  return BrdfGrid::FromFunction(
      testing::ColouredPaint({0.2, 0.3, 0.1}, {0.3, 0.3, 0.3}).Function(),
      kTableShape);
}

TEST(TableLobes, AreTheTableAtTheNodesOfAnyGrid) {
  const BrdfGrid paint = PaintTable();
  const std::vector<double> known = TableLobes::KnownParameters();
  for (const BrdfGridShape& shape :
       {kTableShape, BrdfGridShape{7, 5, 4}, BrdfGridShape{30, 9, 1}}) {
    const auto lobes = TableLobes::Factory(paint)(shape);
    ASSERT_EQ(3, lobes->num_lobes());
    ASSERT_EQ(9, lobes->num_parameters());
    ASSERT_EQ(known.size(), 9u);
    const BrdfGrid grid = lobes->Grid(known.data());
    ASSERT_TRUE(shape == grid.shape);
    for (int i = 0; i < shape.num_nodes(); ++i) {
      const Eigen::Vector3d a = shape.NodeAngles(i);
      const Eigen::Array3d f = paint.Evaluate(a[0], a[1], a[2]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(f[c], grid.Channel(c)[i], 1e-6 * f[c]);  // floats
      }
    }
  }
}

TEST(TableLobes, ShapesAreTheSameWhateverTheParameters) {
  const BrdfGrid paint = PaintTable();
  const TableLobes lobes(paint, kTableShape);
  std::vector<float> fields, others;
  lobes.Tabulate(TableLobes::KnownParameters().data(), true, &fields);
  // No codes, so no derivatives.
  ASSERT_EQ(size_t{3} * kTableShape.num_nodes(), fields.size());
  lobes.Tabulate(std::vector<double>(9, 2.0).data(), false, &others);
  EXPECT_EQ(fields, others);
  // A colour scales its own channel.
  std::vector<double> brighter = TableLobes::KnownParameters();
  brighter[4] += std::log(2.0);
  const BrdfGrid grid = lobes.Grid(brighter.data());
  for (int i = 0; i < kTableShape.num_nodes(); i += 7) {
    EXPECT_NEAR(paint.Channel(0)[i], grid.Channel(0)[i],
                1e-6 * paint.Channel(0)[i]);
    EXPECT_NEAR(2.0 * paint.Channel(1)[i], grid.Channel(1)[i],
                2e-6 * paint.Channel(1)[i]);
  }
}

TEST(TableLobes, MerlTableIsTheGrids) {
  const BrdfGrid paint = PaintTable();
  const MerlTable table = TableLobes(paint, kTableShape)
                              .ToMerl(TableLobes::KnownParameters().data());
  const MerlTable expected =
      SampleMerl([&](double theta_h, double theta_d, double phi_d) {
        return paint.Evaluate(theta_h, theta_d, phi_d);
      });
  ASSERT_EQ(expected.raw.size(), table.raw.size());
  for (size_t i = 0; i < table.raw.size(); i += 101) {
    EXPECT_NEAR(expected.raw[i], table.raw[i],
                1e-5 * std::abs(expected.raw[i]));
  }
}

}  // namespace
}  // namespace ibrdf
