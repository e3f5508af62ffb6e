#include "ibrdf/solvers/report/check_panels.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {
namespace {

constexpr float kDarkGround = 0.012f;
constexpr double kMostDeviation = 0.3;

const Eigen::Vector3d kLamp = Eigen::Vector3d(-1.0, 1.0, 1.2).normalized();

float Lit(const Eigen::Vector3d& normal) {
  constexpr double kAmbient = 0.06;
  return static_cast<float>(kAmbient + (1.0 - kAmbient) *
                                           std::max(normal.dot(kLamp), 0.0));
}

void Fill(float* rgb, float value) { std::fill(rgb, rgb + 3, value); }

Image DarkGround(int width, int height) {
  Image image(width, height);
  std::fill(image.rgb.begin(), image.rgb.end(), kDarkGround);
  return image;
}

size_t At(const ShadingPoint& point) {
  return 3 * static_cast<size_t>(point.pixel);
}

}  // namespace

Image ExposedPhotograph(const Image& radiance, const Mask& mask) {
  const double exposure = ExposureOf(radiance, mask, 99.0);
  Image out(radiance.width, radiance.height);
  for (size_t k = 0; k < out.rgb.size(); ++k) {
    const double v = radiance.rgb[k] * exposure;
    // Clipped values are as bright as can be shown.
    out.rgb[k] =
        std::isnan(v) ? 1.0f : static_cast<float>(std::clamp(v, 0.0, 1.0));
  }
  return out;
}

Image NormalColours(const std::vector<ShadingPoint>& points,
                    const Image& photograph) {
  Image out = photograph;
  for (float& v : out.rgb) v *= 0.3f;
  for (const ShadingPoint& point : points) {
    const Eigen::Vector3d n = NormalToViewer(point);
    for (int c = 0; c < 3; ++c) {
      out.rgb[At(point) + c] = static_cast<float>(
          DecodeSrgb(std::clamp(0.5 * (n[c] + 1.0), 0.0, 1.0)));
    }
  }
  return out;
}

Image LampLit(const std::vector<ShadingPoint>& points, int width, int height) {
  Image out = DarkGround(width, height);
  for (const ShadingPoint& point : points) {
    Fill(&out.rgb[At(point)], Lit(NormalToViewer(point)));
  }
  return out;
}

Image LampLit(const Image& normals, const Mask& mask) {
  Image out = DarkGround(normals.width, normals.height);
  for (size_t i = 0; i < normals.num_pixels(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> n(&normals.rgb[3 * i]);
    if (!mask.Holds(i) || n.isZero()) continue;
    Fill(&out.rgb[3 * i], n.z() < 0.0f ? 0.0f : Lit(n.cast<double>()));
  }
  return out;
}

Image MaskAndShape(const Mask& mask, const Mask& silhouette) {
  Image out = DarkGround(silhouette.width, silhouette.height);
  for (size_t i = 0; i < silhouette.inside.size(); ++i) {
    const bool in_mask = mask.Holds(i), sees = silhouette.inside[i] != 0;
    float* const rgb = &out.rgb[3 * i];
    if (in_mask && sees) {
      Fill(rgb, 0.8f);
    } else if (in_mask) {
      rgb[0] = 0.8f;
      rgb[1] = rgb[2] = 0.02f;
    } else if (sees) {
      rgb[0] = 0.02f;
      rgb[1] = 0.15f;
      rgb[2] = 0.9f;
    }
  }
  return out;
}

const char* NameOf(Mark mark) {
  static constexpr const char* kNames[kNumMarks] = {
      "clipped", "zero", "negative", "not finite", "no normal"};
  return kNames[static_cast<int>(mark)];
}

void ColourOf(Mark mark, float rgb[3]) {
  static constexpr float kColours[kNumMarks][3] = {{0.9f, 0.02f, 0.02f},
                                                   {0.02f, 0.2f, 0.95f},
                                                   {0.8f, 0.05f, 0.7f},
                                                   {0.9f, 0.7f, 0.02f},
                                                   {0.02f, 0.55f, 0.1f}};
  std::copy_n(kColours[static_cast<int>(mark)], 3, rgb);
}

Image MarkedPixels(const ObjectLook& look,
                   const std::vector<ShadingPoint>& points,
                   const Image& photograph) {
  Image out(photograph.width, photograph.height);
  for (size_t i = 0; i < out.num_pixels(); ++i) {
    const float* const rgb = &photograph.rgb[3 * i];
    Fill(&out.rgb[3 * i], 0.15f * (rgb[0] + rgb[1] + rgb[2]) / 3.0f);
    if (!look.mask.empty() && look.mask.Holds(i) &&
        look.silhouette.inside[i] == 0) {
      ColourOf(Mark::kUnseen, &out.rgb[3 * i]);
    }
  }
  for (const ShadingPoint& point : points) {
    float* const rgb = &out.rgb[At(point)];
    switch (KindOfPixel(&look.radiance.rgb[At(point)], look.check.codes)) {
      case PixelKind::kUsed:
        for (int c = 0; c < 3; ++c) rgb[c] *= 3.0f;
        break;
      case PixelKind::kClipped:
        ColourOf(Mark::kClipped, rgb);
        break;
      case PixelKind::kZero:
        ColourOf(Mark::kZero, rgb);
        break;
      case PixelKind::kNegative:
        ColourOf(Mark::kNegative, rgb);
        break;
      case PixelKind::kNotFinite:
        ColourOf(Mark::kNotFinite, rgb);
        break;
    }
  }
  return out;
}

Image ColourDeviations(const LikeNormalsSpread& spread,
                       const std::vector<ShadingPoint>& points, int width,
                       int height) {
  Image out = DarkGround(width, height);
  for (size_t i = 0; i < points.size(); ++i) {
    const float deviation = spread.colour_of_point[i];
    float* const rgb = &out.rgb[At(points[i])];
    if (std::isnan(deviation)) {
      Fill(rgb, 0.1f);
      continue;
    }
    uint8_t bytes[3];
    DivergingColour(deviation / kMostDeviation, bytes);
    for (int c = 0; c < 3; ++c) {
      rgb[c] = static_cast<float>(DecodeSrgb(bytes[c] / 255.0));
    }
  }
  return out;
}

}  // namespace ibrdf
