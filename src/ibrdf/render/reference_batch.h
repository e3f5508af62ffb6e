// The reference renderer for many materials under many maps at once: what
// depends on geometry alone is found once for all of them, and mirrored points
// of a view angle share more.
//
// The far rule's blocks of texels are the same for all maps: a texel's light is
// shared between the four blocks around it so that their centroid is its own.
// Bright texels stay apart. Tables need not be symmetric in phi_d.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/render/merl_table_stack.h"
#include "ibrdf/render/reference_parts.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

// Immutable; its functions may be called from one thread at a time.
class ReferenceBatch {
 public:
  // tables: must outlive *this. Maps: at least one, all of one size.
  ReferenceBatch(const MerlTableStack& tables,
                 const std::vector<const Image*>& maps,
                 const ReferenceOptions& options);

  // Radiance L_o [tables][maps][points][3]. Agrees with every texel of the map,
  // mean |log ratio| below 0.001, and with ReferenceRenderer where no texel is
  // bright; under a sun of one texel its rings leave 0.002 to 0.005. Sums of up
  // to kRayBlock products are float, the others double; the same bits for any
  // number of threads.
  void Render(const std::vector<ShadingPoint>& points, double* L_o) const;

 private:
  struct Scratch;
  struct Mirrored;
  // Cells of the far rule and their radiance times solid angle, as texels of
  // PaddedMaps.
  struct Light {
    int height, width;  // of the blocks
    std::vector<FarCell> blocks, texels;
    std::vector<float> block_power, texel_power;  // [cells][stride]
    std::vector<int> texel_of;  // of `texels`: row * width + column of the map
  };
  class LightGatherer;
  ReferenceBatch(const MerlTableStack& tables,
                 const std::vector<const Image*>& maps, Light&& light,
                 const ReferenceOptions& options);
  // Products of the values in scratch->f and the light in n <= kRayBlock rows,
  // to the sums of a point of the group.
  void AddProducts(const float* const* rows, int n, int index,
                   Scratch* scratch) const;
  void AddNear(const std::vector<ShadingPoint>& points, const int* group,
               int count, Scratch* scratch) const;
  void AddFar(const std::vector<ShadingPoint>& points, const int* group,
              int count, Scratch* scratch) const;
  // own: points of the group and their indices in it.
  void AddBlocks(const std::vector<ShadingPoint>& points, const int* group,
                 const std::vector<std::pair<Mirrored, int>>& own,
                 bool other_hand, Scratch* scratch) const;
  void AddTexels(const PointFrame& frame, double correction, int index,
                 Scratch* scratch) const;
  // Rows of light times what is visible of each, in scratch->g.
  void Shade(const double* visible, int n, const float** rows,
             Scratch* scratch) const;

  const ReferenceKernels& kernels_ = ActiveReferenceKernels();
  const MerlTableStack& tables_;
  int num_maps_, num_threads_;
  size_t sums_size_;  // doubles of a point
  PaddedMaps maps_;
  int far_height_, far_width_;
  FarDirections texels_;
  std::vector<float> block_power_, texel_power_;
  std::shared_ptr<const VisibilityGrid> shadows_;
  std::vector<GridRange> block_ranges_, texel_ranges_;  // under shadows
  PointQuadrature quadrature_;
};

}  // namespace ibrdf
