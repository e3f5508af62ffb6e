// A sphere under a smooth map, at a resolution for tests of the marginal
// likelihood of lobes.
#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace testing {

// One in front, one behind the sphere.
inline const std::vector<Eigen::Vector3d> kDirectionalLights = {
    Eigen::Vector3d(0.6, 0.5, 0.6).normalized(),
    Eigen::Vector3d(-0.8, 0.1, -0.5).normalized()};

class MarginalTest : public ::testing::Test {
 protected:
  MarginalTest() {
    resolution_.bins = {6, 3, 0.2};
    resolution_.map_width = 16;
    resolution_.map_height = 8;
    resolution_.grid = TinyTransportOptions().grid;
  }

  const NeuralBrdfModel model_ = SmoothTinyModel(4);
  const std::vector<ShadingPoint> points_ = SpherePoints(12);
  MarginalResolution resolution_;
  const std::vector<double> truth_ = TinyLobes();
  const std::vector<double> radiance_ =
      RenderTinyLobes(model_, points_, SmoothMap(8, 16));
};

}  // namespace testing
}  // namespace ibrdf
