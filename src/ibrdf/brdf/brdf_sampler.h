// Importance sampling of incident directions for a view, with its exact pdf.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/flow_brdf.h"

namespace ibrdf {

struct BrdfSamplerOptions {
  int views = 48;        // view angles that are tabulated, 0 to 88.5 degrees
  int theta_cells = 64;  // along the half-vector's theta_h
  int phi_cells = 40;    // along its azimuth from the view, [0, 2 pi)
  // Share of cosine-weighted samples, (0, 1]: bounds weights f cos / pdf where
  // a table is wrong.
  double cosine_share = 0.05;
};

// Local frame, normal = +z, unit directions. A view fixes a surface in the
// flow's cube, not a coordinate, so that the inverse flow alone cannot draw
// from it: the density f_r cos(theta_i) of half-vectors is tabulated for some
// view angles once, as the flow (or any other BRDF) gives it, the mean of the
// channels, and inverted by its cumulative sums. Cells reach to the horizon of
// the light directions, of whichever view: no sample falls below it, and the
// pdf integrates to 1 over the hemisphere whatever the table holds. A view
// between tabulated ones mixes its two neighbours.
// Immutable; safe to share between threads.
class BrdfSampler {
 public:
  // Values that are negative or not finite count as 0. Calls brdf once a view.
  explicit BrdfSampler(const BrdfBatch& brdf,
                       const BrdfSamplerOptions& options = {});

  struct Sample {
    Eigen::Vector3d wi;
    double pdf;  // 1/sr, as Pdf; 0 where rounding put wi on the horizon
  };
  // wo: z > 0. u1, u2, u3: uniform in [0, 1).
  Sample Draw(const Eigen::Vector3d& wo, double u1, double u2, double u3) const;

  // With respect to solid angle of wi, 1/sr; 0 where wi or wo has z <= 0.
  double Pdf(const Eigen::Vector3d& wo, const Eigen::Vector3d& wi) const;

 private:
  struct Table {
    std::vector<double> mass;       // [theta_cells * phi_cells], sum 1
    std::vector<double> theta_sum;  // cumulative, [theta_cells + 1]
    std::vector<double> phi_sum;    // of each row, [theta][phi_cells + 1]
    bool empty = true;              // no mass at all
  };
  // The two tables next to a view and the share of the second.
  struct Neighbours {
    int first, second;
    double share;
  };
  Neighbours Near(double theta_o) const;
  double ViewAngle(int view) const;
  double CosineShare(const Table& a, const Table& b) const;
  void Fill(const BrdfBatch& brdf, int view);
  Eigen::Vector3d DrawHalfVector(const Table& table, double theta_o, double u1,
                                 double u2) const;

  BrdfSamplerOptions options_;
  std::vector<Table> tables_;
};

}  // namespace ibrdf
