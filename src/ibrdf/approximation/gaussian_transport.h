// Radiance of unshadowed points under spherical Gaussians, as Wang et al. 2009
// render dynamic materials: enough where the reflectance is not mirror-like.
//
//   L_o_ic = sum_k a_kc T_c(theta_i, mu_k in the frame of point i; lambda_k)
//
// a is the amplitude, mu the axis and lambda the sharpness of Gaussian k; T is
// f_r cos(theta) blurred by it. T of broad Gaussians is tabulated for some view
// angles and axes by the quadrature of Transport and interpolated between them;
// sharp ones are integrated by directions of their own at every point. So L_o
// is linear in the BRDF and linear in the amplitudes, and constant light on a
// Lambertian surface is exact. Wang et al. fit Gaussians to the BRDF, which is
// not linear; this renderer does not.
//
// Shapes: amplitudes [lobes, 3] radiance; L_o [points, 3] radiance; BRDF grid
// [3, nodes] in 1/sr.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/approximation/gaussian_light.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

struct GaussianOptions {
  BrdfGridShape grid;
  // Tables are worked out for so many view angles at equal steps; at least 4.
  int view_angles = 12;
  // Gaussians up to this sharpness, at least 8, are broad: each sharpness has
  // its table.
  double broad = 64.0;
  // An axis' angle to the normal has so many steps, times the square root of 8
  // + sharpness; the angle around the normal has twice as many.
  double axis_steps = 7.0;
  // The rule of the tables; far_width: the width of the map of their cells.
  QuadratureOptions quadrature = {8.0, 16.0, 12, 32, 64};
  int num_threads = 0;  // <= 0: all
};

// A transport is immutable after construction. One thread at a time may call
// its functions (they are parallel inside). Same bits for any number of
// threads. GaussianOperator is its LinearTransport, GaussianRadiance its
// RadianceRenderer.
class GaussianTransport {
 public:
  GaussianTransport(std::vector<SphericalGaussian> lobes,
                    const GaussianOptions& options);

  int num_lobes() const { return static_cast<int>(lobes_.size()); }

  // What broad lobes reflect off a BRDF.
  class Tables {
   private:
    friend class GaussianTransport;
    // By sharpness: [axis row, axis column, view angle, 4], the last unused.
    std::vector<std::vector<float>> levels;
    BrdfFunction brdf;
  };
  // The BRDF must outlive the tables; the function may be called from several
  // threads at a time.
  Tables Tabulate(const BrdfFunction& brdf) const;
  Tables Tabulate(const BrdfGrid& grid) const;

  // Radiance; it is negative where amplitudes make it so.
  void Render(const std::vector<ShadingPoint>& points, const Tables& tables,
              const GaussianColours& amplitudes, double* L_o) const;
  // gradient [lobes, 3] of sum adjoint . L_o in the amplitudes; GaussianLight
  // takes it to the map.
  GaussianColours AmplitudeGradient(const std::vector<ShadingPoint>& points,
                                    const Tables& tables,
                                    const double* adjoint) const;
  // gradient [3, nodes] of sum adjoint . L_o in the grid that was tabulated.
  // No program takes it: it is part of what every transport here promises, and
  // tests hold it to the transpose and to differences.
  void GridGradient(const std::vector<ShadingPoint>& points,
                    const GaussianColours& amplitudes, const double* adjoint,
                    float* gradient) const;

 private:
  // A light direction of the quadrature at one view angle.
  struct Sample {
    double theta_h, theta_d, phi_d;  // radians
    double weight;                   // L_o += weight f_r L
  };
  // The samples at one view angle. Directions are in the frame of the point: x
  // along wo's side, z the normal.
  struct View {
    std::vector<Sample> near, far;
    Eigen::Matrix3Xf near_directions;
    std::vector<int> cells;  // of far
  };
  // A table: broad lobes of one sharpness.
  struct Level {
    double sharpness;
    int rows, columns;  // of axes; rows + 1 of nodes
  };
  // A direction of a sharp lobe.
  struct Ray {
    Eigen::Vector3d wi;  // world, unit
    double weight;       // sr, times the lobe's amplitude: radiance
    int lobe;
  };
  struct Frame;  // of a point
  // Where T of one broad lobe is looked up.
  struct Taps {
    size_t offset[4];
    float weight[4];
  };
  struct GradientSums;

  int num_tables() const { return static_cast<int>(levels_.size()); }
  // Construction: the table of a sharpness, which it adds where there is none;
  // the rays of a sharp lobe; the samples of all view angles.
  int LevelFor(double sharpness);
  void AddRays(int lobe);
  void SampleViews();

  Frame FrameOf(const ShadingPoint& point) const;
  // False: the lobe is below the horizon.
  bool TapsOf(const Frame& frame, int lobe, Taps* taps) const;
  // Calls use(theta_h, theta_d, phi_d, weight, lobe) for the rays above the
  // horizon of a point.
  template <typename Use>
  void ForRays(const Frame& frame, const Use& use) const;
  // exp(sharpness (axis.w - 1)) of the axes of a table's row [columns] and
  // directions [3, n].
  static Eigen::MatrixXf RowOfGaussians(const Level& level, int row,
                                        const Eigen::Matrix3Xf& directions);
  // f_r times weight: far [cells, 3 views], near by view [n, 3].
  void TabulateLevels(const Eigen::MatrixXf& far,
                      const std::vector<Eigen::MatrixX3f>& near,
                      Tables* tables) const;
  size_t TableSize(const Level& level) const {
    return size_t{4} * (level.rows + 1) * level.columns * options_.view_angles;
  }

  // The transposes, step by step: from a point's radiance to table entries and
  // nodes; from the entries [level][entry] to nodes, through the directions of
  // the quadrature at each view angle, near [n, 3] and far [cells, 3].
  void AddPointGradient(const Frame& frame, const GaussianColours& amplitudes,
                        const double* adjoint, GradientSums* sums) const;
  void AddTableGradient(const std::vector<std::vector<double>>& by_entry,
                        std::vector<double>* by_node) const;
  void ToDirections(const std::vector<std::vector<double>>& by_entry, int view,
                    Eigen::MatrixX3d* near, Eigen::MatrixX3d* far) const;
  void AddToNodes(const Sample& sample, const Eigen::Vector3d& share,
                  std::vector<double>* by_node) const;

  GaussianOptions options_;
  std::vector<SphericalGaussian> lobes_;
  std::vector<int> broad_;     // indices of lobes
  std::vector<int> level_of_;  // of those
  std::vector<Level> levels_;
  std::vector<Ray> rays_;
  std::vector<View> views_;
  Eigen::Matrix3Xf far_directions_;  // [3, cells], as near_directions
};

}  // namespace ibrdf
