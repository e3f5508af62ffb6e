// A photograph in few numbers: pixels of like normals together.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

struct NormalBins {
  // Up to some pixels of each bin, bin by bin; bin i has
  // [first[i], first[i + 1]).
  std::vector<ShadingPoint> points;
  std::vector<int> first;
  // Log of the mean radiance of a bin's points [3 * bins], by channel.
  std::vector<double> log_radiance;

  int num_bins() const { return static_cast<int>(first.size()) - 1; }
};

struct NormalBinOptions {
  int bins_across = 16;    // of the disc of visible normals
  int points_per_bin = 4;  // at most
  // Pixels seen at a smaller cosine are left out: at the limb a pixel's centre
  // stands badly for its area.
  double min_cosine = 0.2;
};

// The components, right and up, of a point's normal in its own view, up kept
// upright: for an orthographic view of a sphere, its image; in [-1, 1]. Empty
// where the point says nothing: radiance [3] not finite and positive in all
// channels, or seen at a cosine below min_cosine.
std::optional<Eigen::Vector2d> NormalInView(const ShadingPoint& point,
                                            const double* radiance,
                                            double min_cosine);

// radiance [points][3]; points that are not finite and positive in all channels
// take no part. A bin's radiance is the mean over exactly the points kept, so
// that a model's mean over them has no error of resolution.
NormalBins BinByNormal(const std::vector<ShadingPoint>& points,
                       const std::vector<double>& radiance,
                       const NormalBinOptions& options);

// Those with keep [bins] set.
NormalBins KeepBins(const NormalBins& bins, const std::vector<bool>& keep);

}  // namespace ibrdf
