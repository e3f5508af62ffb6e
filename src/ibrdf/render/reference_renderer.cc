#include "ibrdf/render/reference_renderer.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

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

Float4 Load4(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}

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
      even += taps.weight[k] * Load4(&lanes_[size_t{4} * taps.bin[k]]);
      odd += taps.weight[k + 1] * Load4(&lanes_[size_t{4} * taps.bin[k + 1]]);
    }
    const Float4 sum = even + odd;
    if (!(sum[3] > 0.0f)) return Eigen::Array3d::Zero();
    const float scale = 1.0f / sum[3];
    return {sum[0] * scale, sum[1] * scale, sum[2] * scale};
  }

 private:
  std::vector<float> lanes_;  // [bin][4]
};

// What a point's reflectance is looked up in.
template <typename Lookup>
const Lookup& OfPoint(const Lookup& lookup, const ShadingPoint&) {
  return lookup;
}
BrdfFunction OfPoint(const SurfaceBrdf& brdf, const ShadingPoint& point) {
  return brdf(point);
}

// Points that share their near samples share a reflectance.
template <typename Lookup>
constexpr size_t kGroup =
    std::is_same_v<Lookup, SurfaceBrdf> ? 1 : ViewGroups::kMaxGroup;

// Bilinear in a map of four floats a texel, at a position of place_rays.
Float4 LookUpTexels(const PaddedMaps& map, float row, float column) {
  const int r = std::min(static_cast<int>(row), map.height);
  const int c = std::min(static_cast<int>(column), map.width - 1);
  const float fy = row - static_cast<float>(r);
  const float fx = column - static_cast<float>(c);
  const float* const texel =
      &map.lanes[4 * (static_cast<size_t>(r) * (map.width + 1) + c)];
  const float* const below = texel + size_t{4} * (map.width + 1);
  const Float4 upper = (1 - fx) * Load4(texel) + fx * Load4(texel + 4);
  const Float4 lower = (1 - fx) * Load4(below) + fx * Load4(below + 4);
  return (1 - fy) * upper + fy * lower;
}

}  // namespace

struct ReferenceRenderer::LobeSettings {
  // Rays whose half-vectors lie within it of the normal, radians, are a narrow
  // lobe; 0: lobes have no rays of their own.
  double width = 0.0;
  std::vector<BrightSample> bright;
};

template <typename Lookup>
struct ReferenceRenderer::Pass {
  int depth;
  const LobeSettings& settings;
  const std::vector<ShadingPoint>& points;
  const Lookup& lookup;
  const EmittedLight& emitted;
  QuadratureRules rules;
};

struct ReferenceRenderer::LobeLight {
  int rays = 0;
  std::vector<double> radiance;  // [points, rays, 3], negative: nothing met
};

struct ReferenceRenderer::Rays {
  std::vector<float> x, y, z;  // direction
  std::vector<float> f;        // weight times BRDF, four lanes
  std::vector<int> bundle;     // of the first rays, -1: none
};

struct ReferenceRenderer::Scratch {
  std::vector<NearSample> near;
  std::vector<FarSample> far;
  Rays rays;
  VisibilityGrid::Scratch trace;
  VisibilityGrid::Bits bits;
  std::vector<SeenPatch> seen;
  std::vector<PatchShare> shares;
};

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
    : ReferenceRenderer(map, GatherReferenceLight(map.rest, options), options) {
}

ReferenceRenderer::ReferenceRenderer(const BrightTexels& map,
                                     ReferenceLight light,
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

void ReferenceRenderer::FindVisible(const Rays& rays, size_t begin, int n,
                                    const Eigen::Matrix3f& axes,
                                    const uint64_t* hidden,
                                    float* visible) const {
  const Eigen::Vector3d normal = axes.col(2).cast<double>();
  float row[kRayBlock], column[kRayBlock];
  kernels_.place_rays(&rays.x[begin], &rays.y[begin], &rays.z[begin], n,
                      axes.data(), shadows_->rows(), shadows_->columns(), row,
                      column);
  for (int k = 0; k < n; ++k) {
    visible[k] = static_cast<float>(
        shadows_->VisibleAt(hidden, normal, row[k], column[k]));
  }
}

const double* ReferenceRenderer::ObjectAlong(const Rays& rays, size_t ray,
                                             const Eigen::Matrix3f& axes,
                                             const Sight& sight) const {
  if (sight.lobe != nullptr && ray < rays.bundle.size() &&
      rays.bundle[ray] >= 0) {
    const double* const R = sight.lobe + size_t{3} * rays.bundle[ray];
    if (R[0] >= 0.0) return R;
  }
  if (sight.seen.empty()) return nullptr;
  const Eigen::Vector3f wi =
      axes * Eigen::Vector3f(rays.x[ray], rays.y[ray], rays.z[ray]);
  const int patch = patches_->Along(sight.seen, wi.cast<double>());
  return patch < 0 ? nullptr : sight.emitted + size_t{3} * patch;
}

Eigen::Array3d ReferenceRenderer::Gather(const Rays& rays,
                                         const Eigen::Matrix3f& axes,
                                         const Sight& sight) const {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const size_t count = rays.x.size();
  for (size_t begin = 0; begin < count; begin += kRayBlock) {
    const int n = static_cast<int>(std::min<size_t>(kRayBlock, count - begin));
    float row[kRayBlock], column[kRayBlock], visible[kRayBlock];
    kernels_.place_rays(&rays.x[begin], &rays.y[begin], &rays.z[begin], n,
                        axes.data(), map_.height, map_.width, row, column);
    if (sight.hidden != nullptr) {
      FindVisible(rays, begin, n, axes, sight.hidden, visible);
    }
    Float4 block = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int k = 0; k < n; ++k) {
      const Float4 f = Load4(&rays.f[4 * (begin + k)]);
      if (sight.hidden == nullptr) {
        block += f * LookUpTexels(map_, row[k], column[k]);
        continue;
      }
      if (visible[k] < 1.0f) {
        if (const double* const R = ObjectAlong(rays, begin + k, axes, sight)) {
          const Float4 light = {static_cast<float>(R[0]),
                                static_cast<float>(R[1]),
                                static_cast<float>(R[2]), 0.0f};
          block += (1.0f - visible[k]) * f * light;
        }
      }
      if (visible[k] == 0.0f) continue;
      block += f * (LookUpTexels(map_, row[k], column[k]) * visible[k]);
    }
    sum += Eigen::Array3d(block[0], block[1], block[2]);
  }
  return sum;
}

Eigen::Array3d ReferenceRenderer::LightOfCell(
    int cell, double visible, const Eigen::Vector3d& n, const Sight& sight,
    std::vector<PatchShare>* shares) const {
  Eigen::Array3d light = visible * power_[cell];
  if (visible == 1.0 || sight.seen.empty()) return light;
  patches_->SharesIn(*shadows_, sight.hidden, n, ranges_[cell], sight.seen,
                     shares);
  for (const PatchShare& e : *shares) {
    light +=
        e.share * solid_angle_[cell] *
        Eigen::Map<const Eigen::Array3d>(sight.emitted + size_t{3} * e.patch);
  }
  return light;
}

template <typename Lookup>
void ReferenceRenderer::AddFar(const PointFrame& frame, const Lookup& lookup,
                               const Sight& sight, Scratch* scratch,
                               Eigen::Array3d* sum) const {
  quadrature_.SampleFar(frame.n, frame.wo, &scratch->far);
  for (const FarSample& far : scratch->far) {
    const double visible =
        sight.hidden == nullptr
            ? 1.0
            : shadows_->VisibleShare(sight.hidden, frame.n, ranges_[far.cell]);
    if (visible == 0.0 && sight.seen.empty()) continue;
    *sum += far.weight * lookup(far.theta_h, far.theta_d, far.phi_d) *
            LightOfCell(far.cell, visible, frame.n, sight, &scratch->shares);
  }
}

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
std::vector<char> ReferenceRenderer::MeetObject(
    const Pass<Lookup>& pass, const ViewGroups& groups, int rays,
    std::vector<ShadingPoint>* met) const {
  const std::vector<ShadingPoint>& points = pass.points;
  met->assign(points.size() * rays, points[0]);
  std::vector<char> is_met(met->size(), 0);
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t group, int worker) {
    Scratch& s = scratch[worker];
    const size_t begin = groups.begins[group];
    const ShadingPoint& first = points[groups.order[begin]];
    ShadeNear(PointFrame(first), OfPoint(pass.lookup, first), &s.near, &s.rays);
    const std::vector<Eigen::Vector3f> lobe =
        Bundle(s.near, pass.settings.width, rays, &s.rays);
    for (size_t k = begin; k < groups.begins[group + 1]; ++k) {
      const int i = groups.order[k];
      const Eigen::Matrix3d axes = PointFrame(points[i]).Axes().cast<double>();
      for (size_t r = 0; r < lobe.size(); ++r) {
        if (lobe[r].isZero()) continue;
        const size_t at = size_t{1} * i * rays + r;
        const Eigen::Vector3d wi = axes * lobe[r].cast<double>();
        is_met[at] = patches_->Meet(points[i], wi, &(*met)[at]) ? 1 : 0;
      }
    }
  });
  return is_met;
}

template <typename Lookup>
ReferenceRenderer::LobeLight ReferenceRenderer::LightOfLobes(
    const Pass<Lookup>& pass, const ViewGroups& groups) const {
  LobeLight lobes;
  if (pass.rules == QuadratureRules::kFar || pass.settings.width == 0.0 ||
      pass.depth >= pass.emitted.bounces || pass.points.empty()) {
    return lobes;
  }
  lobes.rays = lobe_rays_;
  for (int k = 0; k < pass.depth; ++k) lobes.rays /= kFewerRays;
  lobes.rays = std::max(lobes.rays, 1);
  std::vector<ShadingPoint> met, some;
  const std::vector<char> is_met = MeetObject(pass, groups, lobes.rays, &met);
  for (size_t k = 0; k < met.size(); ++k) {
    if (is_met[k] != 0) some.push_back(met[k]);
  }
  std::vector<double> radiance(3 * some.size());
  if (!some.empty()) {
    const ReferenceRenderer& next = coarser_ != nullptr ? *coarser_ : *this;
    // The last bounce shows what the map alone lights.
    EmittedLight light = pass.emitted;
    if (pass.depth + 1 >= light.bounces) light.radiance = nullptr;
    next.RenderPass(Pass<Lookup>{pass.depth + 1, pass.settings, some,
                                 pass.lookup, light, QuadratureRules::kBoth},
                    radiance.data());
  }
  lobes.radiance.assign(3 * met.size(), -1.0);
  for (size_t k = 0, from = 0; k < met.size(); ++k) {
    if (is_met[k] == 0) continue;
    std::copy_n(&radiance[3 * from++], 3, &lobes.radiance[3 * k]);
  }
  return lobes;
}

ReferenceRenderer::Sight ReferenceRenderer::Look(const ShadingPoint& point,
                                                 const EmittedLight& emitted,
                                                 Scratch* scratch) const {
  Sight sight;
  if (shadows_ != nullptr &&
      shadows_->Trace(point, &scratch->trace, &scratch->bits)) {
    sight.hidden = scratch->bits.data();
  }
  if (sight.hidden != nullptr && emitted.radiance != nullptr &&
      patches_ != nullptr) {
    sight.seen = patches_->Look(point, *shadows_, sight.hidden, &scratch->seen);
    sight.emitted = emitted.radiance;
  }
  return sight;
}

template <typename Lookup>
void ReferenceRenderer::RenderGroup(const Pass<Lookup>& pass,
                                    const ViewGroups& groups, int64_t group,
                                    const LobeLight& lobes, Scratch* scratch,
                                    double* L_o) const {
  const size_t begin = groups.begins[group];
  const ShadingPoint& first = pass.points[groups.order[begin]];
  const auto& lookup = OfPoint(pass.lookup, first);
  const bool near = pass.rules != QuadratureRules::kFar;
  if (near) {
    ShadeNear(PointFrame(first), lookup, &scratch->near, &scratch->rays);
  }
  if (lobes.rays > 0) {
    Bundle(scratch->near, pass.settings.width, lobes.rays, &scratch->rays);
  }
  for (size_t k = begin; k < groups.begins[group + 1]; ++k) {
    const int i = groups.order[k];
    const PointFrame frame(pass.points[i]);
    Sight sight = Look(pass.points[i], pass.emitted, scratch);
    if (lobes.rays > 0) {
      sight.lobe = &lobes.radiance[size_t{3} * lobes.rays * i];
    }
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    if (near) {
      sum += Gather(scratch->rays, frame.Axes(), sight);
      sum += GatherBright(frame, pass.settings.bright, lookup, sight.hidden);
    }
    if (pass.rules != QuadratureRules::kNear) {
      AddFar(frame, lookup, sight, scratch, &sum);
    }
    for (int c = 0; c < 3; ++c) L_o[size_t{3} * i + c] = sum[c];
  }
}

template <typename Lookup>
void ReferenceRenderer::RenderPass(const Pass<Lookup>& pass,
                                   double* L_o) const {
  const ViewGroups groups(pass.points, kGroup<Lookup>);
  const LobeLight lobes = LightOfLobes(pass, groups);
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t group, int worker) {
    RenderGroup(pass, groups, group, lobes, &scratch[worker], L_o);
  });
}

template <typename Lookup>
void ReferenceRenderer::RenderWith(const std::vector<ShadingPoint>& points,
                                   const Lookup& lookup,
                                   const BrdfFunction& sharpest,
                                   const EmittedLight& emitted,
                                   QuadratureRules rules, double* L_o) const {
  LobeSettings settings;
  const bool follow =
      lobe_rays_ > 0 && patches_ != nullptr && emitted.radiance != nullptr;
  if (follow || !bright_.empty()) {
    const double half = LobeHalfWidth(sharpest);
    if (follow && half < kNarrowLobe) settings.width = kLobeWidths * half;
    settings.bright = SampleBrightTexels(bright_, map_.height, map_.width,
                                         BrightSamplesPerSide(half));
  }
  RenderPass(Pass<Lookup>{0, settings, points, lookup, emitted, rules}, L_o);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const MerlTable& table, double* L_o,
                               const EmittedLight& emitted,
                               QuadratureRules rules) const {
  const MerlSampler sampler(table);
  RenderWith(points, sampler, std::cref(sampler), emitted, rules, L_o);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const BrdfFunction& brdf, double* L_o,
                               const EmittedLight& emitted,
                               QuadratureRules rules) const {
  RenderWith(points, brdf, brdf, emitted, rules, L_o);
}

void ReferenceRenderer::Render(const std::vector<ShadingPoint>& points,
                               const SurfaceBrdf& brdf,
                               const BrdfFunction& sharpest, double* L_o,
                               const EmittedLight& emitted) const {
  RenderWith(points, brdf, sharpest, emitted, QuadratureRules::kBoth, L_o);
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
