#include "ibrdf/brdf/lambertian.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

TEST(Lambertian, IsAlbedoOverPiEverywhere) {
  Lambertian brdf;
  brdf.albedo = {0.1, 0.5, 0.9};
  for (const double theta : {0.0, 0.7, 1.57}) {
    const Eigen::Array3d f = brdf.Function()(theta, 1.57 - theta, 3.0 * theta);
    for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(brdf.albedo[c] / M_PI, f[c]);
  }
}

TEST(Lambertian, LogParameterRoundTripsAndGradientMatchesDifferences) {
  Lambertian brdf;
  brdf.albedo = {0.25, 0.0, 3.0};
  Lambertian back;
  for (int c = 0; c < 3; ++c) {
    FromLogParameter(ToLogParameter(brdf, c), c, &back);
    EXPECT_NEAR(brdf.albedo[c], back.albedo[c], 2e-12);  // 1e-12 stands for 0
  }
  for (const double p : {-20.0, -1.0, 5.0}) {
    constexpr double kStep = 1e-5;
    double gradient = 0.0;
    const double f = EvaluateLambertian(p, &gradient);
    const double difference = (EvaluateLambertian(p + kStep, nullptr) -
                               EvaluateLambertian(p - kStep, nullptr)) /
                              (2 * kStep);
    // Second order in the step; the third derivative is f.
    EXPECT_NEAR(difference, gradient, 1e-9 * f);
  }
}

}  // namespace
}  // namespace ibrdf
