#include "ibrdf/solvers/photograph_check/pixel_counts.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {

PixelKind KindOfPixel(const float* radiance, bool codes) {
  const auto any = [&](auto is) {
    return std::any_of(radiance, radiance + 3, is);
  };
  if (any([](float v) { return !std::isfinite(v); })) {
    return codes ? PixelKind::kClipped : PixelKind::kNotFinite;
  }
  if (any([](float v) { return v < 0.0f; })) return PixelKind::kNegative;
  if (any([](float v) { return v == 0.0f; })) return PixelKind::kZero;
  return PixelKind::kUsed;
}

ObjectPixelCounts CountPixels(const Image& radiance,
                              const std::vector<ShadingPoint>& points,
                              bool codes) {
  ObjectPixelCounts counts;
  for (const ShadingPoint& point : points) {
    ++counts.object;
    switch (KindOfPixel(&radiance.rgb[3 * static_cast<size_t>(point.pixel)],
                        codes)) {
      case PixelKind::kUsed:
        ++counts.used;
        break;
      case PixelKind::kClipped:
        ++counts.clipped;
        break;
      case PixelKind::kNotFinite:
        ++counts.not_finite;
        break;
      case PixelKind::kNegative:
        ++counts.negative;
        break;
      case PixelKind::kZero:
        ++counts.zero;
        break;
    }
  }
  return counts;
}

}  // namespace ibrdf
