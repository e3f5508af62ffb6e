#include "ibrdf/solvers/illumination/resample_planes.h"

#include <glog/logging.h>

#include <cstddef>

#include "ibrdf/light/environment_map.h"

namespace ibrdf {

std::vector<float> ResamplePlanes(const std::vector<float>& planes,
                                  MapSize from, MapSize to) {
  const size_t before = static_cast<size_t>(from.width) * from.height;
  const size_t texels = static_cast<size_t>(to.width) * to.height;
  CHECK(before > 0 && planes.size() % before == 0);
  const size_t channels = planes.size() / before;
  std::vector<float> out(channels * texels);
  for (size_t t = 0; t < texels; ++t) {
    const MapTaps taps =
        BilinearTaps(MapDirection(static_cast<double>(t / to.width) + 0.5,
                                  static_cast<double>(t % to.width) + 0.5,
                                  to.height, to.width),
                     from.height, from.width);
    for (size_t c = 0; c < channels; ++c) {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        sum += taps.weight[k] * planes[c * before + taps.texel[k]];
      }
      out[c * texels + t] = static_cast<float>(sum);
    }
  }
  return out;
}

Image ImageOfPlanes(const std::vector<double>& planes, int width, int height) {
  Image image(width, height);
  const size_t texels = image.num_pixels();
  for (size_t i = 0; i < 3 * texels; ++i) {
    image.rgb[i] = static_cast<float>(planes[i % 3 * texels + i / 3]);
  }
  return image;
}

}  // namespace ibrdf
