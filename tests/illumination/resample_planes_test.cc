#include "ibrdf/solvers/illumination/resample_planes.h"

#include <gtest/gtest.h>

#include "ibrdf/light/environment_map.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Larger, smaller and the same.
TEST(ResamplePlanes, IsTheLookUpOfTheMapAtTheCentres) {
  const Image map = SmoothMap(8, 16);
  const size_t texels = map.num_pixels();
  std::vector<float> planes(3 * texels);
  for (size_t i = 0; i < planes.size(); ++i) {
    planes[i % 3 * texels + i / 3] = map.rgb[i];
  }
  for (const MapSize to : {MapSize{34, 17}, MapSize{6, 3}, MapSize{16, 8}}) {
    const std::vector<float> out = ResamplePlanes(planes, {16, 8}, to);
    const int count = to.width * to.height;
    ASSERT_EQ(size_t{3} * count, out.size());
    for (int t = 0; t < count; ++t) {
      const Eigen::Array3d value =
          LookUpMap(map, MapDirection(t / to.width + 0.5, t % to.width + 0.5,
                                      to.height, to.width));
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(static_cast<float>(value[c]), out[c * count + t]);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
