// Log radiance of an environment map.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {

// Magnitudes beyond which exp() of log radiance is not taken.
//
// The limit for a map of floats, either way: e^60 is 1e26, which renders may
// multiply by a BRDF and sum over a map before a float, at most e^88,
// overflows; and e^-60 is far from float's denormal numbers, which are slow.
inline constexpr float kMaxLogRadiance = 60.0f;
// The limit for the marginal likelihood's light, from above alone: doubles hold
// e^80 and its squares, so that a step which goes far too bright has a cost and
// is turned down for that.
inline constexpr double kMaxLogRadianceInDouble = 80.0;

// Planes [3][height][width], a channel each, of an equirectangular map's log
// radiance, or of a change of it.
class LogMap {
 public:
  using PlaneMatrix =
      Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  LogMap() = default;
  // Zeros.
  explicit LogMap(MapSize size) : size_(size), values_(3 * size.num_texels()) {}
  // CHECKs that there is a value for each texel and channel.
  LogMap(MapSize size, std::vector<float> planes);

  MapSize size() const { return size_; }
  size_t num_texels() const { return size_.num_texels(); }
  // All three planes.
  const std::vector<float>& values() const { return values_; }
  float* data() { return values_.data(); }
  const float* data() const { return values_.data(); }
  // [height, width] of a channel.
  Eigen::Map<PlaneMatrix> Plane(int channel) {
    return {data() + channel * num_texels(), size_.height, size_.width};
  }
  Eigen::Map<const PlaneMatrix> Plane(int channel) const {
    return {data() + channel * num_texels(), size_.height, size_.width};
  }
  // Another size; values are then unspecified.
  void Reshape(MapSize size);

  // Radiance [height, width, 3], exp of the values clamped to
  // +-kMaxLogRadiance. slopes, where not null: its derivatives by the log
  // radiance, in the same order: radiance again, but 0 where that is clamped.
  void Exp(std::vector<float>* map, std::vector<float>* slopes = nullptr) const;

  // The map at another size, by ResamplePlanes.
  LogMap Resized(MapSize size) const;

  // Mean of each channel over the sphere.
  Eigen::Array3d Mean() const;

 private:
  MapSize size_;
  std::vector<float> values_;
};

// Products with the derivative of LogMap::Exp, from its slopes: the change
// [height, width, 3] of radiance with one of log radiance, and, added to
// `by_log`, the gradient in log radiance of sum by_map . radiance.
void ExpJvp(const std::vector<float>& slopes, const LogMap& d_log,
            std::vector<float>* d_map);
void AddExpVjp(const std::vector<float>& slopes,
               const std::vector<float>& by_map, LogMap* by_log);

// Radiance [texels, 3] of log radiance [3][texels], its largest value 1: for
// ratios, in which the level cancels. Nothing is clamped.
std::vector<float> RelativeMap(const double* log_radiance, int num_texels);

// The image of planes [3][height][width].
template <typename Real>
Image FromPlanes(const std::vector<Real>& planes, int width, int height) {
  Image image(width, height);
  const size_t texels = image.num_pixels();
  for (size_t i = 0; i < 3 * texels; ++i) {
    image.rgb[i] = static_cast<float>(planes[i % 3 * texels + i / 3]);
  }
  return image;
}

}  // namespace ibrdf
