// What an object's points see of the object itself: where light from the map
// is hidden (Visibility), light from other points arrives instead. Those are
// gathered into few emitters, by place and by the direction that they are
// looked at from, so that one bounce costs about as much as the image itself.
//
// Geometry alone, like visibility: one set serves every map and reflectance.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

struct SurfaceEmitterOptions {
  int bounces = 1;
  // Emitters are one per cube of this side, in half diagonals of the box around
  // what is seen, orientation (24) and direction of view (6 views^2). The side
  // grows until max_emitters are enough.
  double patch = 0.1;
  int views = 2;
  int max_emitters = 4000;
  // Of the points, those whose sight decides where emitters are.
  int max_points = 2048;
  // Directions are told apart in cells of a lattice_rows x 2 lattice_rows grid;
  // even, divides the rows of the visibility's. Emitters' cells are twice as
  // wide.
  int lattice_rows = 32;
  int num_threads = 0;  // <= 0: all
};

// As many emitters as there are points to light, but for few or many points.
SurfaceEmitterOptions EmittersFor(size_t num_points, int bounces);

// Which emitter a point sees in a cell of the lattice.
struct SeenEmitter {
  uint16_t cell;
  uint16_t emitter;  // or kNoEmitter
};
inline constexpr uint16_t kNoEmitter = 0xffff;
struct SeenEmitters {
  const SeenEmitter* begin = nullptr;  // by cell, ascending
  const SeenEmitter* end = nullptr;
  int lattice_rows = 1;  // and twice as many columns
  bool empty() const { return begin == end; }
};
struct EmitterShare {
  int emitter;
  double share;
};

// Immutable; safe to share between threads.
class SurfaceEmitters {
 public:
  // `visibility` of `points`, both as for a Transport.
  SurfaceEmitters(const Scene& scene, const std::vector<ShadingPoint>& points,
                  std::shared_ptr<const Visibility> visibility,
                  const SurfaceEmitterOptions& options);

  int bounces() const { return options_.bounces; }
  int count() const { return static_cast<int>(points_.size()); }
  // The emitters: surface points, wo towards those that see them (at least 8.6
  // degrees above the surface), index their place in the list.
  const std::vector<ShadingPoint>& points() const { return points_; }
  // What is hidden from the emitters.
  const std::shared_ptr<const Visibility>& visibility() const {
    return visibility_;
  }

  // Of a point of the constructor's, by ShadingPoint::index, and of an emitter
  // (with one bounce none: they are lit by the map alone).
  SeenEmitters SeenFrom(const ShadingPoint& point) const;
  SeenEmitters SeenFromEmitter(const ShadingPoint& emitter) const;
  // Of any point, by new rays; `hidden` as Visibility::Hidden.
  SeenEmitters Look(const ShadingPoint& point, const VisibilityGrid& grid,
                    const uint64_t* hidden,
                    std::vector<SeenEmitter>* seen) const;

  // The point that a ray from `point` meets, wo back along it; false: none.
  bool Meet(const ShadingPoint& point, const Eigen::Vector3d& direction,
            ShadingPoint* met) const;

  // The emitters behind a range of grid texels, and which share of the
  // cosine-weighted light of the range, all of one radiance, each stands for.
  void SharesIn(const VisibilityGrid& grid, const uint64_t* hidden,
                const Eigen::Vector3d& n, const GridRange& range,
                const SeenEmitters& seen,
                std::vector<EmitterShare>* shares) const;
  // The emitter along wi, where that is hidden; -1: none.
  int Along(const SeenEmitters& seen, const Eigen::Vector3d& wi) const;

  // Hidden cells of the constructor's points and of emitters, and those among
  // them whose ray met nothing that an emitter stands for: their light is lost.
  int64_t num_cells() const;
  int64_t num_lost() const;
  size_t MemoryBytes() const;

 private:
  struct Hit {
    Eigen::Vector3d position;
    Eigen::Vector3d normal, wo;
  };
  struct HiddenCell {
    uint16_t cell;
    Eigen::Vector3d direction;
  };
  // Lists of SeenEmitter by point.
  struct Table {
    int lattice_rows = 1;
    std::vector<int64_t> begin = {0};  // by index, one more than points
    std::vector<SeenEmitter> seen;
    SeenEmitters Of(int index) const;
  };
  // A hit without an emitter, and the entry of a table that wants one.
  struct Unknown {
    int64_t entry;
    Hit hit;
  };

  // The cells of the lattice that hold hidden texels, each with the direction
  // of the one nearest to the middle of them.
  static void HiddenCells(const VisibilityGrid& grid, const ShadingPoint& point,
                          const uint64_t* hidden, int lattice_rows,
                          std::vector<HiddenCell>* cells);
  bool Meet(const ShadingPoint& point, const Eigen::Vector3d& direction,
            Hit* hit) const;
  uint64_t PatchOf(const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal) const;
  // Emitters for the hits; false where there would be too many.
  bool Gather(const std::vector<Hit>& hits);
  void AddEmitter(uint64_t patch, const Hit& hit);
  // The emitter of the hit's patch, or of one beside it, seen from most nearly
  // the same direction; -1: none.
  int Find(const Hit& hit) const;
  void Look(const ShadingPoint& point, const VisibilityGrid& grid,
            const uint64_t* hidden, int lattice_rows,
            std::vector<SeenEmitter>* seen,
            std::vector<Unknown>* unknown) const;
  // Adds what the points, of indices beyond the table's, see.
  std::vector<Unknown> LookFrom(const std::vector<ShadingPoint>& points,
                                const Visibility& visibility,
                                Table* table) const;
  // One for each patch that has none.
  void AddEmitters(const std::vector<Unknown>& unknown, Table* table);
  // -1: none.
  static int InCell(const SeenEmitters& seen, int cell);

  SurfaceEmitterOptions options_;
  Scene scene_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  double side_ = 1.0;
  std::vector<ShadingPoint> points_;
  std::unordered_map<uint64_t, std::vector<int>> patches_;
  std::shared_ptr<const Visibility> visibility_;
  Table by_point_, by_emitter_;
};

}  // namespace ibrdf
