// Slow, converged renderer: the image that accuracy is measured against.
// Full-resolution map, MERL table trilinear between bin centres
// (InterpolateMerl), no BRDF grid. Shadows where asked for, and the light of
// patches whose radiance is given (Transport::Emitted). Points
// seen at the same angle (most of a sphere's under an orthographic camera)
// share the BRDF values of their near samples.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/reference_parts.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/bright_texels.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

// What the object throws on itself.
struct EmittedLight {
  const double* radiance = nullptr;  // [patches, 3]; null: none
  // Of light, from it to the point that is rendered.
  int bounces = 0;
};

// Immutable; its functions may be called from one thread at a time.
class ReferenceRenderer {
 public:
  ReferenceRenderer(const Image& map, const ReferenceOptions& options);

  // Radiance [points, 3]. Weights and sums are double; BRDF values float.
  void Render(const std::vector<ShadingPoint>& points, const MerlTable& table,
              double* L_o, const EmittedLight& emitted = {}) const;
  // `brdf` may be called from several threads at a time.
  void Render(const std::vector<ShadingPoint>& points, const BrdfFunction& brdf,
              double* L_o, const EmittedLight& emitted = {}) const;

 private:
  template <typename Lookup>
  void RenderWith(const std::vector<ShadingPoint>& points, const Lookup& lookup,
                  const EmittedLight& emitted, double* L_o) const;
  // What is the same for all points of a call.
  struct Common;
  // After so many bounces along rays of the lobe.
  template <typename Lookup>
  void RenderAt(int depth, const Common& common,
                const std::vector<ShadingPoint>& points, const Lookup& lookup,
                const EmittedLight& emitted, double* L_o) const;

  // Cells of the far rule, their radiance times solid angle, and, under
  // shadows, their texels in the grid.
  struct Light {
    std::vector<FarCell> cells;
    std::vector<Eigen::Array3d> power;
    std::vector<double> solid_angle;
    std::vector<GridRange> ranges;
  };
  static Light GatherLight(const Image& map, const ReferenceOptions& options);

  // Directions and BRDF values of near samples.
  struct Rays;
  // What a point sees.
  struct Sight {
    const uint64_t* hidden = nullptr;  // its bits; null: nothing is
    SeenPatches seen;
    const double* emitted = nullptr;
    // Radiance along the rays of the lobe [rays, 3], negative where they meet
    // nothing; null: there are none.
    const double* lobe = nullptr;
  };
  // Sum of f_k L(wi_k) V(wi_k), wi = x t + y b + z n of unit length; axes t, b,
  // n.
  Eigen::Array3d Gather(const Rays& rays, const Eigen::Matrix3f& axes,
                        const Sight& sight) const;
  // Radiance along `count` rays of the lobe of each point [points, count, 3],
  // negative where they meet nothing.
  template <typename Lookup>
  std::vector<double> LightOfLobes(int depth, int count, const Common& common,
                                   const ViewGroups& groups,
                                   const std::vector<ShadingPoint>& points,
                                   const Lookup& lookup,
                                   const EmittedLight& emitted) const;
  // Near samples of one view angle, in the frame of ViewFrame.
  template <typename Lookup>
  void ShadeNear(const PointFrame& frame, const Lookup& lookup,
                 std::vector<NearSample>* samples, Rays* rays) const;
  // Gathers the rays within lobe_width of the normal into `count` bundles of
  // like directions and weight; sets rays->bundle and returns their means.
  static std::vector<Eigen::Vector3f> Bundle(
      const std::vector<NearSample>& samples, double lobe_width, int count,
      Rays* rays);

  // Enough for a lobe of that half width of half-vectors.
  int BrightSamplesPerSide(double lobe_half_width) const;
  // Light of bright texels at a point; what is hidden is left out.
  template <typename Lookup>
  Eigen::Array3d GatherBright(const PointFrame& frame,
                              const std::vector<BrightSample>& bright,
                              const Lookup& lookup,
                              const uint64_t* hidden) const;

  ReferenceRenderer(const BrightTexels& map, const ReferenceOptions& options);
  ReferenceRenderer(const BrightTexels& map, Light light,
                    const ReferenceOptions& options);

  int num_threads_, lobe_rays_;
  // Renders what lobes' rays meet.
  std::unique_ptr<const ReferenceRenderer> coarser_;
  const ReferenceKernels& kernels_ = ActiveReferenceKernels();
  std::vector<BrightTexel> bright_;
  // Without those; so are the far rule's.
  PaddedMaps map_;
  std::vector<Eigen::Array3d> power_;
  std::vector<double> solid_angle_;
  std::shared_ptr<const VisibilityGrid> shadows_;
  std::shared_ptr<const RadiosityPatches> patches_;
  std::vector<GridRange> ranges_;
  PointQuadrature quadrature_;
};

// Mean over the points of each pixel, weighted by coverage; 0 in pixels without
// a point. L_o: [points, 3].
Image PixelMeans(const std::vector<ShadingPoint>& points, const double* L_o,
                 int width, int height);

}  // namespace ibrdf
