// Transport's sums in long double, pair by pair.
#pragma once
#include <cstdint>
#include <vector>

#include "experiments/validation/derivatives/error_table.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace derivatives {

// The same samples, taps, shadows and patches as Transport, fractions rounded
// to the same 1/65535, as they are part of what L_o is; weights, light, BRDF
// and sums in long double. Shapes as in transport.h. Sources of light are the
// map's texels and, behind them, the patches.
class ReferenceTransport {
 public:
  ReferenceTransport(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const TransportOptions& options);
  // The transport of the patches of `options`.
  static ReferenceTransport OfPatches(int map_height, int map_width,
                                      const TransportOptions& options);

  int num_points() const { return static_cast<int>(pair_end_.size()); }
  size_t num_texels() const { return num_texels_; }
  size_t num_sources() const { return num_sources_; }
  size_t num_nodes() const { return num_nodes_; }

  // light [nodes][3] that a point gathers at each node from sources
  // [sources][3]: its L_o is sum_n f_c(n) light_nc.
  std::vector<Real> Gather(int point, const std::vector<Real>& sources) const;
  // row [sources] of a point for a scalar field [nodes]: its L_o is
  // sum_t row_t L_t.
  std::vector<Real> MapRow(int point, const std::vector<Real>& field) const;

 private:
  ReferenceTransport(const std::vector<ShadingPoint>& points, bool of_patches,
                     int map_height, int map_width,
                     const TransportOptions& options);
  class Builder;  // appends points' pairs
  struct Source {
    uint32_t texel;  // or texels + patch
    Real weight;
  };
  struct Pair {
    uint32_t node[8];
    Real share[8];
    Real weight;
    size_t source_begin, source_end;
  };
  size_t num_texels_, num_sources_, num_nodes_;
  std::vector<Source> sources_;
  std::vector<Pair> pairs_;
  std::vector<size_t> pair_end_;  // by point
};

// Radiance of points after all bounces, by light and BRDF, from a chain of the
// above.
class ReferenceBounces {
 public:
  ReferenceBounces(const std::vector<ShadingPoint>& points, int map_height,
                   int map_width, const TransportOptions& options);

  struct Rows {
    std::vector<Real> by_map;   // [texels]
    std::vector<Real> by_grid;  // [nodes]
  };
  // dL_o of a point in channel c, for map [texels][3] and field [nodes], which
  // is the BRDF's channel c.
  Rows Derivatives(int point, int c, const std::vector<Real>& map,
                   const std::vector<Real>& field) const;

 private:
  int bounces_;
  ReferenceTransport points_, patches_;
};

}  // namespace derivatives
}  // namespace ibrdf
