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
  const int block =
      FarBlockSize(map_height, map_width, options.quadrature.far_width);
  const int columns = map_width / block;
  const PointQuadrature quadrature(MapCells(map_height, map_width, block),
                                   options.quadrature);
  const std::vector<int> padded = PaddedTexels(map_height, map_width);
  const BrdfGridShape& shape = options.grid;
  const auto begin_pair = [&](const auto& sample, Real weight) {
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
    pair.source_begin = sources_.size();
    return pair;
  };
  const auto end_pair = [&](Pair* pair) {
    pair->source_end = sources_.size();
    pairs_.push_back(*pair);
  };
  const Visibility* const visibility = options.visibility.get();
  const RadiosityPatches* const patches = options.patches.get();
  const std::vector<FarCell> cells = MapCells(map_height, map_width, block);
  std::vector<PatchShare> shares;
  const auto add_patch = [&](const auto& sample, int patch, Real weight) {
    Pair pair = begin_pair(sample, weight);
    sources_.push_back({static_cast<uint32_t>(num_texels_ + patch), 1});
    end_pair(&pair);
  };
  PointSamples samples;
  for (const ShadingPoint& point : points) {
    const Eigen::Vector3d n = point.normal.cast<double>().normalized();
    const uint64_t* const hidden =
        visibility != nullptr ? visibility->Hidden(point) : nullptr;
    SeenPatches seen;
    if (hidden != nullptr && patches != nullptr) {
      seen =
          of_patches ? patches->SeenFromPatch(point) : patches->SeenFrom(point);
    }
    quadrature.Sample(n, point.wo.cast<double>().normalized(), &samples);
    for (const FarSample& s : samples.far) {
      const int row = s.cell / columns, column = s.cell % columns;
      const VisibilityGrid* grid =
          hidden != nullptr ? &visibility->grid() : nullptr;
      double share = 1.0;
      if (grid != nullptr) {
        const GridRange range =
            grid->RangeOf(row, column, map_height / block, columns);
        share = grid->VisibleShare(hidden, n, range);
        if (share < 1.0 && !seen.empty()) {
          patches->SharesIn(*grid, hidden, n, range, seen, &shares);
          for (const PatchShare& e : shares) {
            add_patch(s, e.patch,
                      Real(s.weight) * cells[s.cell].solid_angle * e.share);
          }
        }
        if (share <= 0.0) continue;
      }
      // A block that is hidden in part is taken texel by texel.
      const bool split = share < 1.0 && block > 1;
      Pair pair = begin_pair(s, split ? s.weight : Real(s.weight) * share);
      for (int k = 0; k < block * block; ++k) {
        const int y = row * block + k / block, x = column * block + k % block;
        Real weight = TexelSolidAngle(y, map_height, map_width);
        if (split) {
          weight *= grid->VisibleShare(
              hidden, n, grid->RangeOf(y, x, map_height, map_width));
        }
        sources_.push_back({static_cast<uint32_t>(y * map_width + x), weight});
      }
      end_pair(&pair);
    }
    for (const NearSample& s : samples.near) {
      Real weight = s.weight;
      if (hidden != nullptr) {
        const double visible = visibility->grid().VisibleAlong(hidden, n, s.wi);
        const int patch =
            visible < 1.0 && !seen.empty() ? patches->Along(seen, s.wi) : -1;
        if (patch >= 0) add_patch(s, patch, weight * (1 - Real(visible)));
        weight *= visible;
        if (weight <= 0) continue;
      }
      Pair pair = begin_pair(s, weight);
      double row = 0.0, column = 0.0;
      FastMapPosition(s.wi, map_height, map_width, &row, &column);
      const double y0 = std::floor(row - 0.5), x0 = std::floor(column - 0.5);
      const Real y = Quantised(row - 0.5 - y0),
                 x = Quantised(column - 0.5 - x0);
      const int wrapped = (static_cast<int>(x0) + map_width) % map_width;
      const int* at =
          &padded[(static_cast<int>(y0) + 1) * (map_width + 1) + wrapped];
      for (int k = 0; k < 4; ++k) {
        const int down = k >> 1, right = k & 1;
        sources_.push_back(
            {static_cast<uint32_t>(at[down * (map_width + 1) + right]),
             (down ? y : 1 - y) * (right ? x : 1 - x)});
      }
      end_pair(&pair);
    }
    pair_end_.push_back(pairs_.size());
  }
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
