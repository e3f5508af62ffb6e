#include "ibrdf/render/reference_renderer.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {
constexpr double kPi = 3.14159265358979323846;

// A block with this many times the mean power of a block, and a texel this many
// times brighter than its mean, is split into texels.
constexpr double kBrightBlock = 4.0;
constexpr double kUnevenBlock = 1.5;

// Points that share their near samples; more would starve the other threads
// where every point is seen at the same angle.
constexpr int kMaxGroup = 64;
// Rays looked up together; their sum is taken in float.
constexpr int kRayBlock = 128;

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
    : num_threads_(options.num_threads),
      map_(map),
      power_(std::move(light.power)),
      quadrature_(std::move(light.cells), NearOptions(map, options)) {}

struct ReferenceRenderer::PaddedMap::Rays {
  std::vector<float> x, y, z;  // direction
  std::vector<float> f;        // weight times BRDF, four lanes
};

ReferenceRenderer::PaddedMap::PaddedMap(const Image& map)
    : width(map.width),
      height(map.height),
      lanes(size_t{4} * (map.height + 2) * (map.width + 1), 0.0f) {
  for (int r = -1; r <= height; ++r) {
    const int row = std::clamp(r, 0, height - 1);
    for (int c = 0; c <= width; ++c) {
      // Across a pole the other half of the same row lies.
      const int column = (row == r ? c : c + width / 2) % width;
      std::memcpy(&lanes[4 * (static_cast<size_t>(r + 1) * (width + 1) + c)],
                  map.At(column, row), 3 * sizeof(float));
    }
  }
}

Eigen::Array3d ReferenceRenderer::PaddedMap::Gather(
    const Rays& rays, const Eigen::Matrix3f& frame) const {
  const auto load = [](const float* p) {
    Float4 v;
    std::memcpy(&v, p, sizeof(v));
    return v;
  };
  const float rows_per_radian = static_cast<float>(height / kPi);
  const float columns_per_radian = static_cast<float>(width / (2.0 * kPi));
  const auto last_row = static_cast<float>(height) + 0.5f;
  const auto columns = static_cast<float>(width);
  const float tx = frame(0, 0), ty = frame(1, 0), tz = frame(2, 0);
  const float bx = frame(0, 1), by = frame(1, 1), bz = frame(2, 1);
  const float nx = frame(0, 2), ny = frame(1, 2), nz = frame(2, 2);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const size_t count = rays.x.size();
  for (size_t begin = 0; begin < count; begin += kRayBlock) {
    const int n = static_cast<int>(std::min<size_t>(kRayBlock, count - begin));
    const float* const rx = &rays.x[begin];
    const float* const ry = &rays.y[begin];
    const float* const rz = &rays.z[begin];
    float row[kRayBlock], column[kRayBlock];
    for (int k = 0; k < n; ++k) {
      const float x = rx[k] * tx + ry[k] * bx + rz[k] * nx;
      const float y = rx[k] * ty + ry[k] * by + rz[k] * ny;
      const float z = rx[k] * tz + ry[k] * bz + rz[k] * nz;
      const float theta = FastAtan2(std::sqrt(x * x + z * z), y);
      const float phi = FastAtan2(x, z);
      // In rows and columns of the padded map, from its first texel's centre.
      const float r = theta * rows_per_radian + 0.5f;
      const float c = phi * columns_per_radian - 0.5f;
      row[k] = r < last_row ? r : last_row;
      column[k] = c < 0.0f ? c + columns : c;
    }
    Float4 block = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int k = 0; k < n; ++k) {
      const int r = std::min(static_cast<int>(row[k]), height);
      const int c = std::min(static_cast<int>(column[k]), width - 1);
      const float fy = row[k] - static_cast<float>(r);
      const float fx = column[k] - static_cast<float>(c);
      const float* const texel =
          &lanes[4 * (static_cast<size_t>(r) * (width + 1) + c)];
      const float* const below = texel + size_t{4} * (width + 1);
      const Float4 upper = (1 - fx) * load(texel) + fx * load(texel + 4);
      const Float4 lower = (1 - fx) * load(below) + fx * load(below + 4);
      block += load(&rays.f[4 * (begin + k)]) * ((1 - fy) * upper + fy * lower);
    }
    sum += Eigen::Array3d(block[0], block[1], block[2]);
  }
  return sum;
}

template <typename Lookup>
void ReferenceRenderer::ShadeNear(const Eigen::Vector3d& n,
                                  const Eigen::Vector3d& wo,
                                  const Lookup& lookup,
                                  std::vector<NearSample>* samples,
                                  PaddedMap::Rays* rays) const {
  Eigen::Vector3d t, b;
  ViewFrame(n, wo, &t, &b);
  quadrature_.SampleNear(std::clamp(n.dot(wo), 0.0, 1.0),
                         std::max(wo.dot(t), 0.0), samples);
  const size_t count = samples->size();
  for (std::vector<float>* v : {&rays->x, &rays->y, &rays->z}) v->resize(count);
  rays->f.resize(4 * count);
  for (size_t k = 0; k < count; ++k) {
    const NearSample& s = (*samples)[k];
    const Eigen::Array3d f = s.weight * lookup(s.theta_h, s.theta_d, s.phi_d);
    rays->x[k] = static_cast<float>(s.wi.x());
    rays->y[k] = static_cast<float>(s.wi.y());
    rays->z[k] = static_cast<float>(s.wi.z());
    for (int c = 0; c < 3; ++c) rays->f[4 * k + c] = static_cast<float>(f[c]);
    rays->f[4 * k + 3] = 0.0f;
  }
}

template <typename Lookup>
void ReferenceRenderer::RenderWith(const std::vector<ShadingPoint>& points,
                                   const Lookup& lookup, double* E) const {
  const auto normal = [&](int i) {
    return Eigen::Vector3d(points[i].normal.cast<double>().normalized());
  };
  const auto view = [&](int i) {
    return Eigen::Vector3d(points[i].wo.cast<double>().normalized());
  };
  // Groups of points seen at exactly the same angle, each by index.
  std::vector<double> cosine(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    cosine[i] = normal(static_cast<int>(i)).dot(view(static_cast<int>(i)));
  }
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return cosine[a] < cosine[b]; });
  std::vector<size_t> begins;
  for (size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || cosine[order[k]] != cosine[order[begins.back()]] ||
        k - begins.back() == kMaxGroup) {
      begins.push_back(k);
    }
  }
  begins.push_back(order.size());

  struct Scratch {
    std::vector<NearSample> near;
    std::vector<FarSample> far;
    PaddedMap::Rays rays;
  };
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(static_cast<int64_t>(begins.size()) - 1, num_threads_,
              [&](int64_t group, int worker) {
                Scratch& s = scratch[worker];
                const int first = order[begins[group]];
                ShadeNear(normal(first), view(first), lookup, &s.near, &s.rays);
                for (size_t k = begins[group]; k < begins[group + 1]; ++k) {
                  const int i = order[k];
                  const Eigen::Vector3d n = normal(i), wo = view(i);
                  Eigen::Vector3d t, b;
                  ViewFrame(n, wo, &t, &b);
                  Eigen::Matrix3f frame;
                  frame << t.cast<float>(), b.cast<float>(), n.cast<float>();
                  Eigen::Array3d sum = map_.Gather(s.rays, frame);
                  quadrature_.SampleFar(n, wo, &s.far);
                  for (const FarSample& far : s.far) {
                    sum += far.weight *
                           lookup(far.theta_h, far.theta_d, far.phi_d) *
                           power_[far.cell];
                  }
                  for (int c = 0; c < 3; ++c) E[size_t{3} * i + c] = sum[c];
                }
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
