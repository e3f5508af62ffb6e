#include "ibrdf/solvers/solve/mirrored_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/paint_evidence.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/ball_problem.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Every texel has a radiance by itself.
Image Woods(int height) {
  std::mt19937 rng(3);
  std::normal_distribution<float> value(0.0f, 0.7f);
  Image map(2 * height, height);
  for (size_t t = 0; t < map.num_pixels(); ++t) {
    const float here = std::exp(value(rng));
    for (int c = 0; c < 3; ++c) {
      map.rgb[3 * t + c] = here * (1.0f + 0.2f * static_cast<float>(c));
    }
  }
  return map;
}

std::vector<size_t> AllOf(const std::vector<ShadingPoint>& points) {
  std::vector<size_t> all(points.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

class MirroredLightTest : public ::testing::Test {
 protected:
  // What a mirror shows is rendered, and something is left.
  MirroredLightTest() {
    rows_.indices = AllOf(points_);
    const std::vector<double> mirrored =
        MirroredLogRadiance(map_, points_, 40, rows_.indices);
    for (size_t k = 0; k < mirrored.size(); ++k) {
      rows_.log_render.push_back(0.3 * noise_(rng_));
      rows_.residuals.push_back(0.4 * mirrored[k]);
    }
  }
  double Share() const { return MirroredShare(map_, points_, 40, rows_); }

  const std::vector<ShadingPoint> points_ = BallProblem(40).points;
  const Image map_ = Woods(16);
  ResidualRows rows_;
  std::mt19937 rng_{1};
  std::normal_distribution<double> noise_{0.0, 1.0};
};

// The reference has 20 x 20 samples of a pixel, and a sphere's own normals.
TEST_F(MirroredLightTest, IsThatOfTheMirroredDirections) {
  std::vector<size_t> inner;
  for (const size_t i : rows_.indices) {
    if (points_[i].normal[2] > 0.5f) inner.push_back(i);
  }
  ASSERT_GT(inner.size(), 500u);
  const std::vector<double> seen =
      MirroredLogRadiance(map_, points_, 40, inner);
  double squares = 0.0;
  for (size_t k = 0; k < inner.size(); ++k) {
    const int pixel = points_[inner[k]].pixel;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int s = 0; s < 400; ++s) {
      const double x = (pixel % 40 + (s % 20 + 0.5) / 20.0) / 20.0 - 1.0;
      const double y = 1.0 - (pixel / 40 + (s / 20 + 0.5) / 20.0) / 20.0;
      const double z = std::sqrt(1.0 - x * x - y * y);
      // wo is +z of an orthographic camera.
      sum += LookUpMap(map_, {2.0 * z * x, 2.0 * z * y, 2.0 * z * z - 1.0});
    }
    for (int c = 0; c < 3; ++c) {
      squares += std::pow(std::log(sum[c] / 400.0) - seen[3 * k + c], 2);
    }
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(seen.size())), 0.03);
}

// A pixel of a small ball averages them.
TEST_F(MirroredLightTest, TexelsFinerThanPixelsAreAveraged) {
  Image stripes(1024, 512);
  for (size_t t = 0; t < stripes.num_pixels(); ++t) {
    for (int c = 0; c < 3; ++c) {
      stripes.rgb[3 * t + c] = t % 2 == 0 ? 0.5f : 1.5f;
    }
  }
  for (const double v :
       MirroredLogRadiance(stripes, points_, 40, rows_.indices)) {
    EXPECT_NEAR(0.0, v, 1e-3);
  }
}

TEST_F(MirroredLightTest, DarknessIsFinite) {
  for (const double v :
       MirroredLogRadiance(Image(32, 16), points_, 40, {0, 1})) {
    EXPECT_TRUE(std::isfinite(v));
  }
  EXPECT_EQ(0.0, MirroredShare(Image(32, 16), points_, 40, rows_));
}

TEST_F(MirroredLightTest, ExplainsWhatItMade) { EXPECT_GT(Share(), 0.99); }

TEST_F(MirroredLightTest, NoiseTakesItsPart) {
  const auto power_of_differences = [this] {
    double power = 0.0;
    for (const auto& [first, second] : PairsInRows(points_, rows_.indices)) {
      for (size_t c = 0; c < 3; ++c) {
        power += std::pow(
            rows_.residuals[3 * second + c] - rows_.residuals[3 * first + c],
            2);
      }
    }
    return power;
  };
  const double mirrored = power_of_differences();
  for (double& v : rows_.residuals) v += 0.1 * noise_(rng_);
  const double share = mirrored / power_of_differences();
  EXPECT_LT(share, 0.9);
  EXPECT_NEAR(share, Share(), 0.05);
}

TEST_F(MirroredLightTest, DoesNotExplainPaint) {
  for (size_t k = 0; k < rows_.residuals.size(); ++k) {
    const int pixel = points_[k / 3].pixel;
    rows_.residuals[k] =
        (pixel % 40 / 6 + pixel / 40 / 6) % 2 == 0 ? 0.3 : -0.3;
  }
  EXPECT_LT(Share(), 0.05);
}

// A wrong render leaves itself, whatever is mirrored.
TEST_F(MirroredLightTest, DoesNotExplainTheRender) {
  for (size_t k = 0; k < rows_.residuals.size(); ++k) {
    rows_.residuals[k] = -rows_.log_render[k];
  }
  EXPECT_LT(Share(), 1e-6);
  rows_.log_render = MirroredLogRadiance(map_, points_, 40, rows_.indices);
  EXPECT_EQ(0.0, Share());
}

TEST_F(MirroredLightTest, EvenLightAndNoPixelsExplainNothing) {
  Image even(32, 16);
  for (float& v : even.rgb) v = 2.0f;
  EXPECT_EQ(0.0, MirroredShare(even, points_, 40, rows_));
  EXPECT_EQ(0.0, MirroredShare(map_, points_, 40, ResidualRows()));
  for (double& v : rows_.residuals) v = 0.0;
  EXPECT_EQ(0.0, Share());
}

// A mirror of more than the map holds that it is solved with. No lobe makes up
// for that, but it is not paint.
TEST(MirrorUnderKnownLight, IsNotPainted) {
  InverseProblem problem = BallProblem(40);
  problem.kind = ProblemKind::kReflectance;
  problem.variation = ReflectanceVariation::kAuto;
  problem.solver.max_iterations = 40;
  const Image map = Woods(32);
  problem.known_map = ResizeMap(map, 8, 16);
  const std::vector<double> mirrored =
      MirroredLogRadiance(map, problem.points, 40, AllOf(problem.points));
  for (size_t k = 0; k < mirrored.size(); ++k) {
    problem.image.rgb[3 * problem.points[k / 3].pixel + k % 3] =
        static_cast<float>(0.6 * std::exp(mirrored[k]));
  }
  const auto solve = [&] {
    StatusOr<Solution> solution =
        SolveInverseRendering(problem, nullptr, nullptr);
    EXPECT_TRUE(solution.ok()) << solution.status().message();
    return *std::move(solution);
  };
  EXPECT_TRUE(solve().has_paint()) << "nothing says what the map lacks";
  problem.fine_known_map = std::make_shared<const Image>(map);
  const Solution solution = solve();
  EXPECT_FALSE(solution.has_paint());
  EXPECT_GT(solution.misfit, 0.1);
  EXPECT_GT(solution.mirrored_share, 0.7);
}

}  // namespace
}  // namespace ibrdf
