// What the reference renderers share: groups of points, taps into tables and
// maps that need no wrapping.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/reference_kernels.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/visibility/radiosity_patches.h"
#include "ibrdf/visibility/visibility_grid.h"

namespace ibrdf {

struct ReferenceOptions {
  // Near as in QuadratureOptions. Rings and their samples are those for maps of
  // up to 512 columns and grow in proportion to wider ones.
  double near_begin_degrees = 8.0;
  double near_end_degrees = 16.0;
  int near_rings = 96;
  int near_ring_samples = 256;
  // Wider maps are taken in blocks of texels in the far rule, each at the
  // centroid of its light; bright uneven blocks by texel all the same. Against
  // every texel and twice the rings: mean |log ratio| below 0.001 from matte
  // to mirror, a hard key light included.
  int far_width = 128;
  // Few texels much brighter than the rest are rendered by directions of their
  // own (bright_texels.h), not by rings that may miss them. ReferenceBatch
  // never does that.
  bool split_bright = true;
  int num_threads = 0;  // <= 0: all
  // What hides light from the points; null: nothing. Traced afresh for every
  // point rendered.
  std::shared_ptr<const VisibilityGrid> shadows;
  // What is met where light is hidden; needs `shadows`. Looked for afresh, too.
  std::shared_ptr<const RadiosityPatches> patches;
  // Patches are patches, too wide for lobes of a few degrees: those see the
  // object along at most so many rays of their own, a power of 2, and what
  // these meet does along a quarter as many, at a coarser quadrature. 0: never.
  int lobe_rays = 0;
};
// A quarter of the rings: within 1 % but for mirrors
// (experiments/render_speed).
inline ReferenceOptions Coarser(ReferenceOptions options) {
  options.near_rings /= 4;
  options.near_ring_samples /= 4;
  options.far_width = std::min(options.far_width, 64);
  return options;
}
// Rows of the grid that suits ReferenceOptions: steps of 0.7 degrees.
inline constexpr int kReferenceShadowRows = 256;

// The near rule for maps of this width.
QuadratureOptions NearOptions(int map_width, const ReferenceOptions& options);

// Unit vectors of a point in double.
struct PointFrame {
  explicit PointFrame(const ShadingPoint& point);
  // Axes of ViewFrame, by columns.
  Eigen::Matrix3f Axes() const;

  Eigen::Vector3d n, wo;
};

// Points seen at exactly the same angle share their near samples. Group g holds
// order[begins[g]] to order[begins[g + 1] - 1]; at most kMaxGroup points, for
// larger ones would starve other threads.
struct ViewGroups {
  static constexpr size_t kMaxGroup = 64;
  // most: points of a group; 1 where they share no reflectance.
  explicit ViewGroups(const std::vector<ShadingPoint>& points,
                      size_t most = kMaxGroup);
  int64_t count() const { return static_cast<int64_t>(begins.size()) - 1; }

  std::vector<int> order;
  std::vector<size_t> begins;
};

// Near samples of a point, in its ViewFrame.
void SampleNearOf(const PointFrame& frame, const PointQuadrature& quadrature,
                  std::vector<NearSample>* samples);

// Bins and weights of InterpolateMerl, `factor` times; bins may be invalid.
inline MerlTaps MerlTapsAt(double theta_h, double theta_d, double phi_d,
                           double factor) {
  const auto x =
      static_cast<float>(std::sqrt(theta_h * (2 / kPi)) * kMerlThetaH - 0.5);
  const auto y = static_cast<float>(theta_d * (2 / kPi) * kMerlThetaD - 0.5);
  const auto z = static_cast<float>(phi_d * (1 / kPi) * kMerlPhiD - 0.5);
  const float x0 = std::floor(x), y0 = std::floor(y), z0 = std::floor(z);
  const float fx = x - x0, fy = y - y0, fz = z - z0;
  const auto clamp = [](int i, int n) { return std::clamp(i, 0, n - 1); };
  const int i = static_cast<int>(x0), j = static_cast<int>(y0);
  const int is[] = {clamp(i, kMerlThetaH), clamp(i + 1, kMerlThetaH)};
  const int js[] = {clamp(j, kMerlThetaD), clamp(j + 1, kMerlThetaD)};
  int k0 = static_cast<int>(z0);
  if (k0 < 0) k0 += kMerlPhiD;
  if (k0 >= kMerlPhiD) k0 -= kMerlPhiD;
  const int k1 = k0 + 1 < kMerlPhiD ? k0 + 1 : 0;
  const auto scale = static_cast<float>(factor);
  const float wx[] = {scale * (1 - fx), scale * fx};
  const float wy[] = {1 - fy, fy};
  MerlTaps taps;
  for (int corner = 0; corner < 4; ++corner) {
    const int a = corner >> 1, b = corner & 1;
    const float w = wx[a] * wy[b];
    taps.bin[2 * corner] = MerlTable::Bin(is[a], js[b], k0);
    taps.bin[2 * corner + 1] = MerlTable::Bin(is[a], js[b], k1);
    taps.weight[2 * corner] = w * (1 - fz);
    taps.weight[2 * corner + 1] = w * fz;
  }
  return taps;
}

// Maps of one size with what lies across the poles above and below and the
// first column repeated on the right: bilinear taps need no wrapping. A texel
// holds, for channel c of map l, lane c * maps + l.
struct PaddedMaps {
  // texel_floats >= 3 maps.
  PaddedMaps(const std::vector<const Image*>& maps, int texel_floats);

  int width, height;
  int stride;                // floats of a texel
  std::vector<float> lanes;  // [height + 2][width + 1][stride]
};

}  // namespace ibrdf
