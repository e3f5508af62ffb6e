#include "ibrdf/solvers/photograph_check/normal_samples.h"

#include <cmath>

#include "ibrdf/scene/num_views.h"
#include "ibrdf/solvers/photograph_check/pixel_counts.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace {

constexpr double kLeastCosine = 0.2;

}  // namespace

Eigen::Vector3d NormalToViewer(const ShadingPoint& point) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  // The other axis of the frame points left.
  Eigen::Vector3d left, up;
  ViewFrame(wo, Eigen::Vector3d::UnitY(), &up, &left);
  return {-n.dot(left), n.dot(up), n.dot(wo)};
}

std::vector<NormalSample> SampleNormals(
    const Image& radiance, const std::vector<ShadingPoint>& points) {
  std::vector<NormalSample> samples;
  samples.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const int pixel = points[i].pixel;
    const float* const rgb = &radiance.rgb[3 * static_cast<size_t>(pixel)];
    if (KindOfPixel(rgb, false) != PixelKind::kUsed) continue;
    const Eigen::Vector3d normal = NormalToViewer(points[i]);
    if (normal.z() < kLeastCosine) continue;
    NormalSample sample;
    sample.normal = normal.head<2>();
    sample.log_radiance =
        Eigen::Map<const Eigen::Array3f>(rgb).cast<double>().log();
    sample.position = {pixel % radiance.width, pixel / radiance.width};
    sample.point = i;
    sample.view = points[i].view;
    samples.push_back(sample);
  }
  return samples;
}

double ObjectSize(const std::vector<NormalSample>& samples) {
  return std::sqrt(static_cast<double>(samples.size()) / NumViews(samples));
}

}  // namespace ibrdf
