// Slow, converged renderer: the image that accuracy is measured against.
// Full-resolution map, MERL table trilinear between bin centres
// (InterpolateMerl), no BRDF grid. No shadows, no bounces. Points seen at the
// same angle (most of a sphere's under an orthographic camera) share the BRDF
// values of their near samples.
#pragma once
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/quadrature.h"
#include "ibrdf/render/scene.h"

namespace ibrdf {

struct ReferenceOptions {
  // Near as in QuadratureOptions. Rings and their samples are those for maps of
  // up to 512 columns and grow in proportion to wider ones.
  double near_begin_degrees = 8.0;
  double near_end_degrees = 16.0;
  int near_rings = 96;
  int near_ring_samples = 256;
  // Wider maps are taken in blocks of texels in the far rule, each at the
  // centroid of its light; bright uneven blocks by texel all the same. Against
  // every texel and twice the rings: mean |log ratio| below 0.001 from matte
  // to mirror, a hard key light included.
  int far_width = 128;
  int num_threads = 0;  // <= 0: all
};

// Immutable; its functions may be called from one thread at a time.
class ReferenceRenderer {
 public:
  ReferenceRenderer(const Image& map, const ReferenceOptions& options);

  // Radiance [points, 3]. Weights and sums are double; BRDF values float.
  void Render(const std::vector<ShadingPoint>& points, const MerlTable& table,
              double* E) const;
  // `brdf` may be called from several threads at a time.
  void Render(const std::vector<ShadingPoint>& points, const BrdfFunction& brdf,
              double* E) const;

 private:
  template <typename Lookup>
  void RenderWith(const std::vector<ShadingPoint>& points, const Lookup& lookup,
                  double* E) const;

  // Cells of the far rule and their radiance times solid angle.
  struct Light {
    std::vector<FarCell> cells;
    std::vector<Eigen::Array3d> power;
  };
  static Light GatherLight(const Image& map, int far_width);
  static QuadratureOptions NearOptions(const Image& map,
                                       const ReferenceOptions& options);

  // Four floats a texel, with what lies across the poles above and below and
  // the first column repeated on the right: bilinear taps need no wrapping.
  struct PaddedMap {
    explicit PaddedMap(const Image& map);
    // Sum of f_k L(wi_k), wi = x t + y b + z n of unit length.
    struct Rays;
    Eigen::Array3d Gather(const Rays& rays, const Eigen::Matrix3f& frame) const;

    int width, height;
    std::vector<float> lanes;  // [height + 2][width + 1][4]
  };
  // Near samples of one view angle, in the frame of ViewFrame.
  template <typename Lookup>
  void ShadeNear(const Eigen::Vector3d& n, const Eigen::Vector3d& wo,
                 const Lookup& lookup, std::vector<NearSample>* samples,
                 PaddedMap::Rays* rays) const;

  ReferenceRenderer(const Image& map, Light light,
                    const ReferenceOptions& options);

  int num_threads_;
  PaddedMap map_;
  std::vector<Eigen::Array3d> power_;
  PointQuadrature quadrature_;
};

// Mean over the points of each pixel, weighted by coverage; 0 in pixels without
// a point. E: [points, 3].
Image PixelMeans(const std::vector<ShadingPoint>& points, const double* E,
                 int width, int height);

}  // namespace ibrdf
