// The triangular flow as a map: normalised, invertible, whole at the seam.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/flow/triangular_flow.h"
#include "ibrdf/flow/triangular_reference.h"
#include "tests/support/triangular_testing.h"

namespace ibrdf {
namespace {

std::vector<TriangularCase> ExtremeCases() {
  const TriangularShape usual;
  return {MakeCase("scale 100", usual, 100.0f, 1.0),
          MakeCase("scale 1e4", usual, 1e4f, 1.0),
          MakeCase("code 1e3", usual, 4.0f, 1e3)};
}

TEST(TriangularMap, DensityIntegratesToOne) {
  // Midpoint rule: of second order in the step over the bins' widths, which is
  // a tenth here or less; steep cases are left to the map's own derivative.
  constexpr double kTolerance = 5e-3;
  for (const TriangularCase& c : TriangularCases()) {
    if (c.name == "steep" || c.name == "limits" || c.name == "far code")
      continue;
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights);
    constexpr int kSide = 128, kPoints = 400;
    FlowColumns x(kSide * kSide, kPoints);
    for (int k = 0; k < x.columns; ++k) {
      x.SetColumn(k, (k / kSide + 0.5) / kSide, (k % kSide + 0.5) / kSide);
      for (int i = 0; i < kPoints; ++i) {
        x.x_h[static_cast<size_t>(i) * x.columns + k] =
            (static_cast<float>(i) + 0.5f) / kPoints;
      }
    }
    std::vector<float> value(x.num_points());
    flow.LogDensityOnColumns(x, c.code.data(), 2, value.data(), nullptr);
    double sum = 0.0, spread = 0.0;
    for (const float v : value) {
      sum += std::exp(double{v});
      spread = std::max(spread, std::abs(double{v}));
    }
    EXPECT_NEAR(1.0, sum / static_cast<double>(value.size()), kTolerance);
    // Not just the identity.
    EXPECT_TRUE(c.name == "flat" || spread > 1e-5);
  }
}

TEST(TriangularMap, MapIsTheReferences) {
  // Conditioners run in float: a share of rounding times the density.
  constexpr double kTolerance = 1e-4;
  for (const TriangularCase& c : TriangularCases()) {
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights);
    const TriangularReference<double> reference(c.shape, c.weights.data());
    const std::vector<double> z(c.code.begin(), c.code.end());
    const int n = 60;
    const std::vector<float> points = CubePoints(n);
    const std::vector<double> x(points.begin(), points.end());
    std::vector<double> u(3 * n), y(3 * n);
    flow.Latent(x.data(), n, c.code.data(), 1, u.data());
    flow.Inverse(x.data(), n, c.code.data(), 1, y.data());
    for (int p = 0; p < n; ++p) {
      const double xp[3] = {x[p], x[n + p], x[2 * n + p]};
      const double yp[3] = {y[p], y[n + p], y[2 * n + p]};
      double expected[3], back[3];
      reference.Latent(xp, z.data(), expected);
      reference.Latent(yp, z.data(), back);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(expected[i], u[i * n + p], kTolerance);
        EXPECT_NEAR(xp[i], back[i], kTolerance);
      }
    }
  }
}

TEST(TriangularMap, RoundTripOnTheClosedCube) {
  // Splines invert to 1e-15 of a probability. A coordinate that comes back a
  // double's rounding away may round to another float before it enters the
  // next conditioner: 1e-7 at a few points, times how steep that one is.
  constexpr double kExact = 1e-12, kRounded = 1e-5;
  std::vector<TriangularCase> cases = TriangularCases();
  for (TriangularCase& c : ExtremeCases()) cases.push_back(std::move(c));
  for (const TriangularCase& c : cases) {
    SCOPED_TRACE(c.name);
    const bool extreme = c.name == "scale 1e4" || c.name == "scale 100" ||
                         c.name == "code 1e3" || c.name == "limits";
    const TriangularFlow flow(c.shape, c.weights);
    const int n = 400;
    const std::vector<float> points = CubePoints(n);
    const std::vector<double> start(points.begin(), points.end());
    std::vector<double> x(3 * n), u(3 * n), again(3 * n);
    // Latent points come back.
    flow.Inverse(start.data(), n, c.code.data(), 2, x.data());
    flow.Latent(x.data(), n, c.code.data(), 1, u.data());
    int off = 0;
    for (int i = 0; i < 3 * n; ++i) {
      ASSERT_TRUE(x[i] >= 0.0 && x[i] <= 1.0);
      EXPECT_NEAR(start[i], u[i], kRounded);
      off += std::abs(start[i] - u[i]) > kExact;
    }
    EXPECT_LE(off, 3 * n / 50);
    // So do points, where the density leaves a double enough of them: e^-40
    // of an extreme flow maps whole intervals to one latent point.
    flow.Latent(start.data(), n, c.code.data(), 1, u.data());
    flow.Inverse(u.data(), n, c.code.data(), 1, x.data());
    flow.Latent(x.data(), n, c.code.data(), 1, again.data());
    for (int i = 0; i < 3 * n; ++i) {
      ASSERT_TRUE(u[i] >= 0.0 && u[i] <= 1.0);
      EXPECT_NEAR(u[i], again[i], extreme ? 1e-3 : kRounded);
      if (!extreme && c.name != "steep" && c.name != "far code") {
        EXPECT_NEAR(start[i], x[i], kRounded);
      }
    }
  }
}

TEST(TriangularMap, FacesStayFaces) {
  for (const TriangularCase& c : TriangularCases()) {
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights);
    std::vector<double> x, u(24);
    for (int i = 0; i < 3; ++i) {
      for (int corner = 0; corner < 8; ++corner) x.push_back(corner >> i & 1);
    }
    flow.Latent(x.data(), 8, c.code.data(), 1, u.data());
    // Sums of up to 64 masses in double.
    for (int i = 0; i < 24; ++i) EXPECT_NEAR(x[i], u[i], 1e-14);
  }
}

TEST(TriangularMap, JacobianIsTheDensity) {
  // Differences over 2e-6 of a map that is smooth but at knots, where its
  // derivative is still continuous; float log densities are right to 1e-5.
  constexpr double kStep = 1e-6, kTolerance = 2e-4;
  for (const TriangularCase& c : TriangularCases()) {
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights);
    const int n = 50;
    std::vector<float> points = CubePoints(n);
    for (float& v : points) v = 0.01f + 0.98f * v;
    std::vector<float> value(n);
    flow.LogDensity(points.data(), n, c.code.data(), 1, value.data(), nullptr,
                    nullptr);
    const std::vector<double> x(points.begin(), points.end());
    std::vector<double> slopes[3];  // [by coordinate][3][n]
    for (int k = 0; k < 3; ++k) {
      std::vector<double> up(x), down(x), u_up(3 * n), u_down(3 * n);
      for (int p = 0; p < n; ++p) {
        up[k * n + p] += kStep;
        down[k * n + p] -= kStep;
      }
      flow.Latent(up.data(), n, c.code.data(), 1, u_up.data());
      flow.Latent(down.data(), n, c.code.data(), 1, u_down.data());
      for (int i = 0; i < 3 * n; ++i) {
        slopes[k].push_back((u_up[i] - u_down[i]) / (2 * kStep));
      }
    }
    int checked = 0;
    for (int p = 0; p < n; ++p) {
      Eigen::Matrix3d jacobian;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) jacobian(i, k) = slopes[k][i * n + p];
      }
      // Triangular: x_p alone, x_d given x_p, x_h given both.
      EXPECT_EQ(0.0, jacobian(2, 0));
      EXPECT_EQ(0.0, jacobian(2, 1));
      EXPECT_EQ(0.0, jacobian(1, 0));
      const double density = std::exp(double{value[p]});
      // Below, a difference of probabilities is rounding.
      if (jacobian.diagonal().minCoeff() < 1e-5) continue;
      ++checked;
      EXPECT_NEAR(density, jacobian.determinant(),
                  kTolerance * density * (1 + std::abs(value[p])));
    }
    // Far from the codes of training little of the cube has any density.
    EXPECT_GE(checked, c.name == "limits"     ? 0
                       : c.name == "far code" ? 3
                                              : n / 4);
  }
}

TEST(TriangularMap, IsWholeWherePhiDWrapsAround) {
  // cos and sin of a float's 2 pi differ from those of 0 by 2e-7.
  constexpr float kTolerance = 1e-4f;
  for (const TriangularCase& c : TriangularCases()) {
    if (c.name == "far code") continue;  // steeper than its rounding allows
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights);
    const int n = 64, size = c.shape.code_size;
    std::vector<float> at0 = CubePoints(n), at1;
    std::fill(at0.begin() + 2 * n, at0.end(), 0.0f);
    at1 = at0;
    std::fill(at1.begin() + 2 * n, at1.end(), 1.0f);
    std::vector<float> v0(n), v1(n), dz0(n * size), dz1(dz0), dx0(3 * n),
        dx1(dx0);
    flow.LogDensity(at0.data(), n, c.code.data(), 1, v0.data(), dz0.data(),
                    dx0.data());
    flow.LogDensity(at1.data(), n, c.code.data(), 1, v1.data(), dz1.data(),
                    dx1.data());
    float scale = 1.0f;
    for (const float g : dz0) scale = std::max(scale, std::abs(g));
    for (const float g : dx0) scale = std::max(scale, std::abs(g));
    for (int p = 0; p < n; ++p) {
      EXPECT_NEAR(v0[p], v1[p], kTolerance * (1 + std::abs(v0[p])));
      for (int k = 0; k < size; ++k) {
        EXPECT_NEAR(dz0[k * n + p], dz1[k * n + p], kTolerance * scale);
      }
      EXPECT_NEAR(dx0[p], dx1[p], kTolerance * scale);
      EXPECT_NEAR(dx0[n + p], dx1[n + p], kTolerance * scale);
      // x_p's own spline has a knot there, where its slope may jump as at any
      // other knot: by the same for all points.
      EXPECT_NEAR(dx1[2 * n] - dx0[2 * n], dx1[2 * n + p] - dx0[2 * n + p],
                  kTolerance * scale);
    }
  }
}

TEST(TriangularMap, IsSmoothAtTheSeamWhereTheMarginalIs) {
  TriangularShape shape;
  TriangularCase c = MakeCase("", shape, 4.0f, 1.0);
  // Without x_p's conditioner its density is uniform.
  const size_t own = shape.Conditioners()[2].num_weights;
  std::fill(c.weights.end() - static_cast<std::ptrdiff_t>(own), c.weights.end(),
            0.0f);
  const TriangularFlow flow(shape, c.weights);
  const int n = 64;
  std::vector<float> at0 = CubePoints(n), at1;
  std::fill(at0.begin() + 2 * n, at0.end(), 0.0f);
  at1 = at0;
  std::fill(at1.begin() + 2 * n, at1.end(), 1.0f);
  std::vector<float> v(n), dx0(3 * n), dx1(3 * n);
  flow.LogDensity(at0.data(), n, c.code.data(), 1, v.data(), nullptr,
                  dx0.data());
  flow.LogDensity(at1.data(), n, c.code.data(), 1, v.data(), nullptr,
                  dx1.data());
  float largest = 0.0f;
  for (int p = 0; p < n; ++p) {
    largest = std::max(largest, std::abs(dx0[2 * n + p]));
    EXPECT_NEAR(dx0[2 * n + p], dx1[2 * n + p],
                1e-4f * (1 + std::abs(dx0[2 * n + p])));
  }
  EXPECT_GT(largest, 0.1f);  // there is something to agree about
}

TEST(MerlColumns, AreTheTablesBins) {
  const FlowColumns x = MerlColumns();
  ASSERT_EQ(90 * 180, x.columns);
  ASSERT_EQ(90, x.points);
  for (const auto* values : {&x.x_d, &x.x_p, &x.x_h}) {
    for (const float v : *values) ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
  }
  // theta_h grows along a column, theta_d is the column's row.
  EXPECT_LT(x.x_h[0], x.x_h[x.columns]);
  EXPECT_EQ(x.x_d[0], x.x_d[179]);
  EXPECT_LT(x.x_d[179], x.x_d[180]);
  EXPECT_LT(x.x_p[0], x.x_p[1]);
  EXPECT_NEAR(std::cos(2 * kPi * x.x_p[30]), x.features[3 * x.columns + 30],
              1e-6);
}

}  // namespace
}  // namespace ibrdf
