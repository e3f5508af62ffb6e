// The samples that a transport sums over, listed once for every map and every
// reflectance, and what lights them. Internal.
//
// A pair is one light direction at one point: eight taps into the padded BRDF
// grid, and one source of light. Far pairs take a source as a whole: a block of
// the map's texels, a patch of the object, or a sample of bright light. Near
// pairs look a direction up between four texels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/bright_texels.h"
#include "ibrdf/transport/transport.h"
#include "ibrdf/transport/transport_taps.h"

namespace ibrdf {

// Trilinear fractions fh, fd, fp and bilinear ones fx, fy are in units of
// 1/65535. The padded grid has nodes [h][d][p + 1]: phi_d = pi repeats phi_d =
// 0, so that taps need no wrapping.
struct FarPair {
  uint32_t node;  // lowest node of the cell, in the padded grid
  uint16_t fh, fd, fp;
  uint16_t source;  // a block; from num_blocks on a patch; then a bright sample
  float weight;     // L_o += weight f_r (radiance times solid angle); of a
                    // patch: weight f_r radiance
};
struct NearPair {
  uint32_t node;
  uint16_t fh, fd, fp;
  uint16_t fx;
  uint32_t texel;  // upper left of four, in the padded map (PaddedTexels)
  float weight;    // L_o += weight f_r L
  uint16_t fy;
};

// The pairs of consecutive points, in the points' order.
struct PairChunk {
  int begin = 0, end = 0;  // points
  std::vector<FarPair> far;
  std::vector<NearPair> near;
  std::vector<size_t> far_end, near_end;  // [end - begin]
};

template <typename Pair>
struct PairRange {
  const Pair* first;
  const Pair* last;
  const Pair* begin() const { return first; }
  const Pair* end() const { return last; }
};

// Calls use(point, far, near) for every point of a chunk in order, with the
// PairRanges of its pairs.
template <typename Use>
void ForPoints(const PairChunk& chunk, const Use& use) {
  size_t far = 0, near = 0;
  for (int i = 0; i < chunk.end - chunk.begin; ++i) {
    use(chunk.begin + i,
        PairRange<FarPair>{chunk.far.data() + far,
                           chunk.far.data() + chunk.far_end[i]},
        PairRange<NearPair>{chunk.near.data() + near,
                            chunk.near.data() + chunk.near_end[i]});
    far = chunk.far_end[i];
    near = chunk.near_end[i];
  }
}

// Whose pairs: RadiosityPatches keeps what the image's points see of the object
// apart from what the patches see of it.
enum class PairsOf { kPoints, kPatches };

// Immutable after construction.
struct TransportPairs {
  TransportPairs(const std::vector<ShadingPoint>& points, int map_height,
                 int map_width, const TransportOptions& options, PairsOf of);

  size_t num_texels() const {
    return static_cast<size_t>(map_height) * map_width;
  }
  int num_padded_nodes() const { return grid.h * grid.d * (grid.p + 1); }
  int padded_row() const { return map_width + 1; }  // texels
  // The first source that is a bright sample.
  int first_bright() const { return num_blocks + num_patches; }
  size_t MemoryBytes() const;

  BrdfGridShape grid;
  int num_threads = 0;
  int num_points = 0;
  int map_height = 0, map_width = 0;
  int block = 1;  // side of the map's blocks, in texels
  int num_blocks = 0;
  int num_patches = 0;
  std::vector<BrightSample> bright;
  // PaddedTexels of the map. They depend on its size alone: found once.
  std::vector<int> padded_texels;
  std::vector<PairChunk> chunks;
  std::vector<int> material;  // [points]
};

// BRDFs by material on the padded grid, four floats a node, the last one 0. One
// alone is that of all points.
struct PaddedGrids {
  std::vector<std::vector<float>> by_material;

  const float* Of(const TransportPairs& pairs, int point) const {
    return by_material.size() == 1 ? by_material[0].data()
                                   : by_material[pairs.material[point]].data();
  }
};

// The radiance that lights pairs: of one map, of bright samples and, once
// SetEmitted has been called, of patches. A map is padded and its blocks are
// summed anew for every call of a transport: a solver brings another one each
// time. Points and patches read the same sources, through all bounces.
class PairSources {
 public:
  // map [H, W, 3]; `pairs` must outlive the sources.
  PairSources(const TransportPairs& pairs, const float* map);

  // Radiance of the patches [patches, 3]; null: they are dark, as at first.
  void SetEmitted(const double* emitted);

  taps::Float4 Light(const FarPair& pair) const {
    return taps::Load4(&far_[size_t{4} * pair.source]);
  }
  taps::Float4 Light(const NearPair& pair) const {
    return taps::LookUp(pair, row_, texels_.data());
  }

 private:
  const TransportPairs& pairs_;
  const int row_;
  std::vector<float> texels_;  // [padded texel][4], the last one 0
  std::vector<float> far_;     // [source][4], likewise
};

// Fields on the grid's nodes, fields[k] = [nodes], side by side at every node
// of the padded grid: [padded nodes][stride], 0 from num_fields on.
std::vector<float> PadFields(const BrdfGridShape& shape,
                             const float* const* fields, int num_fields,
                             int stride, int num_threads);

}  // namespace ibrdf
