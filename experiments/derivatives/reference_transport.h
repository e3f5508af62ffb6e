// Transport's sums in long double, pair by pair.
#pragma once
#include <cstdint>
#include <vector>

#include "experiments/derivatives/error_table.h"
#include "ibrdf/render/transport.h"

namespace ibrdf {
namespace derivatives {

// The same samples, taps and shadows as Transport, fractions rounded to the
// same 1/65535, as they are part of what E is; weights, light, BRDF and sums in
// long double. Shapes as in transport.h.
class ReferenceTransport {
 public:
  ReferenceTransport(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const TransportOptions& options);

  int num_points() const { return static_cast<int>(pair_end_.size()); }
  size_t num_texels() const { return num_texels_; }
  size_t num_nodes() const { return num_nodes_; }

  // light [nodes][3] that a point gathers at each node: its E is
  // sum_n f_c(n) light_nc.
  std::vector<Real> Gather(int point, const std::vector<Real>& map) const;
  // row [texels] of a point for a scalar field [nodes]: its E is
  // sum_t row_t L_t.
  std::vector<Real> MapRow(int point, const std::vector<Real>& field) const;

 private:
  struct Source {
    uint32_t texel;
    Real weight;
  };
  struct Pair {
    uint32_t node[8];
    Real share[8];
    Real weight;
    size_t source_begin, source_end;
  };
  size_t num_texels_, num_nodes_;
  std::vector<Source> sources_;
  std::vector<Pair> pairs_;
  std::vector<size_t> pair_end_;  // by point
};

}  // namespace derivatives
}  // namespace ibrdf
