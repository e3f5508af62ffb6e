#include "ibrdf/render/visibility_grid.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLatticeRows = 32;

// What is known of a direction. What follows from its neighbours (filled) gives
// way to a ray.
enum State : uint8_t { kUnknown, kBelow, kVisible, kHidden, kFilled };

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
  const VisibilityGrid& grid;
  const ShadingPoint& point;
  const Eigen::Vector3d n;
  std::vector<uint8_t>& state;
  Bits& bits;
  int64_t rays = 0;
  bool any = false;

  State Look(int row, int column) {
    const size_t texel = static_cast<size_t>(row) * grid.columns() + column;
    if (state[texel] != kUnknown && state[texel] != kFilled) {
      return static_cast<State>(state[texel]);
    }
    const Eigen::Vector3d direction = grid.Direction(row, column);
    State seen = kBelow;
    if (n.dot(direction) > 0.0) {
      ++rays;
      seen =
          grid.scene_.Occluded(point.position, direction) ? kHidden : kVisible;
    }
    state[texel] = seen;
    const uint64_t bit = uint64_t{1} << (texel % 64);
    if (seen == kHidden) {
      bits[texel / 64] |= bit;
      any = true;
    } else {
      bits[texel / 64] &= ~bit;
    }
    return seen;
  }

  // Rows r0 to r1 and columns c0 to c1, corners included; c1 may be the first
  // column once more.
  void Refine(int r0, int r1, int c0, int c1) {
    const int wrapped = c1 % grid.columns();
    const State corner = Look(r0, c0);
    const State others[] = {Look(r0, wrapped), Look(r1, c0), Look(r1, wrapped)};
    if (std::all_of(others, others + 3,
                    [corner](State s) { return s == corner; })) {
      if (corner == kHidden) Fill(r0, r1, c0, c1);
      return;
    }
    const int rm = (r0 + r1) / 2, cm = (c0 + c1) / 2;
    const bool tall = rm > r0, wide = cm > c0;
    if (!tall && !wide) return;
    Refine(r0, tall ? rm : r1, c0, wide ? cm : c1);
    if (wide) Refine(r0, tall ? rm : r1, cm, c1);
    if (tall) Refine(rm, r1, c0, wide ? cm : c1);
    if (tall && wide) Refine(rm, r1, cm, c1);
  }

  void Fill(int r0, int r1, int c0, int c1) {
    for (int r = r0; r <= r1; ++r) {
      for (int c = c0; c <= c1; ++c) {
        const size_t texel =
            static_cast<size_t>(r) * grid.columns() + c % grid.columns();
        if (state[texel] != kUnknown) continue;
        state[texel] = kFilled;
        bits[texel / 64] |= uint64_t{1} << (texel % 64);
      }
    }
  }
};

bool VisibilityGrid::Trace(const ShadingPoint& point, Scratch* scratch,
                           Bits* bits, int64_t* rays) const {
  bits->assign(words(), 0);
  if (!scene_.CastsShadows()) return false;
  scratch->state.assign(size_t{1} * rows_ * columns(), kUnknown);
  Tracer tracer{*this, point, point.normal.cast<double>().normalized(),
                scratch->state, *bits};
  const int stride = rows_ / kLatticeRows;
  for (int r = 0; r < rows_; r += stride) {
    // The last rows end at the pole, one short of a whole step.
    const int below = std::min(r + stride, rows_ - 1);
    for (int c = 0; c < columns() && below > r; c += stride) {
      tracer.Refine(r, below, c, c + stride);
    }
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
