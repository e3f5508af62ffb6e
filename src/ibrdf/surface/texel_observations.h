// What several views see of the texels of a surface.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/surface/surface_atlas.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

struct ObservedView {
  Camera camera;
  Image radiance;
  // Pixels that are samples of the object: inside of its mask, not clipped and
  // with all channels. Empty: all. Pixels of radiance that is not finite or
  // below 0 are none, whatever it says.
  Mask samples;
};

// Samples of a block of texels. Directions are along tangent, bitangent and
// normal. Outgoing radiance is bilinear between pixels, 0 where there is no
// sample; incoming radiance 0 where `shadowed_light` and the object hides it.
// What is said of the map, mean_radiance and prefilter_alpha, is the caller's
// to set.
struct TexelObservations : TexelSamples {
  // [num_texels, num_views]: 1 where a ray reaches the camera, sample or not.
  std::vector<uint8_t> visible;
};

struct ObserverOptions {
  // Texels below the horizon of a view by this cosine are not seen by it.
  float least_cosine = 1e-3f;
  // Whether light that the object hides in the mirror direction is left out.
  // The published model has none of it (Wiersma et al. 2025).
  bool shadowed_light = false;
  int num_threads = 0;  // <= 0: all
};

// Sees blocks of texels, so that memory is that of the views and of one block:
// 44 bytes a texel and view. Immutable; one thread at a time may call it.
class TexelObserver {
 public:
  // prefiltered: PrefilterMap of the known light. Fails where a camera is
  // invalid, or a mask has another size than its image; the message has the
  // view's number.
  static StatusOr<TexelObserver> Make(const Scene& scene, SurfaceAtlas atlas,
                                      std::vector<ObservedView> views,
                                      Image prefiltered,
                                      const ObserverOptions& options);

  const SurfaceAtlas& atlas() const { return atlas_; }
  int num_views() const { return static_cast<int>(views_.size()); }
  // Pixels of a view that are samples: those of ObservedView without
  // silhouettes, pixels beside one that sees nothing or that is farther or
  // nearer than the surface explains.
  const Mask& usable(int view) const { return views_[view].samples; }
  // Just above the surface, where rays from a texel begin.
  Eigen::Vector3d RayStart(const SurfaceTexel& texel) const;

  // The observations of atlas().texels [begin, end).
  TexelObservations Observe(int64_t begin, int64_t end) const;

 private:
  TexelObserver(const Scene& scene, SurfaceAtlas atlas,
                std::vector<ObservedView> views, Image prefiltered,
                const ObserverOptions& options);
  void KeepSamples(ObservedView* view) const;
  void ObserveTexel(const SurfaceTexel& texel, int row,
                    TexelObservations* out) const;
  // Directions to the cameras that may see the texel, and the views' numbers.
  std::vector<int> ViewsAbove(const SurfaceTexel& texel,
                              std::vector<Eigen::Vector3f>* directions) const;

  Scene scene_;
  SurfaceAtlas atlas_;
  std::vector<ObservedView> views_;  // cameras with pose and focal length
  Image prefiltered_;
  ObserverOptions options_;
  double offset_ = 0.0;  // of rays from the surface
};

}  // namespace ibrdf
