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
    const MerlTaps taps = MerlTapsAt(theta_h, theta_d, phi_d, 1.0);
    Float4 even = {0.0f, 0.0f, 0.0f, 0.0f}, odd = even;
    for (int k = 0; k < 8; k += 2) {
      even += taps.weight[k] * Lane(taps.bin[k]);
      odd += taps.weight[k + 1] * Lane(taps.bin[k + 1]);
    }
    const Float4 sum = even + odd;
    if (!(sum[3] > 0.0f)) return Eigen::Array3d::Zero();
    const float scale = 1.0f / sum[3];
    return {sum[0] * scale, sum[1] * scale, sum[2] * scale};
  }

 private:
  Float4 Lane(int bin) const {
    Float4 v;
    std::memcpy(&v, &lanes_[size_t{4} * bin], sizeof(v));
    return v;
  }
  std::vector<float> lanes_;
};

}  // namespace

ReferenceRenderer::Light ReferenceRenderer::GatherLight(
    const Image& map, const ReferenceOptions& options) {
  const int block = FarBlockSize(map.height, map.width, options.far_width);
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
  // Cell (y, x) of a map in cells of `side` texels.
  const auto add_range = [&](int y, int x, int side) {
    if (options.shadows == nullptr) return;
    light.ranges.push_back(options.shadows->RangeOf(
        y / side, x / side, map.height / side, map.width / side));
  };
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
        add_range(y0 + k / block, x0 + k % block, 1);
      }
      continue;
    }
    FarCell cell = blocks[b];
    if (centroid.norm() > 0.0) cell.direction = centroid.normalized();
    light.cells.push_back(cell);
    light.power.push_back(power);
    add_range(y0, x0, block);
  }
  for (const FarCell& cell : light.cells) {
    light.solid_angle.push_back(cell.solid_angle);
  }
  return light;
}

ReferenceRenderer::ReferenceRenderer(const Image& map,
                                     const ReferenceOptions& options)
    : ReferenceRenderer(map, GatherLight(map, options), options) {}

ReferenceRenderer::ReferenceRenderer(const Image& map, Light light,
                                     const ReferenceOptions& options)
    : num_threads_(options.num_threads),
      map_({&map}, 4),
      power_(std::move(light.power)),
      solid_angle_(std::move(light.solid_angle)),
      shadows_(options.shadows),
      emitters_(options.emitters),
      ranges_(std::move(light.ranges)),
      quadrature_(std::move(light.cells), NearOptions(map.width, options)) {
  CHECK(emitters_ == nullptr || shadows_ != nullptr);
}

struct ReferenceRenderer::Rays {
  std::vector<float> x, y, z;  // direction
  std::vector<float> f;        // weight times BRDF, four lanes
};

Eigen::Array3d ReferenceRenderer::Gather(const Rays& rays,
                                         const Eigen::Matrix3f& axes,
                                         const uint64_t* hidden,
                                         const SeenEmitters& seen,
                                         const double* emitted) const {
  const Eigen::Vector3d normal = axes.col(2).cast<double>();
  const auto load = [](const float* p) {
    Float4 v;
    std::memcpy(&v, p, sizeof(v));
    return v;
  };
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const size_t count = rays.x.size();
  for (size_t begin = 0; begin < count; begin += kRayBlock) {
    const int n = static_cast<int>(std::min<size_t>(kRayBlock, count - begin));
    float row[kRayBlock], column[kRayBlock];
    kernels_.place_rays(&rays.x[begin], &rays.y[begin], &rays.z[begin], n,
                        axes.data(), map_.height, map_.width, row, column);
    float visible[kRayBlock];
    if (hidden != nullptr) {
      float grid_row[kRayBlock], grid_column[kRayBlock];
      kernels_.place_rays(&rays.x[begin], &rays.y[begin], &rays.z[begin], n,
                          axes.data(), shadows_->rows(), shadows_->columns(),
                          grid_row, grid_column);
      for (int k = 0; k < n; ++k) {
        visible[k] = static_cast<float>(
            shadows_->VisibleAt(hidden, normal, grid_row[k], grid_column[k]));
      }
    }
    Float4 block = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int k = 0; k < n; ++k) {
      if (hidden != nullptr && visible[k] < 1.0f && !seen.empty()) {
        const Eigen::Vector3f wi =
            axes * Eigen::Vector3f(rays.x[begin + k], rays.y[begin + k],
                                   rays.z[begin + k]);
        const int emitter = emitters_->Along(seen, wi.cast<double>());
        if (emitter >= 0) {
          const double* const R = emitted + size_t{3} * emitter;
          const Float4 light = {static_cast<float>(R[0]),
                                static_cast<float>(R[1]),
                                static_cast<float>(R[2]), 0.0f};
          block += (1.0f - visible[k]) * load(&rays.f[4 * (begin + k)]) * light;
        }
      }
      if (hidden != nullptr && visible[k] == 0.0f) continue;
      const int r = std::min(static_cast<int>(row[k]), map_.height);
      const int c = std::min(static_cast<int>(column[k]), map_.width - 1);
      const float fy = row[k] - static_cast<float>(r);
      const float fx = column[k] - static_cast<float>(c);
      const float* const texel =
          &map_.lanes[4 * (static_cast<size_t>(r) * (map_.width + 1) + c)];
      const float* const below = texel + size_t{4} * (map_.width + 1);
      const Float4 upper = (1 - fx) * load(texel) + fx * load(texel + 4);
      const Float4 lower = (1 - fx) * load(below) + fx * load(below + 4);
      Float4 light = (1 - fy) * upper + fy * lower;
      if (hidden != nullptr) light *= visible[k];
      block += load(&rays.f[4 * (begin + k)]) * light;
    }
    sum += Eigen::Array3d(block[0], block[1], block[2]);
  }
  return sum;
}

template <typename Lookup>
void ReferenceRenderer::ShadeNear(const PointFrame& frame, const Lookup& lookup,
                                  std::vector<NearSample>* samples,
                                  Rays* rays) const {
  SampleNearOf(frame, quadrature_, samples);
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
                                   const Lookup& lookup, const double* emitted,
                                   double* E) const {
  const ViewGroups groups(points);
  struct Scratch {
    std::vector<NearSample> near;
    std::vector<FarSample> far;
    Rays rays;
    VisibilityGrid::Scratch trace;
    VisibilityGrid::Bits bits;
    std::vector<SeenEmitter> seen;
    std::vector<EmitterShare> shares;
  };
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t group, int worker) {
    Scratch& s = scratch[worker];
    const size_t begin = groups.begins[group];
    ShadeNear(PointFrame(points[groups.order[begin]]), lookup, &s.near,
              &s.rays);
    for (size_t k = begin; k < groups.begins[group + 1]; ++k) {
      const int i = groups.order[k];
      const PointFrame frame(points[i]);
      const uint64_t* const hidden =
          shadows_ != nullptr && shadows_->Trace(points[i], &s.trace, &s.bits)
              ? s.bits.data()
              : nullptr;
      SeenEmitters seen;
      if (hidden != nullptr && emitted != nullptr && emitters_ != nullptr) {
        seen = emitters_->Look(points[i], *shadows_, hidden, &s.seen);
      }
      Eigen::Array3d sum = Gather(s.rays, frame.Axes(), hidden, seen, emitted);
      quadrature_.SampleFar(frame.n, frame.wo, &s.far);
      for (const FarSample& far : s.far) {
        const double visible =
            hidden == nullptr
                ? 1.0
                : shadows_->VisibleShare(hidden, frame.n, ranges_[far.cell]);
        if (visible == 0.0 && seen.empty()) continue;
        Eigen::Array3d light = visible * power_[far.cell];
        if (visible < 1.0 && !seen.empty()) {
          emitters_->SharesIn(*shadows_, hidden, frame.n, ranges_[far.cell],
                              seen, &s.shares);
          for (const EmitterShare& e : s.shares) {
            light += e.share * solid_angle_[far.cell] *
                     Eigen::Map<const Eigen::Array3d>(emitted +
                                                      size_t{3} * e.emitter);
          }
        }
        sum += far.weight * lookup(far.theta_h, far.theta_d, far.phi_d) * light;
      }
      for (int c = 0; c < 3; ++c) E[size_t{3} * i + c] = sum[c];
    }
  });
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const MerlTable& table, double* E,
                               const double* emitted) const {
  RenderWith(points, MerlSampler(table), emitted, E);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const BrdfFunction& brdf, double* E,
                               const double* emitted) const {
  RenderWith(points, brdf, emitted, E);
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
