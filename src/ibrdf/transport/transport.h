// Differentiable renderer: radiance of shading points as a form linear in the
// tabulated BRDF and linear in the map, with both transposes.
//
// L_o_ic = sum_pairs weight f_c(pair) L_c(pair): the pairs of a point are the
// samples of PointQuadrature, each with eight taps into the BRDF grid and one
// block of the map (far) or four of its texels (near). Shadows, where asked
// for, are part of the weights: pairs are dropped or lowered when the lists are
// built, so that every product below is that of the shadowed scene. A block
// that is hidden in part is taken texel by texel.
//
// Interreflection, where asked for, gives what is hidden to patches: surface
// points with a transport of their own, lit by the map and, from the second
// bounce on, by each other. With R their radiance, L_o = T(f) [L; R] and
// R_b = T'(f) [L; R_(b-1)], R_0 = 0: L_o stays linear in L, and is a polynomial
// in f of one degree more than there are bounces.
//
// Shapes: map [H, W, 3] radiance; L_o [points, 3] radiance; BRDF grid
// [3, nodes] in 1/sr. Inputs must be finite; maps and grids may be negative
// (tangents). Same bits for any number of threads.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/bright_texels.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/visibility/radiosity_patches.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

struct TransportOptions {
  QuadratureOptions quadrature;
  BrdfGridShape grid;
  int num_threads = 0;  // <= 0: all
  // Of the points or more of their image; null: unshadowed. Read at
  // construction alone.
  std::shared_ptr<const Visibility> visibility;
  // With `visibility`, and of the same points; null: no bounces.
  std::shared_ptr<const RadiosityPatches> patches;
  // Light besides the map's: what SplitBrightTexels took out of a known one. In
  // all radiance for a grid or for fields and its gradients in those, not in
  // what is linear in the map: ByLight, LightMatrix.
  std::vector<BrightSample> bright;
};

// Far cells of the map (NumFarCells), patches and bright samples that a
// transport takes, together.
inline constexpr int kMaxFarSources = 65536;

class LightOperator;
class ReflectanceOperator;

// Immutable after construction; its functions may be called from one thread at
// a time (they are parallel inside).
class Transport {
 public:
  // map_width even; at most kMaxFarSources.
  Transport(const std::vector<ShadingPoint>& points, int map_height,
            int map_width, const TransportOptions& options);

  int num_points() const { return num_points_; }
  int map_height() const { return map_height_; }
  int map_width() const { return map_width_; }
  const BrdfGridShape& grid_shape() const { return options_.grid; }
  // 0 without interreflection.
  int bounces() const {
    return options_.patches != nullptr ? options_.patches->bounces() : 0;
  }
  // Of the patches, without patches that they see where there is but one
  // bounce; null without interreflection.
  const Transport* patches() const { return patches_.get(); }
  // Bytes held by the lists of pairs.
  size_t MemoryBytes() const;

  void Render(const BrdfGrid& grid, const float* map, double* L_o) const;
  // With only the first of the bounces, 0 to bounces().
  void RenderBounces(const BrdfGrid& grid, const float* map, int bounces,
                     double* L_o) const;

  // Radiance of the patches, [patches, 3], which lights points after
  // b = 0 to bounces() bounces: [b], the first one empty.
  std::vector<std::vector<double>> Emitted(const BrdfGrid& grid,
                                           const float* map) const;

  // The linear map from L to L_o for a fixed BRDF.
  LightOperator ByLight(const BrdfGrid& grid) const;

  // For scalar fields s_k on the grid, fields[k] = [nodes]: out
  // [points, num_fields, 3], out_ikc = int s_k L_c cos. A BRDF
  // f_c = sum_k colour_kc s_k has L_o_ic = sum_k colour_kc out_ikc. L is that
  // of the map and, behind hidden directions, of `emitted` [patches, 3], null:
  // 0.
  void RenderLobes(const float* const* fields, int num_fields, const float* map,
                   float* out, const double* emitted = nullptr) const;

  // The linear map from fields to out of RenderLobes, for a fixed map and no
  // emitted light.
  ReflectanceOperator ByReflectance(const float* map) const;

  // gradient [3, nodes] of sum adjoint.L_o in the grid. `grid`: where, read
  // with interreflection alone; without, L_o is linear.
  void GridGradient(const BrdfGrid& grid, const float* map,
                    const double* adjoint, float* gradient) const;

  // The linear map from a small map's texels to radiance for a scalar field
  // [nodes]: matrix [points][H * W], E_i = sum_t matrix_it L_t. The map must
  // not be wider than QuadratureOptions::far_width. Without interreflection.
  void LightMatrix(const float* field, float* matrix) const;
  // Its transpose in the field: gradient [nodes] of sum adjoint.matrix.
  void LightMatrixGradient(const float* adjoint, float* gradient) const;

 private:
  enum class Of { kPoints, kPatches };
  Transport(const std::vector<ShadingPoint>& points, int map_height,
            int map_width, const TransportOptions& options, Of of);

  // Trilinear fractions are in units of 1/65535.
  struct FarPair {
    uint32_t node;  // lowest node of the cell, in the padded grid
    uint16_t fh, fd, fp;
    uint16_t block;  // or num_blocks_ + a patch or, after those, a sample of
                     // bright light
    float weight;
  };
  struct NearPair {
    uint32_t node;
    uint16_t fh, fd, fp;
    uint16_t fx;
    uint32_t texel;  // upper left of four, in the padded map
    float weight;
    uint16_t fy;
  };
  // Consecutive points; the split depends on their number alone.
  struct Chunk {
    int begin = 0, end = 0;
    std::vector<FarPair> far;
    std::vector<NearPair> near;
    std::vector<size_t> far_end, near_end;  // [end - begin]
  };

  void BuildChunk(const std::vector<ShadingPoint>& points,
                  const std::vector<FarCell>& cells,
                  const PointQuadrature& quadrature, Of of, Chunk* chunk) const;
  // Pairs of a point with the bright light that it sees.
  void AddBright(const ShadingPoint& point, const uint64_t* hidden,
                 Chunk* chunk) const;
  // A far sample whose block is hidden in part, as pairs with its texels.
  void SplitBlock(const uint64_t* hidden, const Eigen::Vector3d& n, int block,
                  const NearPair& sample, std::vector<NearPair>* pairs) const;
  // Of one worker: the light that a point gathers at every node of the padded
  // grid, four floats each, all zero between points, and which nodes it
  // touched, in order of first touch.
  struct GatheredLight {
    std::vector<float> by_node;
    std::vector<uint8_t> touched;
    std::vector<uint32_t> nodes;
  };
  // Calls use(point, nodes, light) for every point of a chunk in order: nodes
  // [count] of the padded grid and the light [count, 4] that they reflect per
  // unit of BRDF. `texels`, `blocks`: PadMap, SumBlocks.
  template <typename Use>
  void GatherLight(const Chunk& chunk, const std::vector<float>& texels,
                   const std::vector<float>& blocks, GatheredLight* scratch,
                   const Use& use) const;
  // L_o for given emitted light, radiance [patches, 3], null: 0; the transposes
  // of that in the grid, added to `sums` [3, nodes], and in the emitted light.
  void RenderLit(const std::vector<float>& f, const float* map,
                 const double* emitted, double* L_o) const;
  void AddGridGradient(const float* map, const double* emitted,
                       const double* adjoint, std::vector<double>* sums) const;
  std::vector<double> ByEmitted(const std::vector<float>& f,
                                const double* adjoint) const;
  // R_0 to R_bounces; empty: R_0 = 0.
  std::vector<std::vector<double>> Emitted(const std::vector<float>& f,
                                           const float* map, int bounces) const;
  // SumBlocks, then the patches, then bright samples; four floats each, the
  // last one 0.
  std::vector<float> FarSources(const float* map, const double* emitted) const;
  // See PaddedTexels; four floats per entry, the last one 0.
  std::vector<float> PadMap(const float* map) const;
  std::vector<float> PadGrid(const BrdfGrid& grid) const;
  int num_patches() const {
    return options_.patches != nullptr ? options_.patches->count() : 0;
  }
  int PaddedNodes() const {
    return options_.grid.h * options_.grid.d * (options_.grid.p + 1);
  }

  TransportOptions options_;
  int num_points_ = 0;
  int map_height_ = 0;
  int map_width_ = 0;
  int block_ = 1;  // side in texels
  int num_blocks_ = 0;
  std::vector<Chunk> chunks_;
  std::shared_ptr<const Transport> patches_;
};

// Some 40 kB per point: for few points. Holds what it needs: it may outlive its
// transport. Thread rules as above.
class ReflectanceOperator {
 public:
  int num_points() const { return num_points_; }
  // out [points, num_fields, 3] from fields[k] = [nodes], as
  // Transport::RenderLobes, with the same bits.
  void Apply(const float* const* fields, int num_fields, float* out) const;

  size_t MemoryBytes() const;

 private:
  friend class Transport;
  ReflectanceOperator() = default;

  // Consecutive points: the nodes that each sees and their light.
  struct Chunk {
    int begin = 0, end = 0;
    std::vector<size_t> entry_end;  // [end - begin]
    std::vector<uint32_t> node;     // of the padded grid
    std::vector<float> light;       // [entry, 4]
  };

  BrdfGridShape grid_;
  int num_points_ = 0;
  int num_threads_ = 0;
  std::vector<Chunk> chunks_;
};

// Holds what it needs: it may outlive its transport. Thread rules as above.
class LightOperator {
 public:
  // L_o [points, 3] from map [H, W, 3].
  void Apply(const float* map, double* L_o) const;
  // gradient [H, W, 3] of sum adjoint.L_o, adjoint [points, 3].
  void ApplyTranspose(const double* adjoint, float* gradient) const;
  // Of the patches; null without interreflection.
  const LightOperator* patches() const { return patches_.get(); }
  // out [points, 3, columns] += the radiance that emitted light, [patches, 3,
  // columns], adds: for tangents of the patches' radiance.
  void AddEmitted(const double* emitted, int columns, double* out) const;

  size_t MemoryBytes() const;

 private:
  friend class Transport;
  LightOperator() = default;

  // Radiance of consecutive points: one entry for every block of texels and
  // every texel that a point sees by itself, its pairs summed.
  struct Chunk {
    int begin = 0, end = 0;
    std::vector<size_t> entry_end;  // [end - begin]
    // A block, num_blocks_ + texel, or after those a patch.
    std::vector<uint32_t> source;
    std::vector<float> value;  // [entry * 3 + channel], one spare entry
  };

  int num_points() const { return chunks_.empty() ? 0 : chunks_.back().end; }
  size_t num_map_sources() const {
    return num_blocks_ + static_cast<size_t>(map_height_) * map_width_;
  }
  // Blocks, then texels, then patches (0); four floats each, the last one 0.
  std::vector<float> Sources(const float* map) const;
  void ApplyTo(const std::vector<float>& sources, double* L_o) const;
  // sums [num_sources_, 4] += the transpose.
  void AddTranspose(const double* adjoint, std::vector<double>* sums) const;

  int map_height_ = 0, map_width_ = 0, block_ = 1, num_blocks_ = 0;
  int num_threads_ = 0;
  std::vector<Chunk> chunks_;
  size_t num_sources_ = 0;
  int bounces_ = 0;
  std::shared_ptr<const LightOperator> patches_;  // null: none
};

}  // namespace ibrdf
