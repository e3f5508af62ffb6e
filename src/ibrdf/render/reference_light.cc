#include "ibrdf/render/reference_light.h"

#include <algorithm>
#include <utility>

namespace ibrdf {
namespace {

// A block with this many times the mean power of a block, and a texel this many
// times brighter than its mean, is split into texels.
constexpr double kBrightBlock = 4.0;
constexpr double kUnevenBlock = 1.5;

class CellGatherer {
 public:
  CellGatherer(const Image& map, const ReferenceOptions& options)
      : map_(map),
        shadows_(options.shadows.get()),
        block_(FarBlockSize(map.height, map.width, options.far_width)),
        texels_(MapCells(map.height, map.width, 1)),
        blocks_(MapCells(map.height, map.width, block_)) {
    for (size_t t = 0; t < texels_.size(); ++t) {
      total_ += PowerOf(static_cast<int>(t)).abs().sum();
    }
  }

  ReferenceLight Gather() {
    const int columns = map_.width / block_;
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const int y0 = static_cast<int>(b) / columns * block_;
      const int x0 = static_cast<int>(b) % columns * block_;
      const BlockSums sums = SumsOf(y0, x0);
      const bool bright = sums.strength * static_cast<double>(blocks_.size()) >
                          kBrightBlock * total_;
      if (bright &&
          sums.peak * block_ * block_ > kUnevenBlock * sums.strength) {
        AddTexels(y0, x0);
      } else {
        FarCell cell = blocks_[b];
        if (sums.centroid.norm() > 0.0) {
          cell.direction = sums.centroid.normalized();
        }
        AddCell(cell, sums.power, y0, x0, block_);
      }
    }
    return std::move(light_);
  }

 private:
  // Sums over the texels of a block; a texel's strength is that of its power.
  struct BlockSums {
    Eigen::Array3d power = Eigen::Array3d::Zero();
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // by strength
    double strength = 0.0;
    double peak = 0.0;  // the strongest texel
  };

  Eigen::Array3d PowerOf(int texel) const {
    const float* rgb = map_.rgb.data() + size_t{3} * texel;
    return Eigen::Array3d(rgb[0], rgb[1], rgb[2]) * texels_[texel].solid_angle;
  }
  // Texel k of the block whose first one is (y0, x0).
  int TexelOf(int y0, int x0, int k) const {
    return (y0 + k / block_) * map_.width + x0 + k % block_;
  }

  BlockSums SumsOf(int y0, int x0) const {
    BlockSums sums;
    for (int k = 0; k < block_ * block_; ++k) {
      const int texel = TexelOf(y0, x0, k);
      const Eigen::Array3d power = PowerOf(texel);
      const double strength = power.abs().sum();
      sums.power += power;
      sums.centroid += strength * texels_[texel].direction;
      sums.strength += strength;
      sums.peak = std::max(sums.peak, strength);
    }
    return sums;
  }

  void AddTexels(int y0, int x0) {
    for (int k = 0; k < block_ * block_; ++k) {
      const int texel = TexelOf(y0, x0, k);
      AddCell(texels_[texel], PowerOf(texel), y0 + k / block_, x0 + k % block_,
              1);
    }
  }

  // A cell of side x side texels from (y, x) on.
  void AddCell(const FarCell& cell, const Eigen::Array3d& power, int y, int x,
               int side) {
    light_.cells.push_back(cell);
    light_.power.push_back(power);
    light_.solid_angle.push_back(cell.solid_angle);
    if (shadows_ == nullptr) return;
    light_.ranges.push_back(shadows_->RangeOf(
        y / side, x / side, map_.height / side, map_.width / side));
  }

  const Image& map_;
  const VisibilityGrid* const shadows_;
  const int block_;  // side of the blocks in texels
  const std::vector<FarCell> texels_, blocks_;
  double total_ = 0.0;  // strength of the map
  ReferenceLight light_;
};

}  // namespace

ReferenceLight GatherReferenceLight(const Image& map,
                                    const ReferenceOptions& options) {
  return CellGatherer(map, options).Gather();
}

}  // namespace ibrdf
