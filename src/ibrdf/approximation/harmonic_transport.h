// Radiance of unshadowed points in spherical harmonics: enough where the
// reflectance is matte or the light soft (Ramamoorthi and Hanrahan 2001, 2002).
//
//   L_o_ic = sum_lm S_clm(theta_i) L_clm(i)
//
// L are the coefficients of the map in a frame of the point, about its view
// direction; S are those of f_r cos(theta) seen at angle theta_i to the normal;
// the sum ends at l = order. S is worked out for some view angles by the
// quadrature of Transport and interpolated between them, so that L_o is linear
// in the BRDF grid and linear in the map, and constant light on a Lambertian
// surface is exact.
//
// Shapes: map [H, W, 3] radiance, taken as constant over its texels; L_o
// [points, 3] radiance; BRDF grid [3, nodes] in 1/sr.
#pragma once
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/linear_transport.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

struct HarmonicOptions {
  int order = 4;  // largest l
  BrdfGridShape grid;
  // The BRDF is worked out for so many view angles at equal steps; at least 4.
  int view_angles = 48;
  QuadratureOptions quadrature;  // far cells: those of a map of far_width
  int num_threads = 0;           // <= 0: all
};

class HarmonicOperator;

// A transport is immutable after construction. One thread at a time may call
// its functions (they are parallel inside). Same bits for any number of
// threads. HarmonicRadiance is its RadianceRenderer.
class HarmonicTransport {
 public:
  HarmonicTransport(const std::vector<ShadingPoint>& points, int map_height,
                    int map_width, const HarmonicOptions& options);

  int num_points() const { return static_cast<int>(points_.size()); }

  // Radiance, negative where a cut-off series rings below zero.
  void Render(const BrdfGrid& grid, const float* map, double* L_o) const;
  // L_o as a function of the map, for a fixed BRDF. The transport must outlive
  // the operator.
  HarmonicOperator ByLight(const BrdfGrid& grid) const;
  // gradient [3, nodes] of sum adjoint . L_o in the grid.
  void GridGradient(const float* map, const double* adjoint,
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
  friend class HarmonicOperator;
  // One light direction at one view angle.
  struct Pair {
    int node[8];
    float weight[8];  // interpolation
    int cell;         // far: of projection cells_; near: -1
    double share;     // times the cell's integral, or Y(direction)
    Eigen::Vector3d direction;
  };
  struct Point {
    int first;  // of four view angles
    double weight[4];
    double turn;  // about the view direction, radians
    int pole;
  };
  // S [count] of each view angle.
  using Slices = std::vector<HarmonicColours>;

  // Construction: a point's place between view angles and its turn; the pairs
  // of a view angle.
  void AddPoint(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
                bool is_new_pole);
  void AddPairs(const PointQuadrature& quadrature, double view_angle,
                std::vector<Pair>* pairs) const;
  // Radians between two view angles.
  double ViewStep() const;

  Slices SlicesOf(const BrdfGrid& grid) const;
  // Y of a pair: what a unit of f_r adds to S.
  void PairHarmonics(const Pair& pair, double* Y) const;
  HarmonicColours SliceAt(const Slices& slices, const Point& point) const;
  // Calls use(chunk, point index, L) with the map's coefficients in each
  // point's frame, a chunk of points at a time.
  template <typename Use>
  void ForLight(const float* map, const Use& use) const;
  // L_o of the slices' BRDF, and its transpose in the map.
  void RenderSlices(const Slices& slices, const float* map, double* L_o) const;
  void MapGradient(const Slices& slices, const double* adjoint,
                   float* gradient) const;

  HarmonicOptions options_;
  HarmonicBasis basis_;
  HarmonicProjection map_, cells_;
  HarmonicRotation rotation_;
  std::vector<HarmonicRotation::Pole> poles_;
  std::vector<Point> points_;
  std::vector<std::vector<Pair>> pairs_;  // by view angle
};

// HarmonicTransport::ByLight: the slices of a BRDF are worked out once.
class HarmonicOperator final : public LinearTransport {
 public:
  int num_points() const override { return transport_.num_points(); }
  void ApplyLinear(const float* map, double* L_o) const override;
  void ApplyTranspose(const double* adjoint, float* gradient) const override;

 private:
  friend class HarmonicTransport;
  HarmonicOperator(const HarmonicTransport& transport, const BrdfGrid& grid)
      : transport_(transport), slices_(transport.SlicesOf(grid)) {}

  const HarmonicTransport& transport_;
  HarmonicTransport::Slices slices_;
};

}  // namespace ibrdf
