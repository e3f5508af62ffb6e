#include "ibrdf/solvers/baselines/cook_torrance_fit.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/solvers/baselines/cook_torrance_cost.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {

using testing::ConstantMap;
using testing::SmoothMap;
using testing::SpherePoints;

constexpr int kSize = 16;

// A key light on the smooth map, so that roughness shows.
Image KeyLightMap() {
  Image map = SmoothMap(16, 32);
  for (int c = 0; c < 3; ++c) map.At(3, 5)[c] = 60.0f;
  return map;
}

CookTorrance Plastic() {
  CookTorrance brdf;
  brdf.diffuse = {0.4, 0.1, 0.05};
  brdf.specular = {0.9, 0.8, 0.7};
  brdf.roughness.setConstant(0.25);
  brdf.f0.setConstant(0.06);
  return brdf;
}

Image Render(const std::vector<ShadingPoint>& points, const CookTorrance& brdf,
             const Image& map, int size = kSize) {
  const Transport transport(points, map.height, map.width, {});
  std::vector<double> L_o(3 * points.size());
  transport.Render(BrdfGrid::FromFunction(brdf.Function(), {}), map.rgb.data(),
                   L_o.data());
  return PixelMeans(points, L_o.data(), size, size);
}

class CookTorranceFitTest : public ::testing::Test {
 protected:
  const std::vector<ShadingPoint> points_ = SpherePoints(kSize);
  const Image map_ = KeyLightMap();
};

// The lobe's radiance is float, about 1e-6 relative; numeric steps of 1e-3 turn
// that into 1e-3 of a derivative.
constexpr double kFloatDerivative = 3e-3;

TEST_F(CookTorranceFitTest, JacobianMatchesFiniteDifferences) {
  // Few points: every one of their derivatives is compared.
  std::vector<ShadingPoint> points;
  for (size_t i = 0; i < points_.size(); i += 23) points.push_back(points_[i]);
  const Transport transport(points, map_.height, map_.width, {});
  LogObservations observed;
  observed.floor = 1e-4;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> level(-2.0, 1.0);
  for (size_t i = 0; i < 3 * points.size(); ++i) {
    observed.values.push_back(level(rng));
  }
  const CookTorranceCost cost(transport, map_, observed, 0.3, 0);
  const std::vector<const ceres::Manifold*> manifolds{nullptr};
  const ceres::GradientChecker checker(&cost, &manifolds, {});
  CookTorranceVector ordinary, sharp, rough, dark_metal, black;
  ordinary << -1.0, -2.0, -3.0, -0.2, -0.3, -0.4, -1.5, -2.5;
  sharp << -2.0, -1.0, -1.5, 0.5, 1.0, 0.2, -3.0, 1.0;
  rough << -1.0, -1.0, -1.0, 1.0, 2.0, 0.0, 0.6, -1.0;
  dark_metal << -15.0, -14.0, -16.0, 0.5, 0.2, 0.1, -2.0, 6.5;
  black << -15.0, -15.0, -15.0, -15.0, -14.0, -13.0, -1.0, -6.5;
  for (const CookTorranceVector& p : {ordinary, sharp, rough}) {
    const double* blocks[] = {p.data()};
    ceres::GradientChecker::ProbeResults results;
    checker.Probe(blocks, kFloatDerivative, &results);
    ASSERT_TRUE(results.return_value);
    // Against the row's largest entry: float noise of the radiance drowns
    // entries where the roughness hardly matters.
    const ceres::Matrix& J = results.jacobians[0];
    const ceres::Matrix difference = J - results.numeric_jacobians[0];
    for (int i = 0; i < J.rows(); ++i) {
      EXPECT_LT(difference.row(i).cwiseAbs().maxCoeff(),
                kFloatDerivative * J.row(i).cwiseAbs().maxCoeff())
          << p.transpose() << " row " << i;
    }
  }
  // Far out, Ridders' large relative steps fail: central differences.
  const int rows = cost.num_residuals();
  for (const CookTorranceVector& p : {dark_metal, black}) {
    std::vector<double> r(rows), up(rows), down(rows);
    std::vector<double> J(static_cast<size_t>(rows) * kCookTorranceParameters);
    double* jacobians[] = {J.data()};
    const double* blocks[] = {p.data()};
    ASSERT_TRUE(cost.Evaluate(blocks, r.data(), jacobians));
    for (int k = 0; k < kCookTorranceParameters; ++k) {
      constexpr double kStep = 1e-2;
      CookTorranceVector moved = p;
      const double* moved_blocks[] = {moved.data()};
      moved[k] = p[k] + kStep;
      ASSERT_TRUE(cost.Evaluate(moved_blocks, up.data(), nullptr));
      moved[k] = p[k] - kStep;
      ASSERT_TRUE(cost.Evaluate(moved_blocks, down.data(), nullptr));
      for (int i = 0; i < rows; ++i) {
        const Eigen::Map<const CookTorranceVector> row(
            &J[static_cast<size_t>(i) * kCookTorranceParameters]);
        EXPECT_NEAR((up[i] - down[i]) / (2.0 * kStep), row[k],
                    kFloatDerivative * row.cwiseAbs().maxCoeff())
            << "row " << i << " parameter " << k;
      }
    }
  }
}

TEST_F(CookTorranceFitTest, CostIsTheSmoothedLaplacian) {
  const Transport transport(points_, map_.height, map_.width, {});
  const CookTorrance brdf = Plastic();
  const Image image = Render(points_, brdf, map_);
  LogObservations observed;
  observed.floor = 1e-6;
  for (const ShadingPoint& point : points_) {
    for (int c = 0; c < 3; ++c) {
      // Half of the residuals are 0, the others log 2.
      const double scale = point.pixel % 2 == 0 ? 1.0 : 2.0;
      observed.values.push_back(std::log(
          scale * image.rgb[size_t{3} * point.pixel + c] + observed.floor));
    }
  }
  constexpr double kSmoothing = 0.01;
  const CookTorranceCost cost(transport, map_, observed, kSmoothing, 0);
  CookTorranceVector p;
  for (int c = 0; c < 3; ++c) {
    const CookTorranceLog log = ToLogParameters(brdf, c);
    p[c] = log[0];
    p[3 + c] = log[1];
    p[6] = log[2];
    p[7] = log[3];
  }
  std::vector<double> residuals(observed.values.size());
  const double* blocks[] = {p.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residuals.data(), nullptr));
  const double d = std::log(2.0);
  const double rho = std::sqrt(d * d + kSmoothing * kSmoothing) - kSmoothing;
  double mean = 0.0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const bool doubled = points_[i].pixel % 2 != 0;
    mean += doubled ? d : 0.0;
    for (int c = 0; c < 3; ++c) {
      const double r = residuals[3 * i + c];
      // Radiance is float; a residual near 0 is d / sqrt(s).
      EXPECT_NEAR(doubled ? rho : 0.0, 0.5 * r * r, 1e-4);
    }
  }
  mean /= static_cast<double>(points_.size());
  EXPECT_NEAR(mean, cost.Misfit(p), 1e-4);
}

TEST_F(CookTorranceFitTest, RecoversWhatItRendered) {
  const CookTorrance brdf = Plastic();
  const StatusOr<CookTorranceFit> fit =
      FitCookTorrance(points_, Render(points_, brdf, map_), map_, {});
  ASSERT_TRUE(fit.ok()) << fit.status().message();
  // No noise: what is left is the tolerance of the solver.
  EXPECT_LT(fit->misfit, 1e-3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(1.0, fit->brdf.diffuse[c] / brdf.diffuse[c], 0.02);
    // Colour and f0 trade against each other, their product hardly.
    EXPECT_NEAR(1.0,
                fit->brdf.specular[c] * fit->brdf.f0[c] /
                    (brdf.specular[c] * brdf.f0[c]),
                0.05);
    EXPECT_NEAR(1.0, fit->brdf.roughness[c] / brdf.roughness[c], 0.02);
  }
}

TEST_F(CookTorranceFitTest, RepeatedEvaluationsAreTheFirst) {
  // Steps of the colours and back: what is kept between them must not show.
  const Transport transport(points_, map_.height, map_.width, {});
  LogObservations observed;
  observed.floor = 1e-4;
  observed.values.assign(3 * points_.size(), -1.0);
  CookTorranceVector p, colours, rough;
  p << -1.0, -2.0, -3.0, -0.2, -0.3, -0.4, -1.5, -2.5;
  colours = rough = p;
  colours[1] += 0.5;
  rough[6] += 0.5;
  const CookTorranceCost one(transport, map_, observed, 0.3, 0);
  for (const CookTorranceVector& q : {p, colours, rough, p, rough}) {
    const CookTorranceCost fresh(transport, map_, observed, 0.3, 0);
    const double* blocks[] = {q.data()};
    std::vector<double> a(observed.values.size()), b = a;
    ASSERT_TRUE(one.Evaluate(blocks, a.data(), nullptr));
    ASSERT_TRUE(fresh.Evaluate(blocks, b.data(), nullptr));
    EXPECT_EQ(a, b);
    EXPECT_EQ(one.Misfit(q), fresh.Misfit(q));
  }
}

TEST_F(CookTorranceFitTest, ManyPointsAreThinnedEvenly) {
  constexpr int kFine = 48;
  const CookTorrance brdf = Plastic();
  const std::vector<ShadingPoint> points = SpherePoints(kFine);
  Image image = Render(points, brdf, map_, kFine);
  CookTorranceFitOptions options;
  options.max_points = 150;
  ASSERT_GT(points.size(), 10u * options.max_points);
  const CookTorranceFit thin =
      FitCookTorrance(points, image, map_, options).value();
  EXPECT_LT(thin.misfit, 1e-3);
  EXPECT_NEAR(1.0, thin.brdf.roughness[0] / brdf.roughness[0], 0.02);
  // Twice the red in the upper half, which no surface explains: the points kept
  // show it only if they are of both halves. Of red one half is off by log 2 /
  // 2 and more, were it not for what the lobes can take on.
  for (const ShadingPoint& point : points) {
    if (point.normal.y() > 0.0f) {
      image.rgb[size_t{3} * point.pixel] *= 2.0f;
    }
  }
  EXPECT_LT(0.05, FitCookTorrance(points, image, map_, options).value().misfit);
}

TEST_F(CookTorranceFitTest, ThinObjectsKeepPoints) {
  // One row that the rows kept of an image may miss.
  constexpr int kFine = 48;
  std::vector<ShadingPoint> row;
  for (const ShadingPoint& point : SpherePoints(kFine)) {
    if (point.pixel / kFine == kFine / 2) row.push_back(point);
  }
  const CookTorrance brdf = Plastic();
  CookTorranceFitOptions options;
  options.max_points = 10;
  const StatusOr<CookTorranceFit> fit =
      FitCookTorrance(row, Render(row, brdf, map_, kFine), map_, options);
  ASSERT_TRUE(fit.ok()) << fit.status().message();
  EXPECT_LT(fit->misfit, 1e-2);
}

TEST_F(CookTorranceFitTest, OutliersDoNotMoveTheFit) {
  const CookTorrance brdf = Plastic();
  Image image = Render(points_, brdf, map_);
  for (size_t i = 0; i < points_.size(); i += 10) {
    image.rgb[size_t{3} * points_[i].pixel] *= 100.0f;
  }
  image.rgb[size_t{3} * points_[5].pixel] =
      std::numeric_limits<float>::quiet_NaN();
  image.rgb[size_t{3} * points_[6].pixel] = -1.0f;
  const StatusOr<CookTorranceFit> fit =
      FitCookTorrance(points_, image, map_, {});
  ASSERT_TRUE(fit.ok()) << fit.status().message();
  // Least squares of the logarithms would be off by log(100) / 10 = 46 %.
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(1.0, fit->brdf.diffuse[c] / brdf.diffuse[c], 0.05);
  }
}

TEST_F(CookTorranceFitTest, SameBitsForAnyNumberOfThreads) {
  const Image image = Render(points_, Plastic(), map_);
  CookTorranceFitOptions options;
  options.start_roughness = {0.3};
  options.num_threads = 1;
  const CookTorranceFit one =
      FitCookTorrance(points_, image, map_, options).value();
  options.num_threads = 3;
  const CookTorranceFit three =
      FitCookTorrance(points_, image, map_, options).value();
  EXPECT_EQ(one.misfit, three.misfit);
  EXPECT_EQ(one.brdf.roughness[0], three.brdf.roughness[0]);
}

TEST_F(CookTorranceFitTest, ExtremeImagesAreFittedOrRefused) {
  const Image black(kSize, kSize);
  EXPECT_EQ(StatusCode::kInvalidInput,
            FitCookTorrance(points_, black, map_, {}).status().code());
  for (const float level : {1e-20f, 1e20f}) {
    Image image(kSize, kSize);
    for (float& v : image.rgb) v = level;
    const StatusOr<CookTorranceFit> fit =
        FitCookTorrance(points_, image, map_, {});
    ASSERT_TRUE(fit.ok()) << level;
    EXPECT_TRUE(std::isfinite(fit->misfit));
    EXPECT_TRUE(fit->brdf.Evaluate(0.1, 0.2, 0.3).allFinite());
  }
}

TEST(ScoreConstantMap, ClosedForm) {
  // Upper half 3, lower half 1: the mean is 2, both halves have half the
  // sphere, and the range is log 3.
  Image map = ConstantMap(4, 8, 1.0f);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int c = 0; c < 3; ++c) map.At(x, y)[c] = 3.0f;
    }
  }
  const IlluminationMetrics m = ScoreConstantMap(map).value();
  const double up = std::log(2.0 / 3.0), down = std::log(2.0);
  // The floor is 1e-6 of the largest value.
  EXPECT_NEAR(std::sqrt(0.5 * (up * up + down * down)) / std::log(3.0),
              m.relative_log_rmse, 1e-5);
  EXPECT_NEAR(0.5 * (down - up) / std::log(3.0), m.relative_log_rmse_aligned,
              1e-5);
  EXPECT_FALSE(ScoreConstantMap(ConstantMap(2, 4, 1.0f)).ok());
}

}  // namespace
}  // namespace ibrdf
