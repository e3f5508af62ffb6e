// Maps and reflectances compared by what spheres look like.
#pragma once
#include <array>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/merl_table_stack.h"

namespace ibrdf {

// Seen by an orthographic camera. kMirror: a perfect mirror, as in Chen et al.
// 2020, supplement, Table 1. kDiffuse: Lambertian, albedo 1. kGlossy:
// Cook-Torrance, diffuse 0.2, specular 1, RMS slope 0.15, f0 0.04.
enum class Sphere { kMirror = 0, kDiffuse = 1, kGlossy = 2 };
inline constexpr int kNumSpheres = 3;
// "mirror", "diffuse", "glossy".
std::string SphereName(Sphere sphere);

// As Chen et al. 2020, supplement, section 1: the estimate's picture e times
// the one scale s >= 0 (all channels) with the least mean square of s e - r.
struct SphereMetrics {
  double log_rmse = 0.0;  // of log(1 + s e) - log(1 + r), natural logarithm
  double rmse = 0.0;      // of s e - r
  double dssim = 0.0;     // of s e and r, see image_metrics.h
};

// Mirror spheres under two maps: 128x128 pixels, 2x2 samples. Refuses what
// SphereGallery::Compare does.
StatusOr<SphereMetrics> CompareMirrors(const Image& estimate,
                                       const Image& reference);

// Spheres of two materials under one map that is not the input's: the
// supplement's "nat. illum."; 64x64 pixels. num_threads <= 0: all. Refuses a
// map that is not finite and a reference that looks black; the message starts
// with "map" or "reference".
StatusOr<SphereMetrics> CompareRelit(const MerlTable& estimate,
                                     const MerlTable& reference,
                                     const Image& map, int num_threads);

// Immutable; its functions may be called from one thread at a time.
class SphereGallery {
 public:
  using Pictures = std::array<Image, kNumSpheres>;  // by Sphere

  // num_threads <= 0: all.
  explicit SphereGallery(int num_threads);

  // 0 outside the spheres. Mirror: 128x128 pixels, 2x2 samples; the others,
  // which are smooth, 40x40 at preview quality.
  Pictures Render(const Image& map) const;

  // Refuses maps that are not finite and a reference that is black; the message
  // starts with "estimate" or "reference".
  StatusOr<std::array<SphereMetrics, kNumSpheres>> Compare(
      const Image& estimate, const Image& reference) const;

 private:
  int num_threads_;
  MerlTableStack tables_;  // diffuse, glossy
};

}  // namespace ibrdf
