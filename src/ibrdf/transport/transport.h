// Differentiable renderer: radiance of shading points, linear in the tabulated
// BRDF and linear in the map, with the transposes of both.
//
//   L_o_ic = sum_pairs weight f_c(pair) L_c(pair)
//
// The pairs of a point are the samples of PointQuadrature: a light direction,
// with eight taps into the BRDF grid and one block of the map (far) or four of
// its texels (near). Shadows, where asked for, are part of the weights: pairs
// are dropped or lowered when the lists are built, so that every product below
// is that of the shadowed scene. A block that is hidden in part is taken texel
// by texel.
//
// Interreflection, where asked for, gives what is hidden to patches: surface
// points with a transport of their own, lit by the map and, from the second
// bounce on, by each other. With R_b their radiance after b bounces, T of the
// points and T' of the patches:
//
//   R_0 = 0,  R_b = T'(f) [L; R_(b-1)],  L_o = T(f) [L; R_bounces].
//
// L_o stays linear in L; in f it is a polynomial whose degree is one more than
// the bounces.
//
// An object of several materials has a grid for each (ShadingPoint::material),
// of the patches as of the points.
//
// Shapes: map [H, W, 3] radiance, W/(m^2 sr); L_o [points, 3] radiance; BRDF
// grid [3, nodes] in 1/sr. Inputs must be finite; maps and grids may be
// negative (tangents). Same bits for any number of threads.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/bright_texels.h"
#include "ibrdf/transport/light_operator.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/transport/reflectance_operator.h"
#include "ibrdf/visibility/radiosity_patches.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

class PairSources;
struct PaddedGrids;
struct TransportPairs;

// The BRDFs of materials, by ShadingPoint::material; one alone is that of all
// points.
using MaterialGrids = std::vector<const BrdfGrid*>;
// Those of grids that the caller keeps.
MaterialGrids ByMaterial(const std::vector<BrdfGrid>& grids);

struct TransportOptions {
  QuadratureOptions quadrature;
  BrdfGridShape grid;
  int num_threads = 0;  // <= 0: all
  // Shadows of the points, or of more points of their image; null: none. It is
  // read at construction alone.
  std::shared_ptr<const Visibility> visibility;
  // Bounces: patches of the same points, with `visibility`; null: none.
  std::shared_ptr<const RadiosityPatches> patches;
  // Light besides the map's: samples of what SplitBrightTexels took out of a
  // known one. All radiance has it; LightOperator carries it as its offset.
  // LightMatrix, which has no offset, refuses it.
  std::vector<BrightSample> bright;
};

// The most sources that far pairs may tell apart: blocks of the map
// (NumFarCells), patches and bright samples together.
inline constexpr int kMaxFarSources = 65536;

// A transport is immutable after construction. One thread at a time may call
// its functions (they are parallel inside).
class Transport {
 public:
  // map_width must be even; the sources must not exceed kMaxFarSources.
  Transport(const std::vector<ShadingPoint>& points, int map_height,
            int map_width, const TransportOptions& options);

  int num_points() const;
  int map_height() const;
  int map_width() const;
  const BrdfGridShape& grid_shape() const { return options_.grid; }
  // 0 without interreflection.
  int bounces() const {
    return options_.patches != nullptr ? options_.patches->bounces() : 0;
  }

  // Radiance of the points after all bounces.
  void Render(const BrdfGrid& grid, const float* map, double* L_o) const;
  void Render(const MaterialGrids& grids, const float* map, double* L_o) const;
  // The same after the first `bounces` of them, 0 to bounces().
  void RenderBounces(const BrdfGrid& grid, const float* map, int bounces,
                     double* L_o) const;
  void RenderBounces(const MaterialGrids& grids, const float* map, int bounces,
                     double* L_o) const;
  // gradient [3, nodes] of sum adjoint . L_o in the grid, at `grid`. Only
  // interreflection reads `grid`: without it L_o is linear.
  void GridGradient(const BrdfGrid& grid, const float* map,
                    const double* adjoint, float* gradient) const;

  // L_o as a function of the map, for a fixed BRDF.
  LightOperator ByLight(const BrdfGrid& grid) const;
  LightOperator ByLight(const MaterialGrids& grids) const;

  // L_o for BRDFs that are sums of lobes. fields[k] = [nodes] is a scalar field
  // s_k on the grid; out [points, num_fields, 3]:
  //   out_ikc = int s_k L_c cos(theta_i) dwi,
  // so that f_c = sum_k colour_kc s_k has L_o_ic = sum_k colour_kc out_ikc. L
  // is the light of the map and, behind hidden directions, `emitted`
  // [patches, 3]; null: 0.
  void RenderLobes(const float* const* fields, int num_fields, const float* map,
                   float* out, const double* emitted = nullptr) const;
  // The same as a function of the fields, for a fixed map and no emitted light.
  ReflectanceOperator ByReflectance(const float* map) const;

  // The transport of the patches; with one bounce alone it sees no patches.
  // Null without interreflection.
  const Transport* patches() const { return patches_.get(); }
  // R_b [patches, 3] for b = 0 to bounces(); the first one, 0, is empty.
  std::vector<std::vector<double>> Emitted(const BrdfGrid& grid,
                                           const float* map) const;

  // One channel of ByLight as a dense matrix, for maps of few texels: for a
  // scalar field [nodes], matrix [points][H * W] with L_o_i = sum_t matrix_it
  // L_t. The map must not be wider than QuadratureOptions::far_width; neither
  // interreflection nor bright light is taken.
  void LightMatrix(const float* field, float* matrix) const {
    LightMatrices({field}, {matrix});
  }
  // Of several fields, with the same bits: four take little more time than one.
  void LightMatrices(const std::vector<const float*>& fields,
                     const std::vector<float*>& matrices) const;
  // Its transpose in the field: gradient [nodes] of sum adjoint . matrix.
  void LightMatrixGradient(const float* adjoint, float* gradient) const;

  // Bytes held by the lists of pairs.
  size_t MemoryBytes() const;

 private:
  Transport(const TransportOptions& options,
            std::shared_ptr<const TransportPairs> pairs);

  void FewLightMatrices(const float* const* fields, float* const* matrices,
                        size_t count) const;
  // Three channels on the padded grid: four floats a node, the last one 0.
  std::vector<float> PadGrid(const BrdfGrid& grid) const;
  PaddedGrids PadGrids(const MaterialGrids& grids) const;
  // R_0 to R_bounces on the padded grids f. Afterwards `sources` are lit by the
  // last but one.
  std::vector<std::vector<double>> Emitted(const PaddedGrids& f, int bounces,
                                           PairSources* sources) const;
  // L_o under given sources, and its transposes: in the grid, added to `sums`
  // [3, nodes], and in the patches' radiance [patches, 3].
  void RenderLit(const PaddedGrids& f, const PairSources& sources,
                 double* L_o) const;
  void AddGridGradient(const PairSources& sources, const double* adjoint,
                       std::vector<double>* sums) const;
  std::vector<double> ByEmitted(const std::vector<float>& f,
                                const double* adjoint) const;

  TransportOptions options_;
  std::shared_ptr<const TransportPairs> pairs_;
  std::shared_ptr<const Transport> patches_;
};

}  // namespace ibrdf
