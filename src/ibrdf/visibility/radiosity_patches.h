// What an object's points see of the object itself: where light from the map
// is hidden (Visibility), light from other points arrives instead.
//
// Those points are gathered into few patches, by place, by orientation and by
// the direction that they are looked at from, so that one bounce costs about as
// much as the image itself. A patch is a surface point that stands for the rest
// of its group; transport/transport.h gives it a transport of its own and
// bounces light between patches.
//
// Geometry alone, like visibility: one set serves every map and reflectance.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

struct RadiosityOptions {
  int bounces = 1;  // >= 1
  // There is a patch for each cube of this side, in half diagonals of the box
  // around what is seen, orientation (24) and direction of view (6 views^2).
  // The side grows until max_patches are enough.
  double patch_size = 0.1;
  int views = 2;
  int max_patches = 4000;  // [200, 65534]
  // So many of the points decide by what they see where patches are.
  int max_points = 2048;
  // Directions are told apart in cells of a lattice, lattice_rows x 2
  // lattice_rows; it is even and divides the rows of the visibility's grid.
  // The lattice of patches has cells twice as wide.
  int lattice_rows = 32;
  int num_threads = 0;  // <= 0: all
};

// As many patches as there are points to light, but for few or many points.
RadiosityOptions PatchesFor(size_t num_points, int bounces);

// Which patch a point sees in a cell of the lattice, one in which light is
// hidden. kNoPatch: the cell's ray met nothing that a patch stands for, and its
// light is lost.
struct SeenPatch {
  uint16_t cell;
  uint16_t patch;  // or kNoPatch
};
inline constexpr uint16_t kNoPatch = 0xffff;
// All that a point sees.
struct SeenPatches {
  const SeenPatch* begin = nullptr;  // by cell, ascending
  const SeenPatch* end = nullptr;
  int lattice_rows = 1;  // and twice as many columns
  bool empty() const { return begin == end; }
};
// A patch behind a range of directions, and its share of their light.
struct PatchShare {
  int patch;
  double share;  // [0, 1]
};

// Immutable; safe to share between threads.
class RadiosityPatches {
 public:
  // `visibility` of `points`, both as for a Transport.
  RadiosityPatches(const Scene& scene, const std::vector<ShadingPoint>& points,
                   std::shared_ptr<const Visibility> visibility,
                   const RadiosityOptions& options);

  int bounces() const { return options_.bounces; }
  int count() const { return static_cast<int>(points_.size()); }
  // The patches: surface points whose wo is towards those that see them (at
  // least 8.6 degrees above the surface) and whose index is their place in the
  // list.
  const std::vector<ShadingPoint>& points() const { return points_; }
  // What is hidden from the patches.
  const std::shared_ptr<const Visibility>& visibility() const {
    return visibility_;
  }

  // What a point of the constructor's sees, by ShadingPoint::index; what a
  // patch sees (with one bounce nothing: patches are lit by the map alone).
  SeenPatches SeenFrom(const ShadingPoint& point) const;
  SeenPatches SeenFromPatch(const ShadingPoint& patch) const;
  // What any point sees, by new rays; `hidden` as Visibility::Hidden. The
  // result points into `seen`.
  SeenPatches Look(const ShadingPoint& point, const VisibilityGrid& grid,
                   const uint64_t* hidden, std::vector<SeenPatch>* seen) const;

  // The point that a ray from `point` meets, wo back along it; false: none.
  bool Meet(const ShadingPoint& point, const Eigen::Vector3d& direction,
            ShadingPoint* met) const;

  // The patches behind a range of grid texels, and which share of the
  // cosine-weighted light of the range, all of one radiance, each stands for.
  // n: the point's unit normal.
  void SharesIn(const VisibilityGrid& grid, const uint64_t* hidden,
                const Eigen::Vector3d& n, const GridRange& range,
                const SeenPatches& seen, std::vector<PatchShare>* shares) const;
  // The patch along wi, where that is hidden; -1: none.
  int Along(const SeenPatches& seen, const Eigen::Vector3d& wi) const;

  size_t MemoryBytes() const;

 private:
  // Where a ray met the object.
  struct Hit {
    Eigen::Vector3d position;
    Eigen::Vector3d normal, wo;  // unit; wo back along the ray
    Eigen::Vector2f texture = Eigen::Vector2f::Zero();
  };
  // A cell of the lattice that holds hidden directions, and one of them.
  struct HiddenCell {
    uint16_t cell;
    Eigen::Vector3d direction;
  };
  // Lists of SeenPatch by point.
  struct Table {
    int lattice_rows = 1;
    std::vector<int64_t> begin = {0};  // by index, one more than points
    std::vector<SeenPatch> seen;
    SeenPatches Of(int index) const;
  };
  // A hit without a patch, and the entry of a table that wants one.
  struct Unknown {
    int64_t entry;
    Hit hit;
  };

  // The steps of the constructor. CastRays: what the points see of the object.
  // PlacePatches: patches for those hits. LinkPatches: what patches see of each
  // other, and patches for what nothing else sees; it adds the new ones to
  // their visibility.
  std::vector<Hit> CastRays(const std::vector<ShadingPoint>& points,
                            const Visibility& visibility) const;
  void PlacePatches(const std::vector<Hit>& hits);
  void LinkPatches(Visibility* visibility);
  // Each patch is of the material of the point nearest to it.
  void TakeMaterials(const std::vector<ShadingPoint>& points);

  // The cells of the lattice that hold hidden texels, each with the direction
  // of the one nearest to the middle of them.
  static void HiddenCells(const VisibilityGrid& grid, const ShadingPoint& point,
                          const uint64_t* hidden, int lattice_rows,
                          std::vector<HiddenCell>* cells);
  bool Meet(const ShadingPoint& point, const Eigen::Vector3d& direction,
            Hit* hit) const;

  // The key of the cube and orientation of a hit: its site.
  uint64_t SiteOf(const Eigen::Vector3d& position,
                  const Eigen::Vector3d& normal) const;
  // Patches for the hits at the present side_; false where there would be too
  // many.
  bool Gather(const std::vector<Hit>& hits);
  void AddPatch(uint64_t site, const Hit& hit);
  // The patch of the hit's site, or of one beside it, seen from most nearly
  // the same direction; -1: none.
  int Find(const Hit& hit) const;

  void Look(const ShadingPoint& point, const VisibilityGrid& grid,
            const uint64_t* hidden, int lattice_rows,
            std::vector<SeenPatch>* seen, std::vector<Unknown>* unknown) const;
  // Adds what the points, of indices beyond the table's, see.
  std::vector<Unknown> LookFrom(const std::vector<ShadingPoint>& points,
                                const Visibility& visibility,
                                Table* table) const;
  // A patch for each site of `unknown` that has none, entered in the table.
  void AddPatches(const std::vector<Unknown>& unknown, Table* table);
  // -1: none.
  static int InCell(const SeenPatches& seen, int cell);

  RadiosityOptions options_;
  Scene scene_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();  // corner of the box
  double side_ = 1.0;                              // of the cubes
  std::vector<ShadingPoint> points_;
  std::unordered_map<uint64_t, std::vector<int>> sites_;  // patches by site
  std::shared_ptr<const Visibility> visibility_;
  Table by_point_, by_patch_;
};

}  // namespace ibrdf
