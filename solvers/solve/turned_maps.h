// A known map in other frames, and what points show under each of them.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// A latlong map of the library's frame, mirrored in the plane x = 0 and then
// turned about +y by `columns` of its width: what was at +z comes to +x after a
// quarter of them.
Image Turned(const Image& map, bool mirrored, int columns);

// Whether all channels of a pixel are known, not bounded.
bool HasKnownRadiance(const Observations& observed, size_t pixel);

// Of the turns of a known map the one with the least misfit, whatever that is
// of, and the misfit of the map as it is given.
struct MapTurns {
  double as_given = 0.0;
  MapTurn best;
};

// Radiance under all turns of the setup's map, mirrored and not, in steps of
// 360 / 64 degrees and no finer than the map; light from no direction but the
// map's, without bounces.
class TurnedMaps {
 public:
  // lobes: of the setup's grid.
  TurnedMaps(const SolveSetup& setup, const std::vector<ShadingPoint>& points,
             const std::vector<BrdfGrid>& lobes);

  int num_turns() const { return 2 * columns_; }
  // The radiance [points] of a lobe in a channel. The first turn is the map as
  // it is given.
  Eigen::VectorXd Radiance(int turn, size_t lobe, int channel) const {
    return radiance_[lobe].col(3 * turn + channel).cast<double>();
  }
  // misfits: of all turns. The first of the least is taken, or the best of the
  // quarter turns, by which frames differ, where its misfit is at most
  // `as_good` times that.
  MapTurns Best(const std::vector<double>& misfits, double as_good = 1.0) const;

 private:
  using FloatMatrix =
      Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int columns_ = 0;
  std::vector<FloatMatrix> radiance_;  // of a lobe [points][3 turns]
};

}  // namespace ibrdf
