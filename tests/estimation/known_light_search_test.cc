#include "ibrdf/solvers/estimation/known_light_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/marginal/marginal_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class KnownLightSearchTest : public MarginalTest {
 protected:
  TransportOptions Options() const {
    TransportOptions options;
    options.grid = resolution_.grid;
    options.num_threads = 1;
    return options;
  }

  const MaterialPrior prior_ = JointMaterialPrior(model_, 2, 0.5);
  const FlowLobes lobes_{model_, 2, resolution_.grid, 1};
  const Transport transport_{points_, 8, 16, Options()};
};

TEST_F(KnownLightSearchTest, RanksFirstTheMaterialThatMadeTheImage) {
  const std::vector<float> map = SmoothMap(8, 16).rgb;
  for (size_t m = 0; m < prior_.materials.size(); ++m) {
    std::vector<double> L_o;
    // Brighter than the material: the level is no part of the comparison.
    Eigen::VectorXd x = prior_.materials[m].parameters;
    for (const int i : {4, 5, 6, 11, 12, 13}) x[i] += 1.5;
    ASSERT_TRUE(RenderLobeModel(transport_, lobes_, x.data(), map.data(), &L_o,
                                nullptr));
    RobustLogLikelihood likelihood;
    likelihood.scale = 0.02;
    const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
        transport_, lobes_, prior_, map, MakeObservations(L_o), likelihood);
    ASSERT_EQ(prior_.materials.size(), ranked.size());
    EXPECT_EQ(prior_.materials[m].name, ranked[0].name);
    EXPECT_NEAR(x[4], ranked[0].parameters[4], 1e-3);
    for (size_t k = 1; k < ranked.size(); ++k) {
      EXPECT_LE(ranked[k - 1].cost, ranked[k].cost);
    }
  }
}

// A point that no light reaches has no level, whatever epsilon is.
TEST_F(KnownLightSearchTest, BlackPointsDoNotMoveColours) {
  std::vector<float> map(3 * 8 * 16, 0.0f);
  for (int c = 0; c < 3; ++c) map[3 * (4 * 16 + 4) + c] = 1.0f;
  std::vector<double> L_o;
  ASSERT_TRUE(RenderLobeModel(transport_, lobes_,
                              prior_.materials[0].parameters.data(), map.data(),
                              &L_o, nullptr));
  ASSERT_EQ(0.0, *std::min_element(L_o.begin(), L_o.end()));
  RobustLogLikelihood likelihood;
  likelihood.scale = 0.02;
  likelihood.epsilon = 0.0;
  for (const RankedMaterial& ranked : RankUnderKnownLight(
           transport_, lobes_, prior_, map,
           MakeObservations(std::vector<double>(L_o.size(), 1.0)),
           likelihood)) {
    for (const double x : ranked.parameters) {
      EXPECT_TRUE(std::isfinite(x)) << ranked.name;
    }
  }
}

}  // namespace
}  // namespace ibrdf
