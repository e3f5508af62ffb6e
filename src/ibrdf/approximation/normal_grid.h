// Radiance by normal under one view direction, as reflectance_map.h describes
// it. Internal.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

// Fit renders; then points of the image, or any others seen from the same
// direction, may be interpolated. The renderer must outlive the grid.
class NormalGrid {
 public:
  // All points have one wo.
  NormalGrid(const std::vector<ShadingPoint>& points,
             const RadianceRenderer& renderer,
             const ReflectanceMapOptions& options);

  // Renders held-out points and nodes, so that interpolation is within the
  // error. False: `progress` stopped the renderer.
  bool Fit(const std::vector<ShadingPoint>& points,
           const RadianceRenderer::Progress& progress);
  // L_o [points, 3] of the points that Fit had: held-out ones as they were
  // rendered, others interpolated or, where they cannot be, rendered. False as
  // above.
  bool RenderFitted(const std::vector<ShadingPoint>& points,
                    const RadianceRenderer::Progress& progress, double* L_o);
  // The same of any points; nothing is known of them.
  bool RenderAny(const std::vector<ShadingPoint>& points,
                 const RadianceRenderer::Progress& progress, double* L_o) const;

  const ReflectanceMapReport& report() const { return report_; }

 private:
  // Angle to the view and turn around it, in steps of the finest nodes.
  struct Place {
    double row, column;
  };
  struct Cell {
    int row, column;  // first node
    int depth;
    double error;  // expected, nats
    std::vector<int> points;
    bool leaf = true;

    int steps() const;
  };
  // Points of the image that are rendered in any case: the error is measured
  // there.
  struct HeldOut {
    std::vector<int> index;     // into the points
    std::vector<int> place;     // of each point in index; -1: not held out
    std::vector<double> truth;  // [index, 3]
  };
  // What a call of Fit works on.
  struct Fitted {
    const std::vector<ShadingPoint>& points;
    const RadianceRenderer::Progress& progress;
    std::vector<Place> places;
  };

  // The steps of Fit, in order; those that may stop return false.
  bool RenderHeldOut(const Fitted& fitted);
  // Cuts the visible normals for the first time, where that may pay, and each
  // cell into its parts.
  bool MakeCells(const Fitted& fitted);
  // Cuts cells until the error at held-out points, of those whose cells meet
  // the tolerance, is within the requested one. Sets the tolerance; 0: it was
  // never within, and nothing may be interpolated.
  bool FindTolerance(const Fitted& fitted);
  void MeasureError(const Fitted& fitted, double tolerance);
  // Whether points of the cell may be interpolated.
  static bool IsGood(const Cell& cell, double tolerance) {
    return tolerance > 0.0 && cell.leaf && !(cell.error > tolerance);
  }
  void FindGoodCells();
  // The good cell of a place, null where there is none.
  const Cell* GoodCell(const Place& place) const;

  Place PlaceOf(const ShadingPoint& point) const;
  // A slot of radiance_; nodes asked for since the last call of RenderNodes()
  // have no values yet.
  int AskForNode(int row, int column);
  int NodeAt(int row, int column) const;
  bool RenderNodes(const RadianceRenderer::Progress& progress);

  double Log(double radiance, int channel) const;
  double NodeLog(int node, int channel) const {
    return Log(radiance_[size_t{3} * node + channel], channel);
  }
  // Sets dark_ from the nodes of the first cut.
  void FindDark();
  // Log radiance of a cell's quadratic, and radiance.
  Eigen::Array3d InterpolateLog(const Cell& cell, const Place& place) const;
  void Interpolate(const Cell& cell, const Place& place, double* L_o) const;
  // Asks for the nodes of the four parts of a cell.
  void AskForParts(const Cell& cell);
  // Error of a cell at the new nodes of its parts, mean of nodes and channels.
  double ErrorAtParts(const Cell& cell) const;
  void Cut(const Fitted& fitted, size_t cell, double error);
  // Whether cells of that error, cut as often as their points allow, are likely
  // to meet the tolerance.
  static bool WorthCutting(const Cell& cell, double tolerance);
  // Cuts cells until all meet the tolerance or are not worth it.
  bool Refine(const Fitted& fitted, double tolerance);
  // Interpolates the points of which `done` is 0, or renders them where no cell
  // is good; counts both.
  bool RenderRest(const std::vector<ShadingPoint>& points,
                  const std::vector<char>& done,
                  const RadianceRenderer::Progress& progress, double* L_o,
                  ReflectanceMapReport* report) const;

  const RadianceRenderer& renderer_;
  const ReflectanceMapOptions options_;
  Eigen::Vector3d wo_, t_, b_;
  ShadingPoint any_;  // whose normal a node replaces
  std::unordered_map<int, int> nodes_;
  std::vector<ShadingPoint> waiting_;
  std::vector<double> radiance_;  // [node, 3]
  Eigen::Array3d dark_ = Eigen::Array3d::Ones();
  std::vector<Cell> cells_;
  double tolerance_ = 0.0;
  std::unordered_map<int64_t, size_t> good_;  // KeyOf to cell
  HeldOut held_out_;
  ReflectanceMapReport report_;
};

}  // namespace ibrdf
