// Radiance in spherical harmonics in long double, from its definition.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "experiments/validation/derivatives/error_table.h"
#include "ibrdf/approximation/harmonic_transport.h"

namespace ibrdf {
namespace derivatives {

// The samples, taps and view angles of HarmonicTransport, as they are part of
// what L_o is; harmonics by the standard library's Legendre functions, their
// integrals by Gauss-Legendre, and those of the map in every point's own frame,
// without rotations of coefficients. Shapes as in harmonic_transport.h.
class ReferenceHarmonics {
 public:
  ReferenceHarmonics(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const HarmonicOptions& options);

  // row [texels] of a point for a scalar field [nodes]: its L_o is
  // sum_t row_t L_t.
  std::vector<Real> MapRow(int point, const std::vector<Real>& field) const;
  // row [nodes] of a point for one channel of a map [texels]: its L_o is
  // sum_n row_n f_n.
  std::vector<Real> GridRow(int point, const std::vector<Real>& map) const;

 private:
  using Harmonics = std::vector<Real>;  // [NumHarmonics(order)]
  struct Pair {
    std::array<uint32_t, 8> node;
    std::array<Real, 8> weight;
    Harmonics Y;  // times the weight of the sample
  };
  struct Point {
    int first = 0;  // of four view angles
    std::array<Real, 4> weight;
    std::vector<Harmonics> texels;  // int Y over each, in the point's frame
  };
  std::vector<Pair> PairsAt(int angle, const HarmonicOptions& options);

  int order_;
  size_t num_nodes_;
  std::map<int, Harmonics> cells_;          // of the view angles' frame
  std::map<int, std::vector<Pair>> pairs_;  // by view angle
  std::vector<Point> points_;
};

}  // namespace derivatives
}  // namespace ibrdf
