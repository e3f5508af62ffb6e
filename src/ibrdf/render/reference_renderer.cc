#include "ibrdf/render/reference_renderer.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

// A block with this many times the mean power of a block, and a texel this many
// times brighter than its mean, is split into texels.
constexpr double kBrightBlock = 4.0;
constexpr double kUnevenBlock = 1.5;

// A narrow lobe gets rays of its own, whose half-vectors lie within this many
// times its half width of the normal.
constexpr double kLobeWidths = 2.5;
// Fewer from bounce to bounce.
constexpr int kFewerRays = 4;

// Between samples of a bright texel, in half widths of the lobe; at most so
// many along a side.
constexpr double kBrightStep = 0.25;
constexpr int kMostBrightSamples = 16;

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
    : ReferenceRenderer(
          options.split_bright ? SplitBrightTexels(map) : BrightTexels{{}, map},
          options) {
  const ReferenceOptions defaults;
  if (lobe_rays_ == 0 || options.near_rings < defaults.near_rings) return;
  coarser_ = std::make_unique<ReferenceRenderer>(map, Coarser(options));
}

ReferenceRenderer::ReferenceRenderer(const BrightTexels& map,
                                     const ReferenceOptions& options)
    : ReferenceRenderer(map, GatherLight(map.rest, options), options) {}

ReferenceRenderer::ReferenceRenderer(const BrightTexels& map, Light light,
                                     const ReferenceOptions& options)
    : num_threads_(options.num_threads),
      lobe_rays_(options.lobe_rays),
      bright_(map.texels),
      map_({&map.rest}, 4),
      power_(std::move(light.power)),
      solid_angle_(std::move(light.solid_angle)),
      shadows_(options.shadows),
      patches_(options.patches),
      ranges_(std::move(light.ranges)),
      quadrature_(std::move(light.cells),
                  NearOptions(map.rest.width, options)) {
  CHECK(patches_ == nullptr || shadows_ != nullptr);
  CHECK(lobe_rays_ >= 0 && (lobe_rays_ & (lobe_rays_ - 1)) == 0);
}

struct ReferenceRenderer::Common {
  // Radians, 0: lobes have no rays of their own. These have half-vectors within
  // it of the normal.
  double lobe_width = 0.0;
  std::vector<BrightSample> bright;
};

int ReferenceRenderer::BrightSamplesPerSide(double lobe_half_width) const {
  // A texel's light spreads over two; the lobe turns twice as far as
  // half-vectors do.
  const double width = 2.0 * kPi / map_.height;
  const double step = kBrightStep * 2.0 * lobe_half_width;
  return 2 * std::clamp(static_cast<int>(std::ceil(0.5 * width / step)), 1,
                        kMostBrightSamples / 2);
}

template <typename Lookup>
Eigen::Array3d ReferenceRenderer::GatherBright(
    const PointFrame& frame, const std::vector<BrightSample>& bright,
    const Lookup& lookup, const uint64_t* hidden) const {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  if (bright.empty()) return sum;
  const Eigen::Matrix3d axes = frame.Axes().cast<double>();
  const Eigen::Vector3d wo = axes.transpose() * frame.wo;
  for (const BrightSample& sample : bright) {
    const double cosine = frame.n.dot(sample.direction);
    if (cosine <= 0.0) continue;
    const double visible =
        hidden == nullptr
            ? 1.0
            : shadows_->VisibleAlong(hidden, frame.n, sample.direction);
    if (visible == 0.0) continue;
    const HalfDiff angles = ToHalfDiff(axes.transpose() * sample.direction, wo);
    sum += visible * cosine *
           lookup(angles.theta_h, angles.theta_d, angles.phi_d) * sample.power;
  }
  return sum;
}

struct ReferenceRenderer::Rays {
  std::vector<float> x, y, z;  // direction
  std::vector<float> f;        // weight times BRDF, four lanes
  std::vector<int> bundle;     // of the first rays, -1: none
};

Eigen::Array3d ReferenceRenderer::Gather(const Rays& rays,
                                         const Eigen::Matrix3f& axes,
                                         const Sight& sight) const {
  const uint64_t* const hidden = sight.hidden;
  // Radiance of what hides ray k; null: black.
  const auto object = [&](size_t k) -> const double* {
    if (sight.lobe != nullptr && k < rays.bundle.size() &&
        rays.bundle[k] >= 0) {
      const double* const R = sight.lobe + size_t{3} * rays.bundle[k];
      if (R[0] >= 0.0) return R;
    }
    if (sight.seen.empty()) return nullptr;
    const Eigen::Vector3f wi =
        axes * Eigen::Vector3f(rays.x[k], rays.y[k], rays.z[k]);
    const int patch = patches_->Along(sight.seen, wi.cast<double>());
    return patch < 0 ? nullptr : sight.emitted + size_t{3} * patch;
  };
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
      if (hidden != nullptr && visible[k] < 1.0f) {
        if (const double* const R = object(begin + k)) {
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
  rays->bundle.clear();
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

std::vector<Eigen::Vector3f> ReferenceRenderer::Bundle(
    const std::vector<NearSample>& samples, double lobe_width, int count,
    Rays* rays) {
  std::vector<Eigen::Vector3f> directions;
  std::vector<float> weights;
  std::vector<size_t> place;
  for (size_t k = 0; k < samples.size(); ++k) {
    if (samples[k].theta_h > lobe_width) continue;
    const float* const f = &rays->f[4 * k];
    directions.emplace_back(rays->x[k], rays->y[k], rays->z[k]);
    weights.push_back(std::max(f[0] + f[1] + f[2], 0.0f));
    place.push_back(k);
  }
  LobeBundles bundles = BundleDirections(directions, weights, count);
  rays->bundle.assign(samples.size(), -1);
  for (size_t i = 0; i < place.size(); ++i) {
    rays->bundle[place[i]] = bundles.of[i];
  }
  return std::move(bundles.means);
}

template <typename Lookup>
std::vector<double> ReferenceRenderer::LightOfLobes(
    int depth, int count, const Common& common, const ViewGroups& groups,
    const std::vector<ShadingPoint>& points, const Lookup& lookup,
    const EmittedLight& emitted) const {
  if (points.empty()) return {};
  std::vector<ShadingPoint> met(points.size() * count, points[0]);
  std::vector<char> is_met(met.size(), 0);
  struct Scratch {
    std::vector<NearSample> near;
    Rays rays;
  };
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t group, int worker) {
    Scratch& s = scratch[worker];
    const size_t begin = groups.begins[group];
    ShadeNear(PointFrame(points[groups.order[begin]]), lookup, &s.near,
              &s.rays);
    const std::vector<Eigen::Vector3f> lobe =
        Bundle(s.near, common.lobe_width, count, &s.rays);
    for (size_t k = begin; k < groups.begins[group + 1]; ++k) {
      const int i = groups.order[k];
      const Eigen::Matrix3d axes = PointFrame(points[i]).Axes().cast<double>();
      for (size_t r = 0; r < lobe.size(); ++r) {
        if (lobe[r].isZero()) continue;
        const size_t at = size_t{1} * i * count + r;
        const Eigen::Vector3d wi = axes * lobe[r].cast<double>();
        is_met[at] = patches_->Meet(points[i], wi, &met[at]) ? 1 : 0;
      }
    }
  });
  std::vector<ShadingPoint> some;
  for (size_t k = 0; k < met.size(); ++k) {
    if (is_met[k] != 0) some.push_back(met[k]);
  }
  std::vector<double> radiance(3 * some.size());
  if (!some.empty()) {
    const ReferenceRenderer& next = coarser_ != nullptr ? *coarser_ : *this;
    // The last bounce shows what the map alone lights.
    EmittedLight light = emitted;
    if (depth + 1 >= emitted.bounces) light.radiance = nullptr;
    next.RenderAt(depth + 1, common, some, lookup, light, radiance.data());
  }
  std::vector<double> light(3 * met.size(), -1.0);
  for (size_t k = 0, from = 0; k < met.size(); ++k) {
    if (is_met[k] != 0) std::copy_n(&radiance[3 * from++], 3, &light[3 * k]);
  }
  return light;
}

template <typename Lookup>
void ReferenceRenderer::RenderWith(const std::vector<ShadingPoint>& points,
                                   const Lookup& lookup,
                                   const EmittedLight& emitted,
                                   double* L_o) const {
  Common common;
  const bool follow =
      lobe_rays_ > 0 && patches_ != nullptr && emitted.radiance != nullptr;
  if (follow || !bright_.empty()) {
    const double half = LobeHalfWidth(std::cref(lookup));
    if (follow && half < kNarrowLobe) common.lobe_width = kLobeWidths * half;
    common.bright = SampleBrightTexels(bright_, map_.height, map_.width,
                                       BrightSamplesPerSide(half));
  }
  RenderAt(0, common, points, lookup, emitted, L_o);
}

template <typename Lookup>
void ReferenceRenderer::RenderAt(int depth, const Common& common,
                                 const std::vector<ShadingPoint>& points,
                                 const Lookup& lookup,
                                 const EmittedLight& emitted,
                                 double* L_o) const {
  const ViewGroups groups(points);
  int lobe_rays = 0;
  std::vector<double> of_lobes;
  if (common.lobe_width > 0.0 && depth < emitted.bounces) {
    lobe_rays = lobe_rays_;
    for (int k = 0; k < depth; ++k) lobe_rays /= kFewerRays;
    lobe_rays = std::max(lobe_rays, 1);
    of_lobes =
        LightOfLobes(depth, lobe_rays, common, groups, points, lookup, emitted);
  }
  struct Scratch {
    std::vector<NearSample> near;
    std::vector<FarSample> far;
    Rays rays;
    VisibilityGrid::Scratch trace;
    VisibilityGrid::Bits bits;
    std::vector<SeenPatch> seen;
    std::vector<PatchShare> shares;
  };
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t group, int worker) {
    Scratch& s = scratch[worker];
    const size_t begin = groups.begins[group];
    ShadeNear(PointFrame(points[groups.order[begin]]), lookup, &s.near,
              &s.rays);
    if (lobe_rays > 0) Bundle(s.near, common.lobe_width, lobe_rays, &s.rays);
    for (size_t k = begin; k < groups.begins[group + 1]; ++k) {
      const int i = groups.order[k];
      const PointFrame frame(points[i]);
      Sight sight;
      if (shadows_ != nullptr &&
          shadows_->Trace(points[i], &s.trace, &s.bits)) {
        sight.hidden = s.bits.data();
      }
      if (sight.hidden != nullptr && emitted.radiance != nullptr &&
          patches_ != nullptr) {
        sight.seen =
            patches_->Look(points[i], *shadows_, sight.hidden, &s.seen);
        sight.emitted = emitted.radiance;
      }
      if (lobe_rays > 0) sight.lobe = &of_lobes[size_t{3} * lobe_rays * i];
      Eigen::Array3d sum = Gather(s.rays, frame.Axes(), sight);
      sum += GatherBright(frame, common.bright, lookup, sight.hidden);
      quadrature_.SampleFar(frame.n, frame.wo, &s.far);
      for (const FarSample& far : s.far) {
        const double visible =
            sight.hidden == nullptr
                ? 1.0
                : shadows_->VisibleShare(sight.hidden, frame.n,
                                         ranges_[far.cell]);
        if (visible == 0.0 && sight.seen.empty()) continue;
        Eigen::Array3d light = visible * power_[far.cell];
        if (visible < 1.0 && !sight.seen.empty()) {
          patches_->SharesIn(*shadows_, sight.hidden, frame.n,
                             ranges_[far.cell], sight.seen, &s.shares);
          for (const PatchShare& e : s.shares) {
            light += e.share * solid_angle_[far.cell] *
                     Eigen::Map<const Eigen::Array3d>(emitted.radiance +
                                                      size_t{3} * e.patch);
          }
        }
        sum += far.weight * lookup(far.theta_h, far.theta_d, far.phi_d) * light;
      }
      for (int c = 0; c < 3; ++c) L_o[size_t{3} * i + c] = sum[c];
    }
  });
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const MerlTable& table, double* L_o,
                               const EmittedLight& emitted) const {
  RenderWith(points, MerlSampler(table), emitted, L_o);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const BrdfFunction& brdf, double* L_o,
                               const EmittedLight& emitted) const {
  RenderWith(points, brdf, emitted, L_o);
}

Image PixelMeans(const std::vector<ShadingPoint>& points, const double* L_o,
                 int width, int height) {
  Image image(width, height);
  std::vector<double> sums(image.rgb.size(), 0.0);
  std::vector<double> coverage(image.num_pixels(), 0.0);
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t pixel = points[i].pixel;
    CHECK_LT(pixel, coverage.size());
    coverage[pixel] += points[i].coverage;
    for (int c = 0; c < 3; ++c) {
      sums[3 * pixel + c] += points[i].coverage * L_o[3 * i + c];
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
