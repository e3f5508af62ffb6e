#include "ibrdf/surface/texel_irradiance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/uncertainty/cosine_lobe.h"

namespace ibrdf {
namespace {

constexpr int kOrder = 10;
constexpr int kPartsWide = 24, kPartsHigh = 12;
// Maps are made as coarse before they are cut into parts.
constexpr int kMapWidth = 256, kMapHeight = 128;

}  // namespace

TexelIrradiance::TexelIrradiance(const Scene& scene, const Image& map,
                                 bool shadowed)
    : scene_(scene),
      shadowed_(shadowed && scene.CastsShadows()),
      basis_(kOrder),
      irradiance_(HarmonicProjection(kOrder, map.height, map.width)
                      .Project(map.rgb.data())) {
  // The cosine is a zonal harmonic about each normal: it scales a degree.
  const std::vector<double> cosine = CosineLobe(basis_);
  for (int l = 0; l <= kOrder; ++l) {
    irradiance_.middleRows(l * l, 2 * l + 1) *=
        cosine[l] * std::sqrt(4.0 * kPi / (2.0 * l + 1.0));
  }
  if (shadowed_) parts_ = PartsOf(ResizeMap(map, kMapHeight, kMapWidth));
}

std::vector<TexelIrradiance::Part> TexelIrradiance::PartsOf(const Image& map) {
  std::vector<Eigen::Vector3d> centre(kPartsWide * kPartsHigh,
                                      Eigen::Vector3d::Zero());
  std::vector<Part> parts(centre.size(),
                          {Eigen::Vector3f::Zero(), Eigen::Array3d::Zero()});
  for (int r = 0; r < map.height; ++r) {
    const double solid_angle = TexelSolidAngle(r, map.height, map.width);
    for (int c = 0; c < map.width; ++c) {
      const size_t part =
          static_cast<size_t>(r * kPartsHigh / map.height) * kPartsWide +
          c * kPartsWide / map.width;
      const Eigen::Array3d power =
          solid_angle *
          Eigen::Map<const Eigen::Array3f>(map.At(c, r)).cast<double>();
      parts[part].power += power;
      centre[part] +=
          power.sum() * MapDirection(r + 0.5, c + 0.5, map.height, map.width);
    }
  }
  std::vector<Part> out;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!(centre[i].norm() > 0.0)) continue;
    out.push_back({centre[i].normalized().cast<float>(), parts[i].power});
  }
  return out;
}

Eigen::Array3d TexelIrradiance::At(const Eigen::Vector3d& position,
                                   const Eigen::Vector3d& normal) const {
  std::vector<double> Y(basis_.count());
  basis_.Evaluate(normal, Y.data());
  const Eigen::Map<const Eigen::VectorXd> y(Y.data(), basis_.count());
  Eigen::Array3d E = (y.transpose() * irradiance_).transpose().array();
  E = E.max(0.0);
  if (!shadowed_) return E;
  std::vector<Eigen::Vector3f> directions;
  std::vector<Eigen::Array3d> light;
  const Eigen::Vector3f n = normal.cast<float>();
  for (const Part& part : parts_) {
    const double cosine = n.dot(part.direction);
    if (cosine <= 0.0) continue;
    directions.push_back(part.direction);
    light.push_back(cosine * part.power);
  }
  if (directions.empty()) return E;
  std::vector<uint8_t> hidden(directions.size());
  scene_.Occluded(position, directions, hidden.data());
  Eigen::Array3d all = Eigen::Array3d::Zero(), passing = all;
  for (size_t i = 0; i < light.size(); ++i) {
    all += light[i];
    if (hidden[i] == 0) passing += light[i];
  }
  return (all > 0.0).select(E * passing / all.max(1e-300), E);
}

}  // namespace ibrdf
