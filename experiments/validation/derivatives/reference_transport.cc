#include "experiments/validation/derivatives/reference_transport.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"

namespace ibrdf {
namespace derivatives {
namespace {

Real Quantised(double fraction) {
  return std::floor(std::clamp(fraction, 0.0, 1.0) * 65535.0 + 0.5) /
         Real(65535);
}

}  // namespace

// Appends the pairs of one point after the other.
class ReferenceTransport::Builder {
 public:
  // options and transport must outlive the builder.
  Builder(bool of_patches, int map_height, int map_width,
          const TransportOptions& options, ReferenceTransport* transport)
      : of_patches_(of_patches),
        height_(map_height),
        width_(map_width),
        block_(
            FarBlockSize(map_height, map_width, options.quadrature.far_width)),
        options_(options),
        cells_(MapCells(map_height, map_width, block_)),
        quadrature_(cells_, options.quadrature),
        padded_(PaddedTexels(map_height, map_width)),
        to_(*transport) {}

  void AddPoint(const ShadingPoint& point) {
    const Sight sight = SightOf(point);
    quadrature_.Sample(sight.n, point.wo.cast<double>().normalized(),
                       &samples_);
    for (const FarSample& s : samples_.far) AddFar(sight, s);
    for (const NearSample& s : samples_.near) AddNear(sight, s);
    to_.pair_end_.push_back(to_.pairs_.size());
  }

 private:
  // What a point sees.
  struct Sight {
    Eigen::Vector3d n;                 // unit
    const uint64_t* hidden = nullptr;  // its bits; null: nothing is hidden
    SeenPatches seen;
  };

  Sight SightOf(const ShadingPoint& point) const {
    Sight sight;
    sight.n = point.normal.cast<double>().normalized();
    if (options_.visibility != nullptr) {
      sight.hidden = options_.visibility->Hidden(point);
    }
    if (sight.hidden != nullptr && options_.patches != nullptr) {
      sight.seen = of_patches_ ? options_.patches->SeenFromPatch(point)
                               : options_.patches->SeenFrom(point);
    }
    return sight;
  }

  // A pair whose sources are those added until EndPair.
  template <typename Sample>
  Pair BeginPair(const Sample& sample, Real weight) const {
    const BrdfGridShape& shape = options_.grid;
    const BrdfGridCell cell = FindCell(
        shape, ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d));
    const Real f[3] = {Quantised(cell.fh), Quantised(cell.fd),
                       Quantised(cell.fp)};
    Pair pair{};
    for (int k = 0; k < 8; ++k) {
      const int h = k >> 2, d = (k >> 1) & 1, p = k & 1;
      pair.node[k] = shape.Node(cell.h + h, cell.d + d, (cell.p + p) % shape.p);
      pair.share[k] =
          (h ? f[0] : 1 - f[0]) * (d ? f[1] : 1 - f[1]) * (p ? f[2] : 1 - f[2]);
    }
    pair.weight = weight;
    pair.source_begin = to_.sources_.size();
    return pair;
  }
  void EndPair(Pair* pair) {
    pair->source_end = to_.sources_.size();
    to_.pairs_.push_back(*pair);
  }

  template <typename Sample>
  void AddPatch(const Sample& sample, int patch, Real weight) {
    Pair pair = BeginPair(sample, weight);
    to_.sources_.push_back({static_cast<uint32_t>(to_.num_texels_ + patch), 1});
    EndPair(&pair);
  }

  void AddFar(const Sight& sight, const FarSample& s) {
    const int columns = width_ / block_;
    const int row = s.cell / columns, column = s.cell % columns;
    double share = 1.0;  // of the block that is visible
    if (sight.hidden != nullptr) {
      const VisibilityGrid& grid = options_.visibility->grid();
      const GridRange range =
          grid.RangeOf(row, column, height_ / block_, columns);
      share = grid.VisibleShare(sight.hidden, sight.n, range);
      if (share < 1.0 && !sight.seen.empty()) AddFarPatches(sight, s, range);
      if (share <= 0.0) return;
    }
    // A block that is hidden in part is taken texel by texel.
    const bool split = share < 1.0 && block_ > 1;
    Pair pair = BeginPair(s, split ? s.weight : Real(s.weight) * share);
    AddBlock(sight, row, column, split);
    EndPair(&pair);
  }

  void AddFarPatches(const Sight& sight, const FarSample& s,
                     const GridRange& range) {
    options_.patches->SharesIn(options_.visibility->grid(), sight.hidden,
                               sight.n, range, sight.seen, &shares_);
    for (const PatchShare& e : shares_) {
      AddPatch(s, e.patch,
               Real(s.weight) * cells_[s.cell].solid_angle * e.share);
    }
  }

  // The texels of a block of the map; `split`: each with its visible share.
  void AddBlock(const Sight& sight, int row, int column, bool split) {
    for (int k = 0; k < block_ * block_; ++k) {
      const int y = row * block_ + k / block_, x = column * block_ + k % block_;
      Real weight = TexelSolidAngle(y, height_, width_);
      if (split) {
        const VisibilityGrid& grid = options_.visibility->grid();
        weight *= grid.VisibleShare(sight.hidden, sight.n,
                                    grid.RangeOf(y, x, height_, width_));
      }
      to_.sources_.push_back({static_cast<uint32_t>(y * width_ + x), weight});
    }
  }

  void AddNear(const Sight& sight, const NearSample& s) {
    Real weight = s.weight;
    if (sight.hidden != nullptr) {
      const double visible =
          options_.visibility->grid().VisibleAlong(sight.hidden, sight.n, s.wi);
      const int patch = visible < 1.0 && !sight.seen.empty()
                            ? options_.patches->Along(sight.seen, s.wi)
                            : -1;
      if (patch >= 0) AddPatch(s, patch, weight * (1 - Real(visible)));
      weight *= visible;
      if (weight <= 0) return;
    }
    Pair pair = BeginPair(s, weight);
    AddTexelsAround(s.wi);
    EndPair(&pair);
  }

  // The four texels that the map is interpolated between.
  void AddTexelsAround(const Eigen::Vector3d& wi) {
    double row = 0.0, column = 0.0;
    FastMapPosition(wi, height_, width_, &row, &column);
    const double y0 = std::floor(row - 0.5), x0 = std::floor(column - 0.5);
    const Real y = Quantised(row - 0.5 - y0), x = Quantised(column - 0.5 - x0);
    const int wrapped = (static_cast<int>(x0) + width_) % width_;
    const int* at =
        &padded_[(static_cast<int>(y0) + 1) * (width_ + 1) + wrapped];
    for (int k = 0; k < 4; ++k) {
      const int down = k >> 1, right = k & 1;
      to_.sources_.push_back(
          {static_cast<uint32_t>(at[down * (width_ + 1) + right]),
           (down ? y : 1 - y) * (right ? x : 1 - x)});
    }
  }

  const bool of_patches_;
  const int height_, width_, block_;
  const TransportOptions& options_;
  const std::vector<FarCell> cells_;
  const PointQuadrature quadrature_;
  const std::vector<int> padded_;
  ReferenceTransport& to_;
  PointSamples samples_;
  std::vector<PatchShare> shares_;
};

ReferenceTransport::ReferenceTransport(const std::vector<ShadingPoint>& points,
                                       int map_height, int map_width,
                                       const TransportOptions& options)
    : ReferenceTransport(points, false, map_height, map_width, options) {}

ReferenceTransport ReferenceTransport::OfPatches(
    int map_height, int map_width, const TransportOptions& options) {
  TransportOptions own = options;
  own.visibility = options.patches->visibility();
  return {options.patches->points(), true, map_height, map_width, own};
}

ReferenceTransport::ReferenceTransport(const std::vector<ShadingPoint>& points,
                                       bool of_patches, int map_height,
                                       int map_width,
                                       const TransportOptions& options)
    : num_texels_(static_cast<size_t>(map_height) * map_width),
      num_sources_(num_texels_ +
                   (options.patches ? options.patches->count() : 0)),
      num_nodes_(options.grid.num_nodes()) {
  Builder builder(of_patches, map_height, map_width, options, this);
  for (const ShadingPoint& point : points) builder.AddPoint(point);
}

std::vector<Real> ReferenceTransport::Gather(
    int point, const std::vector<Real>& sources) const {
  std::vector<Real> light(3 * num_nodes_, 0);
  for (size_t i = point == 0 ? 0 : pair_end_[point - 1]; i < pair_end_[point];
       ++i) {
    const Pair& pair = pairs_[i];
    Real L[3] = {0, 0, 0};
    for (size_t s = pair.source_begin; s < pair.source_end; ++s) {
      for (int c = 0; c < 3; ++c) {
        L[c] += sources_[s].weight * sources[size_t{3} * sources_[s].texel + c];
      }
    }
    for (int k = 0; k < 8; ++k) {
      for (int c = 0; c < 3; ++c) {
        light[size_t{3} * pair.node[k] + c] +=
            pair.weight * pair.share[k] * L[c];
      }
    }
  }
  return light;
}

std::vector<Real> ReferenceTransport::MapRow(
    int point, const std::vector<Real>& field) const {
  std::vector<Real> row(num_sources_, 0);
  for (size_t i = point == 0 ? 0 : pair_end_[point - 1]; i < pair_end_[point];
       ++i) {
    const Pair& pair = pairs_[i];
    Real f = 0;
    for (int k = 0; k < 8; ++k) f += pair.share[k] * field[pair.node[k]];
    for (size_t s = pair.source_begin; s < pair.source_end; ++s) {
      row[sources_[s].texel] += pair.weight * f * sources_[s].weight;
    }
  }
  return row;
}

ReferenceBounces::ReferenceBounces(const std::vector<ShadingPoint>& points,
                                   int map_height, int map_width,
                                   const TransportOptions& options)
    : bounces_(options.patches->bounces()),
      points_(points, map_height, map_width, options),
      patches_(ReferenceTransport::OfPatches(map_height, map_width, options)) {}

ReferenceBounces::Rows ReferenceBounces::Derivatives(
    int point, int c, const std::vector<Real>& map,
    const std::vector<Real>& field) const {
  const size_t texels = points_.num_texels(), nodes = field.size();
  const int count = patches_.num_points();
  // Sources of every bounce, the patches dark before the first; only channel
  // c is kept.
  std::vector<Real> dark(3 * points_.num_sources(), 0);
  std::copy(map.begin(), map.end(), dark.begin());
  std::vector<std::vector<Real>> sources = {dark};
  for (int b = 0; b < bounces_; ++b) {
    std::vector<Real> next = dark;
    for (int j = 0; j < count; ++j) {
      const std::vector<Real> light = patches_.Gather(j, sources.back());
      Real L_o = 0;
      for (size_t n = 0; n < nodes; ++n) L_o += field[n] * light[3 * n + c];
      next[3 * (texels + j) + c] = L_o;
    }
    sources.push_back(next);
  }
  Rows out;
  out.by_grid.assign(nodes, 0);
  const auto add = [&](const std::vector<Real>& light, Real factor) {
    for (size_t n = 0; n < nodes; ++n) {
      out.by_grid[n] += factor * light[3 * n + c];
    }
  };
  add(points_.Gather(point, sources.back()), 1);
  // By every source as it was lit last.
  std::vector<Real> by_source = points_.MapRow(point, field);
  for (int b = bounces_; b > 0; --b) {
    std::vector<Real> before(by_source.begin(), by_source.begin() + texels);
    before.resize(by_source.size(), 0);
    for (int j = 0; j < count; ++j) {
      const Real a = by_source[texels + j];
      if (a == 0) continue;
      add(patches_.Gather(j, sources[b - 1]), a);
      const std::vector<Real> row = patches_.MapRow(j, field);
      for (size_t t = 0; t < row.size(); ++t) before[t] += a * row[t];
    }
    by_source = std::move(before);
  }
  out.by_map.assign(by_source.begin(), by_source.begin() + texels);
  return out;
}

}  // namespace derivatives
}  // namespace ibrdf
