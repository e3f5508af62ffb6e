// Radiance of unshadowed points in spherical harmonics: enough where the
// reflectance is matte or the light soft (Ramamoorthi and Hanrahan 2001, 2002).
//
// L_o_ic = sum_lm S_clm(theta_i) L_clm(i): the coefficients of the map in a
// frame of the point, about its view direction, times those of f_r cos(theta)
// seen from angle theta to the normal, up to l = order. S is worked out for
// some angles by the quadrature of Transport and interpolated between them, so
// that L_o is linear in the BRDF grid and linear in the map, and constant light
// on a Lambertian surface is exact.
//
// Shapes as in Transport: map [H, W, 3], taken as constant over its texels;
// L_o [points, 3]; BRDF grid [3, nodes].
#pragma once
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

struct HarmonicOptions {
  int order = 4;  // largest l
  BrdfGridShape grid;
  // Angles that the BRDF is worked out for, at equal steps; at least 4.
  int view_angles = 48;
  QuadratureOptions quadrature;  // far cells: those of a map of far_width
  int num_threads = 0;
};

// Immutable after construction; thread rules as Transport's. Same bits for any
// number of threads.
class HarmonicTransport {
 public:
  HarmonicTransport(const std::vector<ShadingPoint>& points, int map_height,
                    int map_width, const HarmonicOptions& options);

  int num_points() const { return static_cast<int>(points_.size()); }

  // Radiance, negative where a cut-off series rings below zero.
  void Render(const BrdfGrid& grid, const float* map, double* L_o) const;
  // gradient [3, nodes] of sum adjoint.L_o in the grid.
  void GridGradient(const float* map, const double* adjoint,
                    float* gradient) const;
  // gradient [H, W, 3] of sum adjoint.L_o in the map.
  void MapGradient(const BrdfGrid& grid, const double* adjoint,
                   float* gradient) const;

  // Mean |log error| over points and channels of what the degrees above l
  // leave out, for l = 0 to order, predicted from the two power spectra: were
  // the map turned at random, those degrees would have the variance
  // sum |S_l|^2 |L_l|^2 / (2 l + 1). Degrees above `order` count as nothing:
  // ask an object of a higher order (20, say), for a few points. Radiance below
  // 1e-3 of its mean counts as that.
  std::vector<double> PredictLogErrors(const BrdfGrid& grid,
                                       const float* map) const;

 private:
  // One light direction at one view angle.
  struct Pair {
    int node[8];
    float weight[8];  // interpolation
    int cell;         // far: of projection cells_; near: -1
    double share;     // times the cell's integral, or Y(direction)
    Eigen::Vector3d direction;
  };
  struct Point {
    int first;  // of four angles
    double weight[4];
    double turn;  // about the view direction, radians
    int pole;
  };
  // S [count] of each angle.
  std::vector<HarmonicColours> Slices(const BrdfGrid& grid) const;
  // Y of a pair: what a unit of f_r adds to S.
  void PairHarmonics(const Pair& pair, double* Y) const;
  HarmonicColours SliceAt(const std::vector<HarmonicColours>& slices,
                          const Point& point) const;
  // Calls use(point index, L) with the map's coefficients in each point's
  // frame, a chunk of points at a time.
  template <typename Use>
  void ForLight(const float* map, const Use& use) const;

  HarmonicOptions options_;
  HarmonicBasis basis_;
  HarmonicProjection map_, cells_;
  HarmonicRotation rotation_;
  std::vector<HarmonicRotation::Pole> poles_;
  std::vector<Point> points_;
  std::vector<std::vector<Pair>> pairs_;  // by angle
};

}  // namespace ibrdf
