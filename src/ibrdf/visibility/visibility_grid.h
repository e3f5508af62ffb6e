// Which directions an object hides from its own points: a bit per texel of an
// equirectangular grid of directions, and what those bits say about a cell of
// the map or a single ray.
//
// A bit is set where the light is hidden. Directions at or below the horizon of
// a point's (shading) normal carry no light and no bit: a point that sees its
// whole hemisphere has no bit at all, and nothing is computed with it.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

// A cell of light directions in texels of the grid; end exclusive.
struct GridRange {
  int row_begin = 0, row_end = 0;
  int column_begin = 0, column_end = 0;
};

// Immutable; safe to share between threads.
class VisibilityGrid {
 public:
  using Bits = std::vector<uint64_t>;
  // Buffers of one thread, kept between calls.
  struct Scratch {
    struct Cell {
      int row_begin, row_end, column_begin, column_end;  // corners
    };
    std::vector<uint8_t> state;
    std::vector<Cell> cells, parts;
    // Rays to be cast.
    std::vector<int> texels;
    std::vector<Eigen::Vector3f> directions;
    std::vector<uint8_t> hidden;
  };

  // rows x 2 rows directions, rows a multiple of 32. Keeps the scene.
  VisibilityGrid(const Scene& scene, int rows);

  int rows() const { return rows_; }
  int columns() const { return 2 * rows_; }
  size_t words() const { return size_t{2} * rows_ * rows_ / 64; }

  // Fills bits [words()] for a point; false, and all bits clear, where nothing
  // is hidden. Rays are cast on a lattice of 32 x 64 directions and, by
  // halves, wherever neighbours on it differ or the horizon passes: an occluder
  // narrower than the lattice (5.6 degrees) on all sides may be missed. `rays`,
  // where given, is increased by the number of rays cast.
  bool Trace(const ShadingPoint& point, Scratch* scratch, Bits* bits,
             int64_t* rays = nullptr) const;

  // Texels of cell (row, column) of a map of height x width; at least one.
  GridRange RangeOf(int row, int column, int height, int width) const;

  // Share of the cosine-weighted light of a cell, all of one radiance, that
  // reaches a point of normal n (unit); 1 where all of it is below the horizon.
  double VisibleShare(const uint64_t* bits, const Eigen::Vector3d& n,
                      const GridRange& range) const;

  // Cosine-weighted solid angle of the texels of a range that lie above the
  // horizon, up to a factor, and of the hidden ones among them.
  void CosineSums(const uint64_t* bits, const Eigen::Vector3d& n,
                  const GridRange& range, double* all, double* hidden) const;

  // Bilinear between the four directions around wi that are above the horizon.
  double VisibleAlong(const uint64_t* bits, const Eigen::Vector3d& n,
                      const Eigen::Vector3d& wi) const;
  // The same at a position in rows and columns from the centre of the texel
  // above the first (the other half of the same row, across the pole), as
  // ReferenceKernels::place_rays gives it.
  double VisibleAt(const uint64_t* bits, const Eigen::Vector3d& n, double row,
                   double column) const;

  // The unit direction of a texel's centre.
  Eigen::Vector3d Direction(int row, int column) const {
    return {sin_theta_[row] * sin_phi_[column], cos_theta_[row],
            sin_theta_[row] * cos_phi_[column]};
  }
  bool Hidden(const uint64_t* bits, int row, int column) const {
    const size_t texel = static_cast<size_t>(row) * columns() + column;
    return (bits[texel / 64] >> (texel % 64) & 1) != 0;
  }

 private:
  struct Tracer;

  Scene scene_;
  int rows_;
  std::vector<double> sin_theta_, cos_theta_;  // [rows]
  std::vector<double> sin_phi_, cos_phi_;      // [columns]
};

}  // namespace ibrdf
