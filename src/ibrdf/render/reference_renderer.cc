#include "ibrdf/render/reference_renderer.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {
constexpr double kPi = 3.14159265358979323846;

// A block with this many times the mean power of a block, and a texel this many
// times brighter than its mean, is split into texels.
constexpr double kBrightBlock = 4.0;
constexpr double kUnevenBlock = 1.5;

using Float4 [[gnu::vector_size(16)]] = float;

// InterpolateMerl in float: four lanes per bin, the last one 1 where the bin is
// valid, so that one trilinear sum gives values and weights.
class MerlSampler {
 public:
  explicit MerlSampler(const MerlTable& table)
      : lanes_(size_t{4} * kMerlBins, 0.0f) {
    for (int bin = 0; bin < kMerlBins; ++bin) {
      if (table.Raw(0, bin) < 0.0) continue;
      for (int c = 0; c < 3; ++c) {
        lanes_[size_t{4} * bin + c] = static_cast<float>(
            std::max(table.Raw(c, bin), 0.0) * kMerlScale[c]);
      }
      lanes_[size_t{4} * bin + 3] = 1.0f;
    }
  }

  Eigen::Array3d operator()(double theta_h, double theta_d,
                            double phi_d) const {
    const auto x =
        static_cast<float>(std::sqrt(theta_h * (2 / kPi)) * kMerlThetaH - 0.5);
    const auto y = static_cast<float>(theta_d * (2 / kPi) * kMerlThetaD - 0.5);
    const auto z = static_cast<float>(phi_d * (1 / kPi) * kMerlPhiD - 0.5);
    const float x0 = std::floor(x), y0 = std::floor(y), z0 = std::floor(z);
    const float fx = x - x0, fy = y - y0, fz = z - z0;
    const auto clamp = [](int i, int n) { return std::clamp(i, 0, n - 1); };
    const int i = static_cast<int>(x0), j = static_cast<int>(y0);
    const int i0 = clamp(i, kMerlThetaH), i1 = clamp(i + 1, kMerlThetaH);
    const int j0 = clamp(j, kMerlThetaD), j1 = clamp(j + 1, kMerlThetaD);
    int k0 = static_cast<int>(z0);
    if (k0 < 0) k0 += kMerlPhiD;
    if (k0 >= kMerlPhiD) k0 -= kMerlPhiD;
    const int k1 = k0 + 1 < kMerlPhiD ? k0 + 1 : 0;
    const auto row = [&](int a, int b) {
      return (1 - fz) * Lane(a, b, k0) + fz * Lane(a, b, k1);
    };
    const Float4 sum = (1 - fx) * ((1 - fy) * row(i0, j0) + fy * row(i0, j1)) +
                       fx * ((1 - fy) * row(i1, j0) + fy * row(i1, j1));
    if (!(sum[3] > 0.0f)) return Eigen::Array3d::Zero();
    const float scale = 1.0f / sum[3];
    return {sum[0] * scale, sum[1] * scale, sum[2] * scale};
  }

 private:
  Float4 Lane(int i, int j, int k) const {
    Float4 v;
    std::memcpy(&v, &lanes_[size_t{4} * MerlTable::Bin(i, j, k)], sizeof(v));
    return v;
  }
  std::vector<float> lanes_;
};

}  // namespace

QuadratureOptions ReferenceRenderer::NearOptions(
    const Image& map, const ReferenceOptions& options) {
  const double finer = std::max(1.0, map.width / 512.0);
  QuadratureOptions q;
  q.near_begin_degrees = options.near_begin_degrees;
  q.near_end_degrees = options.near_end_degrees;
  q.near_rings = static_cast<int>(std::ceil(options.near_rings * finer));
  q.near_ring_samples =
      static_cast<int>(std::ceil(options.near_ring_samples * finer));
  return q;
}

ReferenceRenderer::Light ReferenceRenderer::GatherLight(const Image& map,
                                                        int far_width) {
  const int block = FarBlockSize(map.height, map.width, far_width);
  const std::vector<FarCell> texels = MapCells(map.height, map.width, 1);
  const std::vector<FarCell> blocks = MapCells(map.height, map.width, block);
  const int columns = map.width / block;
  const auto power_of = [&](int texel) {
    const float* rgb = map.rgb.data() + size_t{3} * texel;
    return Eigen::Array3d(Eigen::Array3d(rgb[0], rgb[1], rgb[2]) *
                          texels[texel].solid_angle);
  };
  double total = 0.0;
  for (size_t t = 0; t < texels.size(); ++t) {
    total += power_of(static_cast<int>(t)).abs().sum();
  }
  Light light;
  for (size_t b = 0; b < blocks.size(); ++b) {
    const int y0 = static_cast<int>(b) / columns * block;
    const int x0 = static_cast<int>(b) % columns * block;
    Eigen::Array3d power = Eigen::Array3d::Zero();
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    double sum = 0.0, peak = 0.0;
    for (int k = 0; k < block * block; ++k) {
      const int texel = (y0 + k / block) * map.width + x0 + k % block;
      const Eigen::Array3d p = power_of(texel);
      const double strength = p.abs().sum();
      power += p;
      centroid += strength * texels[texel].direction;
      sum += strength;
      peak = std::max(peak, strength);
    }
    const bool bright =
        sum * static_cast<double>(blocks.size()) > kBrightBlock * total;
    if (bright && peak * block * block > kUnevenBlock * sum) {
      for (int k = 0; k < block * block; ++k) {
        const int texel = (y0 + k / block) * map.width + x0 + k % block;
        light.cells.push_back(texels[texel]);
        light.power.push_back(power_of(texel));
      }
      continue;
    }
    FarCell cell = blocks[b];
    if (centroid.norm() > 0.0) cell.direction = centroid.normalized();
    light.cells.push_back(cell);
    light.power.push_back(power);
  }
  return light;
}

ReferenceRenderer::ReferenceRenderer(const Image& map,
                                     const ReferenceOptions& options)
    : ReferenceRenderer(map, GatherLight(map, options.far_width), options) {}

ReferenceRenderer::ReferenceRenderer(const Image& map, Light light,
                                     const ReferenceOptions& options)
    : map_(map),
      num_threads_(options.num_threads),
      power_(std::move(light.power)),
      quadrature_(std::move(light.cells), NearOptions(map, options)) {}

template <typename Lookup>
void ReferenceRenderer::RenderWith(const std::vector<ShadingPoint>& points,
                                   const Lookup& lookup, double* E) const {
  const int num_workers = num_threads_ > 0 ? num_threads_ : HardwareThreads();
  std::vector<PointSamples> scratch(num_workers);
  ParallelFor(static_cast<int64_t>(points.size()), num_threads_,
              [&](int64_t i, int worker) {
                PointSamples& samples = scratch[worker];
                quadrature_.Sample(points[i].normal.cast<double>().normalized(),
                                   points[i].wo.cast<double>().normalized(),
                                   &samples);
                Eigen::Array3d sum = Eigen::Array3d::Zero();
                for (const NearSample& s : samples.near) {
                  sum += s.weight * lookup(s.theta_h, s.theta_d, s.phi_d) *
                         LookUpMap(map_, s.wi);
                }
                for (const FarSample& s : samples.far) {
                  sum += s.weight * lookup(s.theta_h, s.theta_d, s.phi_d) *
                         power_[s.cell];
                }
                for (int c = 0; c < 3; ++c) E[3 * i + c] = sum[c];
              });
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const MerlTable& table, double* E) const {
  RenderWith(points, MerlSampler(table), E);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const BrdfFunction& brdf, double* E) const {
  RenderWith(points, brdf, E);
}

Image PixelMeans(const std::vector<ShadingPoint>& points, const double* E,
                 int width, int height) {
  Image image(width, height);
  std::vector<double> sums(image.rgb.size(), 0.0);
  std::vector<double> coverage(image.num_pixels(), 0.0);
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t pixel = points[i].pixel;
    CHECK_LT(pixel, coverage.size());
    coverage[pixel] += points[i].coverage;
    for (int c = 0; c < 3; ++c) {
      sums[3 * pixel + c] += points[i].coverage * E[3 * i + c];
    }
  }
  for (size_t k = 0; k < sums.size(); ++k) {
    if (coverage[k / 3] > 0.0) {
      image.rgb[k] = static_cast<float>(sums[k] / coverage[k / 3]);
    }
  }
  return image;
}

}  // namespace ibrdf
