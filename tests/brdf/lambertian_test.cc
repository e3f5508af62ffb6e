#include "ibrdf/brdf/lambertian.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

TEST(Lambertian, IsAlbedoOverPiEverywhere) {
  Lambertian brdf;
  brdf.albedo = {0.1, 0.5, 0.9};
  for (const double theta : {0.0, 0.7, 1.57}) {
    const Eigen::Array3d f = brdf.Function()(theta, 1.57 - theta, 3.0 * theta);
    for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(brdf.albedo[c] / kPi, f[c]);
  }
}

}  // namespace
}  // namespace ibrdf
