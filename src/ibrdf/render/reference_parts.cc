#include "ibrdf/render/reference_parts.h"

#include <glog/logging.h>

#include <numeric>

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

const ReferenceKernels& ActiveReferenceKernels() {
  return *IBRDF_ACTIVE_KERNEL(kReferenceKernels);
}

QuadratureOptions NearOptions(int map_width, const ReferenceOptions& options) {
  const double finer = std::max(1.0, map_width / 512.0);
  QuadratureOptions q;
  q.near_begin_degrees = options.near_begin_degrees;
  q.near_end_degrees = options.near_end_degrees;
  q.near_rings = static_cast<int>(std::ceil(options.near_rings * finer));
  q.near_ring_samples =
      static_cast<int>(std::ceil(options.near_ring_samples * finer));
  return q;
}

PointFrame::PointFrame(const ShadingPoint& point)
    : n(point.normal.cast<double>().normalized()),
      wo(point.wo.cast<double>().normalized()) {}

Eigen::Matrix3f PointFrame::Axes() const {
  Eigen::Vector3d t, b;
  ViewFrame(n, wo, &t, &b);
  Eigen::Matrix3f axes;
  axes << t.cast<float>(), b.cast<float>(), n.cast<float>();
  return axes;
}

void SampleNearOf(const PointFrame& frame, const PointQuadrature& quadrature,
                  std::vector<NearSample>* samples) {
  Eigen::Vector3d t, b;
  ViewFrame(frame.n, frame.wo, &t, &b);
  quadrature.SampleNear(std::clamp(frame.n.dot(frame.wo), 0.0, 1.0),
                        std::max(frame.wo.dot(t), 0.0), samples);
}

ViewGroups::ViewGroups(const std::vector<ShadingPoint>& points, size_t most)
    : order(points.size()) {
  std::vector<double> cosine(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const PointFrame frame(points[i]);
    cosine[i] = frame.n.dot(frame.wo);
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return cosine[a] < cosine[b]; });
  for (size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || cosine[order[k]] != cosine[order[begins.back()]] ||
        k - begins.back() == most) {
      begins.push_back(k);
    }
  }
  begins.push_back(order.size());
}

PaddedMaps::PaddedMaps(const std::vector<const Image*>& maps, int texel_floats)
    : width(maps[0]->width),
      height(maps[0]->height),
      stride(texel_floats),
      lanes(size_t{1} * texel_floats * (maps[0]->height + 2) *
                (maps[0]->width + 1),
            0.0f) {
  const size_t count = maps.size();
  CHECK_GE(texel_floats, static_cast<int>(3 * count));
  for (size_t l = 0; l < count; ++l) {
    CHECK(maps[l]->width == width && maps[l]->height == height);
    for (int r = -1; r <= height; ++r) {
      const int row = std::clamp(r, 0, height - 1);
      for (int c = 0; c <= width; ++c) {
        // Across a pole the other half of the same row lies.
        const int column = (row == r ? c : c + width / 2) % width;
        float* const texel =
            &lanes[stride * (static_cast<size_t>(r + 1) * (width + 1) + c)];
        const float* const rgb = maps[l]->At(column, row);
        for (int k = 0; k < 3; ++k) texel[k * count + l] = rgb[k];
      }
    }
  }
}

}  // namespace ibrdf
