// Photographs in few numbers: pixels of like normals together, each view's by
// themselves, as like normals of two views reflect other light.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

struct NormalBins {
  // Up to some pixels of each bin, all of one material, part and view, bin by
  // bin; bin i has [first[i], first[i + 1]). Bins of a material come one after
  // the other, by ShadingPoint::material.
  std::vector<ShadingPoint> points;
  std::vector<int> first;
  // Log of the mean radiance of a bin's points [3 * bins], by channel.
  std::vector<double> log_radiance;
  // Logs of the mean ends of intervals [3 * bins], by channel; -infinity and
  // infinity where there is none. Both empty: the radiance is known.
  std::vector<double> log_low, log_high;

  int num_bins() const { return static_cast<int>(first.size()) - 1; }
};

struct NormalBinOptions {
  int bins_across = 16;    // of the disc of a view's visible normals
  int points_per_bin = 4;  // at most
  // Pixels seen at a smaller cosine are left out: at the limb a pixel's centre
  // stands badly for its area.
  double min_cosine = 0.2;
  // All views together have no more; more are thinned evenly. 0: no limit.
  int most_bins = 0;
};

// The components, right and up, of a point's normal in its own view, up kept
// upright: for an orthographic view of a sphere, its image; in [-1, 1]. Empty
// where the point is seen at a cosine below min_cosine.
std::optional<Eigen::Vector2d> NormalInView(const ShadingPoint& point,
                                            double min_cosine);

// Points that are not valid take no part. A bin's radiance is the mean over
// exactly the points kept, so that a model's mean over them has no error of
// resolution. The mean of the upper ends has none where a point has none; that
// of the lower ends takes 0 for it, which holds too.
NormalBins BinByNormal(const std::vector<ShadingPoint>& points,
                       const Observations& observed,
                       const NormalBinOptions& options);

// Those with keep [bins] set.
NormalBins KeepBins(const NormalBins& bins, const std::vector<bool>& keep);

}  // namespace ibrdf
