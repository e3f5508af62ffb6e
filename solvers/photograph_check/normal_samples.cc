#include "ibrdf/solvers/photograph_check/normal_samples.h"

#include <cmath>
#include <optional>

#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace {

constexpr double kLeastCosine = 0.2;

}  // namespace

Eigen::Vector3d NormalToViewer(const ShadingPoint& point) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  Eigen::Vector3d right, up;
  ViewFrame(wo, Eigen::Vector3d::UnitY(), &up, &right);
  return {n.dot(right), n.dot(up), n.dot(wo)};
}

std::vector<NormalSample> SampleNormals(
    const Image& radiance, const std::vector<ShadingPoint>& points) {
  std::vector<NormalSample> samples;
  samples.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const int pixel = points[i].pixel;
    const float* const rgb = &radiance.rgb[3 * static_cast<size_t>(pixel)];
    const double value[3] = {rgb[0], rgb[1], rgb[2]};
    const std::optional<Eigen::Vector2d> normal =
        NormalInView(points[i], value, kLeastCosine);
    if (!normal.has_value()) continue;
    NormalSample sample;
    sample.normal = *normal;
    sample.log_radiance = Eigen::Map<const Eigen::Array3d>(value).log();
    sample.position = {pixel % radiance.width, pixel / radiance.width};
    sample.point = i;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace ibrdf
