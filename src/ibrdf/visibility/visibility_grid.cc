#include "ibrdf/visibility/visibility_grid.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr int kLatticeRows = 32;

// What is known of a direction. What follows from its neighbours (filled) gives
// way to a ray.
enum State : uint8_t { kUnknown, kBelow, kVisible, kHidden, kFilled, kAsked };

}  // namespace

VisibilityGrid::VisibilityGrid(const Scene& scene, int rows)
    : scene_(scene), rows_(rows) {
  CHECK(rows > 0 && rows % kLatticeRows == 0);
  for (int r = 0; r < rows; ++r) {
    const double theta = kPi * (r + 0.5) / rows;
    sin_theta_.push_back(std::sin(theta));
    cos_theta_.push_back(std::cos(theta));
  }
  for (int c = 0; c < columns(); ++c) {
    const double phi = kPi * (c + 0.5) / rows;
    sin_phi_.push_back(std::sin(phi));
    cos_phi_.push_back(std::cos(phi));
  }
}

struct VisibilityGrid::Tracer {
  using Cell = Scratch::Cell;
  const VisibilityGrid& grid;
  const ShadingPoint& point;
  const Eigen::Vector3d n;
  Scratch& scratch;
  Bits& bits;
  int64_t rays = 0;
  bool any = false;

  // The first column may be given once more.
  int Wrap(int column) const { return column == grid.columns() ? 0 : column; }
  size_t Texel(int row, int column) const {
    return static_cast<size_t>(row) * grid.columns() + Wrap(column);
  }
  void Show(size_t texel) {
    bits[texel / 64] &= ~(uint64_t{1} << (texel % 64));
  }
  void Hide(size_t texel) { bits[texel / 64] |= uint64_t{1} << (texel % 64); }

  // Has the direction's ray cast by Cast() where it has not been.
  void Ask(int row, int column) {
    const size_t texel = Texel(row, column);
    uint8_t& state = scratch.state[texel];
    if (state != kUnknown && state != kFilled) return;
    const Eigen::Vector3d direction = grid.Direction(row, Wrap(column));
    if (n.dot(direction) > 0.0) {
      state = kAsked;
      scratch.texels.push_back(static_cast<int>(texel));
      scratch.directions.push_back(direction.cast<float>());
    } else {
      state = kBelow;
      Show(texel);
    }
  }

  void Ask(const Cell& cell) {
    for (const int r : {cell.row_begin, cell.row_end}) {
      for (const int c : {cell.column_begin, cell.column_end}) Ask(r, c);
    }
    scratch.parts.push_back(cell);
  }

  // Packets of rays; what they find.
  void Cast() {
    const size_t count = scratch.texels.size();
    scratch.hidden.resize(count);
    grid.scene_.Occluded(point.position, scratch.directions,
                         scratch.hidden.data());
    for (size_t k = 0; k < count; ++k) {
      const int texel = scratch.texels[k];
      const bool hidden = scratch.hidden[k] != 0;
      scratch.state[texel] = hidden ? kHidden : kVisible;
      if (hidden) {
        Hide(texel);
        any = true;
      } else {
        Show(texel);
      }
    }
    rays += static_cast<int64_t>(count);
    scratch.texels.clear();
    scratch.directions.clear();
  }

  // Cuts the cell by halves where its corners differ.
  void Refine(const Cell& cell) {
    const auto [r0, r1, c0, c1] = cell;
    const uint8_t corner = scratch.state[Texel(r0, c0)];
    if (scratch.state[Texel(r0, c1)] == corner &&
        scratch.state[Texel(r1, c0)] == corner &&
        scratch.state[Texel(r1, c1)] == corner) {
      if (corner == kHidden) Fill(cell);
      return;
    }
    const int rm = (r0 + r1) / 2, cm = (c0 + c1) / 2;
    const bool tall = rm > r0, wide = cm > c0;
    if (!tall && !wide) return;
    Ask(Cell{r0, tall ? rm : r1, c0, wide ? cm : c1});
    if (wide) Ask(Cell{r0, tall ? rm : r1, cm, c1});
    if (tall) Ask(Cell{rm, r1, c0, wide ? cm : c1});
    if (tall && wide) Ask(Cell{rm, r1, cm, c1});
  }

  void Fill(const Cell& cell) {
    for (int r = cell.row_begin; r <= cell.row_end; ++r) {
      for (int c = cell.column_begin; c <= cell.column_end; ++c) {
        const size_t texel = Texel(r, c);
        if (scratch.state[texel] != kUnknown) continue;
        scratch.state[texel] = kFilled;
        Hide(texel);
      }
    }
  }
};

bool VisibilityGrid::Trace(const ShadingPoint& point, Scratch* scratch,
                           Bits* bits, int64_t* rays) const {
  bits->assign(words(), 0);
  if (!scene_.CastsShadows()) return false;
  scratch->state.assign(size_t{1} * rows_ * columns(), kUnknown);
  scratch->parts.clear();
  Tracer tracer{*this, point, point.normal.cast<double>().normalized(),
                *scratch, *bits};
  const int stride = rows_ / kLatticeRows;
  for (int r = 0; r < rows_; r += stride) {
    // The last rows end at the pole, one short of a whole step.
    const int below = std::min(r + stride, rows_ - 1);
    for (int c = 0; c < columns() && below > r; c += stride) {
      tracer.Ask({r, below, c, c + stride});
    }
  }
  // Level by level, so that many rays are cast together.
  while (!scratch->parts.empty()) {
    tracer.Cast();
    std::swap(scratch->cells, scratch->parts);
    scratch->parts.clear();
    for (const Scratch::Cell& cell : scratch->cells) tracer.Refine(cell);
  }
  if (rays != nullptr) *rays += tracer.rays;
  return tracer.any;
}

GridRange VisibilityGrid::RangeOf(int row, int column, int height,
                                  int width) const {
  const auto range = [](int i, int count, int texels, int* begin, int* end) {
    *begin = static_cast<int>(int64_t{i} * texels / count);
    *end = std::max(*begin + 1,
                    static_cast<int>((int64_t{i} + 1) * texels / count));
  };
  GridRange out;
  range(row, height, rows_, &out.row_begin, &out.row_end);
  range(column, width, columns(), &out.column_begin, &out.column_end);
  return out;
}

double VisibilityGrid::VisibleShare(const uint64_t* bits,
                                    const Eigen::Vector3d& n,
                                    const GridRange& range) const {
  int hidden = 0, count = 0;
  for (int r = range.row_begin; r < range.row_end; ++r) {
    for (int c = range.column_begin; c < range.column_end; ++c) {
      hidden += Hidden(bits, r, c) ? 1 : 0;
      ++count;
    }
  }
  if (hidden == 0) return 1.0;
  if (hidden == count) return 0.0;
  double all = 0.0, behind = 0.0;
  CosineSums(bits, n, range, &all, &behind);
  return all > 0.0 ? (all - behind) / all : 1.0;
}

void VisibilityGrid::CosineSums(const uint64_t* bits, const Eigen::Vector3d& n,
                                const GridRange& range, double* all,
                                double* hidden) const {
  *all = *hidden = 0.0;
  for (int r = range.row_begin; r < range.row_end; ++r) {
    for (int c = range.column_begin; c < range.column_end; ++c) {
      const double cosine = n.dot(Direction(r, c));
      if (cosine <= 0.0) continue;
      const double weight = cosine * sin_theta_[r];
      *all += weight;
      if (Hidden(bits, r, c)) *hidden += weight;
    }
  }
}

double VisibilityGrid::VisibleAlong(const uint64_t* bits,
                                    const Eigen::Vector3d& n,
                                    const Eigen::Vector3d& wi) const {
  double row = 0.0, column = 0.0;
  MapPosition(wi, rows_, columns(), &row, &column);
  column -= 0.5;
  if (column < 0.0) column += columns();
  return VisibleAt(bits, n, row + 0.5, column);
}

double VisibilityGrid::VisibleAt(const uint64_t* bits, const Eigen::Vector3d& n,
                                 double row, double column) const {
  const int r0 = std::clamp(static_cast<int>(row), 0, rows_);
  const int c0 = std::clamp(static_cast<int>(column), 0, columns() - 1);
  int rows[4], texel_columns[4], hidden = 0;
  bool is_hidden[4];
  for (int k = 0; k < 4; ++k) {
    const int padded = r0 + (k >> 1) - 1;
    const int r = std::clamp(padded, 0, rows_ - 1);
    // Across a pole the other half of the same row lies.
    const int c = c0 + (k & 1) + (padded == r ? 0 : rows_);
    rows[k] = r;
    texel_columns[k] = c % columns();
    is_hidden[k] = Hidden(bits, r, texel_columns[k]);
    hidden += is_hidden[k] ? 1 : 0;
  }
  if (hidden == 0) return 1.0;
  if (hidden == 4) return 0.0;
  const double fy = std::clamp(row - r0, 0.0, 1.0);
  const double fx = std::clamp(column - c0, 0.0, 1.0);
  double all = 0.0, visible = 0.0;
  for (int k = 0; k < 4; ++k) {
    if (n.dot(Direction(rows[k], texel_columns[k])) <= 0.0) continue;
    const double weight = (k >> 1 ? fy : 1.0 - fy) * (k & 1 ? fx : 1.0 - fx);
    all += weight;
    if (!is_hidden[k]) visible += weight;
  }
  return all > 0.0 ? visible / all : 1.0;
}

}  // namespace ibrdf
