// Images of a wide range of radiance.
#pragma once
#include <cstdint>
#include <random>

#include "ibrdf/image/image.h"

namespace ibrdf {

inline Image RandomImage(int width, int height, uint32_t seed) {
  std::mt19937 rng(seed);
  std::lognormal_distribution<float> radiance(0.0f, 2.0f);
  Image image(width, height);
  for (float& v : image.rgb) v = radiance(rng);
  return image;
}

}  // namespace ibrdf
