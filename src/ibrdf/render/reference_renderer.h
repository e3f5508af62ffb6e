// Slow, converged renderer: the image that accuracy is measured against.
//
//   L_o(n, wo) = int f_r(wi, wo) L(wi) V(wi) cos(theta_i) dwi
//
// It takes the full-resolution map L and a MERL table, trilinear between bin
// centres (InterpolateMerl), or any function f_r: no BRDF grid. The integral is
// that of PointQuadrature. Its near rule looks rays up in the map; its far rule
// takes blocks of texels. Three things are added where asked for:
//
//   - Shadows V, traced afresh for every point.
//   - The radiance of patches (Transport::Emitted) where light is hidden. A
//     lobe so narrow that patches would blur it sees the object along rays of
//     its own, and what these meet is rendered in turn, bounce by bounce.
//   - Texels far brighter than the rest, by samples of their own.
//
// Points seen at the same angle (most of a sphere's under an orthographic
// camera) share the BRDF values of their near samples.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/reference_light.h"
#include "ibrdf/render/reference_parts.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/bright_texels.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

// What the object throws on itself.
struct EmittedLight {
  const double* radiance = nullptr;  // of the patches [patches, 3]; null: none
  // How often that light is reflected on its way, the point that is rendered
  // included: `radiance` is R_bounces of Transport.
  int bounces = 0;
};

// The rules of PointQuadrature whose part of the radiance is asked for. What a
// narrow lobe shows is in the near one's; the far one's, of lobes that are wide
// or aside, hardly changes from normal to normal.
enum class QuadratureRules { kBoth, kNear, kFar };

// The BRDF at a point of a surface where it varies.
using SurfaceBrdf = std::function<BrdfFunction(const ShadingPoint& point)>;

// A renderer is immutable. One thread at a time may call its functions (they
// are parallel inside). ReferenceRadiance binds it to a reflectance.
class ReferenceRenderer {
 public:
  ReferenceRenderer(const Image& map, const ReferenceOptions& options);

  // Radiance L_o [points, 3]. Weights and sums are double; BRDF values of a
  // table are float. Light of bright texels is the near rule's.
  void Render(const std::vector<ShadingPoint>& points, const MerlTable& table,
              double* L_o, const EmittedLight& emitted = {},
              QuadratureRules rules = QuadratureRules::kBoth) const;
  // Several threads may call `brdf` at a time.
  void Render(const std::vector<ShadingPoint>& points, const BrdfFunction& brdf,
              double* L_o, const EmittedLight& emitted = {},
              QuadratureRules rules = QuadratureRules::kBoth) const;
  // sharpest: one of the narrowest lobes among them, for which the sun and what
  // lobes see of the object are sampled.
  void Render(const std::vector<ShadingPoint>& points, const SurfaceBrdf& brdf,
              const BrdfFunction& sharpest, double* L_o,
              const EmittedLight& emitted = {}) const;

 private:
  // What a call has found out about its reflectance.
  struct LobeSettings;
  // One rendering of points: those of a call, or what its lobes' rays met after
  // `depth` bounces. Lookup: f_r(theta_h, theta_d, phi_d), or a SurfaceBrdf.
  template <typename Lookup>
  struct Pass;
  // Radiance that lobes' rays bring: `rays` of each point.
  struct LobeLight;
  // Near samples of one view angle: directions in the frame of ViewFrame, and
  // weights times f_r.
  struct Rays;
  struct Scratch;  // of one worker
  // What a point sees.
  struct Sight {
    const uint64_t* hidden = nullptr;  // its bits; null: nothing is
    SeenPatches seen;
    const double* emitted = nullptr;  // of the patches [patches, 3]
    // Radiance along the rays of the lobe [rays, 3], negative where they meet
    // nothing; null: there are none.
    const double* lobe = nullptr;
  };

  ReferenceRenderer(const BrightTexels& map, const ReferenceOptions& options);
  ReferenceRenderer(const BrightTexels& map, ReferenceLight light,
                    const ReferenceOptions& options);

  // From a call to a point.
  template <typename Lookup>
  void RenderWith(const std::vector<ShadingPoint>& points, const Lookup& lookup,
                  const BrdfFunction& sharpest, const EmittedLight& emitted,
                  QuadratureRules rules, double* L_o) const;
  template <typename Lookup>
  void RenderPass(const Pass<Lookup>& pass, double* L_o) const;
  template <typename Lookup>
  void RenderGroup(const Pass<Lookup>& pass, const ViewGroups& groups,
                   int64_t group, const LobeLight& lobes, Scratch* scratch,
                   double* L_o) const;
  // Fills what it points to in `scratch`.
  Sight Look(const ShadingPoint& point, const EmittedLight& emitted,
             Scratch* scratch) const;

  // The near rule. ShadeNear fills the rays of a view angle; Gather is the sum
  // of f_k L(wi_k) V(wi_k) over them at one point, wi = x t + y b + z n of unit
  // length, axes t, b, n.
  template <typename Lookup>
  void ShadeNear(const PointFrame& frame, const Lookup& lookup,
                 std::vector<NearSample>* samples, Rays* rays) const;
  Eigen::Array3d Gather(const Rays& rays, const Eigen::Matrix3f& axes,
                        const Sight& sight) const;
  // Share of rays [begin, begin + n) that no geometry hides, n <= kRayBlock.
  void FindVisible(const Rays& rays, size_t begin, int n,
                   const Eigen::Matrix3f& axes, const uint64_t* hidden,
                   float* visible) const;
  // Radiance of the object along a hidden ray; null: black.
  const double* ObjectAlong(const Rays& rays, size_t ray,
                            const Eigen::Matrix3f& axes,
                            const Sight& sight) const;

  // The far rule: adds a point's to the sum. LightOfCell is the light that
  // reaches it from a cell whose share `visible` is not hidden, and from the
  // patches in the rest of it.
  template <typename Lookup>
  void AddFar(const PointFrame& frame, const Lookup& lookup, const Sight& sight,
              Scratch* scratch, Eigen::Array3d* sum) const;
  Eigen::Array3d LightOfCell(int cell, double visible, const Eigen::Vector3d& n,
                             const Sight& sight,
                             std::vector<PatchShare>* shares) const;

  // Light of bright texels at a point; what is hidden is left out. There are
  // enough samples for a lobe whose half-vectors have that half width, radians.
  template <typename Lookup>
  Eigen::Array3d GatherBright(const PointFrame& frame,
                              const std::vector<BrightSample>& bright,
                              const Lookup& lookup,
                              const uint64_t* hidden) const;
  int BrightSamplesPerSide(double lobe_half_width) const;

  // Rays of narrow lobes. Bundle gathers the rays within lobe_width of the
  // normal into `count` bundles of like directions and weight; it sets
  // rays->bundle and returns their means.
  static std::vector<Eigen::Vector3f> Bundle(
      const std::vector<NearSample>& samples, double lobe_width, int count,
      Rays* rays);
  // MeetObject casts the bundles of each point [points, rays]: the points that
  // they meet, and which of them do. LightOfLobes renders those.
  template <typename Lookup>
  std::vector<char> MeetObject(const Pass<Lookup>& pass,
                               const ViewGroups& groups, int rays,
                               std::vector<ShadingPoint>* met) const;
  template <typename Lookup>
  LobeLight LightOfLobes(const Pass<Lookup>& pass,
                         const ViewGroups& groups) const;

  int num_threads_, lobe_rays_;
  // Renders what lobes' rays meet; null: this one does.
  std::unique_ptr<const ReferenceRenderer> coarser_;
  const ReferenceKernels& kernels_ = ActiveReferenceKernels();
  std::vector<BrightTexel> bright_;
  // The map without the bright texels' excess; so are the far rule's cells.
  PaddedMaps map_;
  std::vector<Eigen::Array3d> power_;  // of the cells
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
