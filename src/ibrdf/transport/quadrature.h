// Directions and weights for radiance L_o(n, wo) = int f_r L cos(theta_i) dwi.
//
// Two rules share the integrand by a smooth partition g(theta_h): half-vectors
// on rings around the normal where a specular peak may be (near), the cells of
// the map elsewhere (far). Both depend on geometry and sizes alone, never on
// f_r or L, so that L_o is linear in each of them.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "ibrdf/transport/quadrature_kernels.h"

namespace ibrdf {

struct QuadratureOptions {
  double near_begin_degrees = 8.0;  // theta_h below it belongs to near alone
  double near_end_degrees = 16.0;   // and above it to far alone
  int near_rings = 20;  // theta_h edges at near_end (i / near_rings)^3
  // Half-vectors on the outermost ring; inner rings have fewer in proportion
  // to i / near_rings, so that cells keep their shape.
  int near_ring_samples = 56;
  int far_width = 64;  // wider maps are taken in blocks of texels
};

// g(theta_h): 1 up to near_begin, 0 from near_end, smoothstep between.
double NearShare(double theta_h, const QuadratureOptions& options);

// Mean of max(x, 0) over x uniform in [c - a, c + a], a >= 0: the cosine of a
// cell that the horizon may cut.
double MeanClippedCosine(double c, double a);

// A cell of the sphere of light directions.
struct FarCell {
  Eigen::Vector3d direction;             // unit
  Eigen::Vector3d half_theta, half_phi;  // centre to edges, radians
  double solid_angle;                    // sr
};

// Side of the square blocks, in texels, in which a map is taken: the smallest
// power of two that divides both sides and leaves at most far_width columns;
// the largest that divides them where none does.
int FarBlockSize(int map_height, int map_width, int far_width);

// Blocks that this leaves of a map.
int NumFarCells(int map_height, int map_width, int far_width);

// Cells of blocks of block x block texels, row-major; block divides both sides.
std::vector<FarCell> MapCells(int map_height, int map_width, int block);

// What the far rule reads of cells, component by component.
class FarDirections {
 public:
  explicit FarDirections(const std::vector<FarCell>& cells);
  int count() const { return static_cast<int>(values_[0].size()); }
  FarCellColumns columns() const;

 private:
  std::array<std::vector<double>, 9> values_;
};

// A frame around n whose first axis t lies in the plane of n and wo, on the
// side of wo: wo = (wo.t, 0, n.wo). n, wo: unit.
void ViewFrame(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
               Eigen::Vector3d* t, Eigen::Vector3d* b);

struct NearSample {
  double theta_h, theta_d, phi_d;  // radians
  double x_h;                      // of ToUnitCube
  Eigen::Vector3d wi;              // world, unit; L is looked up here
  double weight;                   // L_o += weight f_r L
};
struct FarSample {
  double theta_h, theta_d, phi_d;
  double x_h;
  int cell;
  double weight;  // L_o += weight f_r (radiance times solid angle of the cell)
};
struct PointSamples {
  std::vector<NearSample> near;
  std::vector<FarSample> far;
  // What the two rules' weights were multiplied by so that constant light on a
  // Lambertian surface is exact; 1 for a perfect rule.
  double near_correction = 1.0;
  double far_correction = 1.0;
};

// Immutable; safe to share between threads.
class PointQuadrature {
 public:
  PointQuadrature(const std::vector<FarCell>& cells,
                  const QuadratureOptions& options);

  // n, wo: world, unit, n.wo > 0. Sums of near and far weights (far: times the
  // cell's solid angle) are the exact shares of int cos = pi.
  void Sample(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
              PointSamples* samples) const;

  // The two rules by themselves; each returns its correction. The near one
  // depends on the view angle alone: its wi are in the frame of ViewFrame, with
  // wo = (sin_o, 0, cos_o), and not normalised to the last bits.
  double SampleNear(double cos_o, double sin_o,
                    std::vector<NearSample>* samples) const;
  double SampleFar(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
                   std::vector<FarSample>* samples) const;
  // The far rule over other cells, without correction.
  void SampleCells(const FarDirections& cells, const Eigen::Vector3d& n,
                   const Eigen::Vector3d& wo,
                   std::vector<FarSample>* samples) const;

 private:
  struct HalfVector {
    double theta_h, phi_h;
    double cos_h, sin_h, cos_p, sin_p;
    double half_theta, half_phi;  // centre to edges of the cell, radians
    double measure;               // g(theta_h) times solid angle
  };
  static std::vector<HalfVector> Rings(int rings, int ring_samples,
                                       const QuadratureOptions& options);
  // It takes milliseconds: kept for the options of the last call.
  static std::shared_ptr<const std::vector<double>> NearIntegrals(
      const QuadratureOptions& options);
  static double NearSum(const std::vector<HalfVector>& half_vectors,
                        double cos_o, double sin_o);
  double NearIntegral(double theta_o) const;

  QuadratureOptions options_;
  FarDirections directions_;          // of the cells
  std::vector<double> solid_angles_;  // sr
  std::vector<HalfVector> half_vectors_;
  // At equal steps of theta_o.
  std::shared_ptr<const std::vector<double>> near_integral_;
};

}  // namespace ibrdf
