// Radiance of unshadowed points under spherical Gaussians, as Wang et al. 2009
// render dynamic materials: enough where the reflectance is not mirror-like.
//
// L_o_ic = sum_k a_kc T_c(theta_i, mu_k in the frame of point i; lambda_k),
// where T is f_r cos(theta) blurred by a Gaussian of sharpness lambda. T of
// broad Gaussians is tabulated for some view angles and axes by the quadrature
// of Transport and interpolated between them; sharp ones are integrated by
// directions of their own at every point. So L_o is linear in the BRDF and
// linear in the amplitudes, and constant light on a Lambertian surface is
// exact. Where Wang et al. fit Gaussians to the BRDF, which is not linear, this
// one does not.
//
// Shapes: amplitudes [lobes, 3]; L_o [points, 3]; BRDF grid [3, nodes].
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
  // Angles that tables are worked out for, at equal steps; at least 4.
  int view_angles = 12;
  // Gaussians up to this sharpness, at least 8, are broad: each sharpness has
  // its table.
  double broad = 64.0;
  // Steps of an axis' angle to the normal, over the square root of 8 +
  // sharpness; twice as many around it.
  double axis_steps = 7.0;
  // Of the tables; far_width: cells of them.
  QuadratureOptions quadrature = {8.0, 16.0, 12, 32, 64};
  int num_threads = 0;
};

// Immutable after construction, its functions may be called from one thread at
// a time. Same bits for any number of threads.
class GaussianTransport {
 public:
  GaussianTransport(std::vector<SphericalGaussian> lobes,
                    const GaussianOptions& options);

  int num_lobes() const { return static_cast<int>(lobes_.size()); }
  int num_tables() const { return static_cast<int>(levels_.size()); }

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
  Tables Tabulate(const BrdfGrid& grid) const;
  Tables Tabulate(const BrdfFunction& brdf) const;

  // Radiance, negative where amplitudes are.
  void Render(const std::vector<ShadingPoint>& points, const Tables& tables,
              const GaussianColours& amplitudes, double* L_o) const;
  // gradient [3, nodes] of sum adjoint.L_o in the grid.
  void GridGradient(const std::vector<ShadingPoint>& points,
                    const GaussianColours& amplitudes, const double* adjoint,
                    float* gradient) const;
  // Gradient [lobes, 3] of sum adjoint.L_o in the amplitudes; GaussianLight
  // takes it to the map.
  GaussianColours AmplitudeGradient(const std::vector<ShadingPoint>& points,
                                    const Tables& tables,
                                    const double* adjoint) const;

 private:
  // A light direction of the quadrature at one view angle.
  struct Sample {
    double theta_h, theta_d, phi_d;
    double weight;
  };
  struct View {
    std::vector<Sample> near, far;
    Eigen::Matrix3Xf near_directions;  // x along wo's side, z the normal
    std::vector<int> cells;            // of far
  };
  // Broad lobes of one sharpness.
  struct Level {
    double sharpness;
    int rows, columns;  // of axes; rows + 1 of nodes
  };
  // A direction of a sharp lobe.
  struct Ray {
    Eigen::Vector3d wi;
    double weight;
    int lobe;
  };
  struct Frame;  // of a point
  // Where T of one broad lobe is looked up.
  struct Taps {
    size_t offset[4];
    float weight[4];
  };

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
