// Maps compared by what spheres look like under them.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Seen by an orthographic camera. kMirror: a perfect mirror, as in Chen et al.
// 2020, supplement, Table 1. kDiffuse: Lambertian, albedo 1. kGlossy:
// Cook-Torrance, diffuse 0.2, specular 1, RMS slope 0.15, f0 0.04.
enum class Sphere { kMirror, kDiffuse, kGlossy };
// "mirror", "diffuse", "glossy".
std::string SphereName(Sphere sphere);

// 0 outside the sphere. Mirror: 128x128 pixels, 2x2 samples; the others, which
// are smooth, 48x48 at preview quality.
Image RenderSphere(const Image& map, Sphere sphere, int num_threads);

// As Chen et al. 2020, supplement, section 1: the estimate's picture e times
// the one scale s >= 0 (all channels) with the least mean square of s e - r.
struct SphereMetrics {
  double log_rmse = 0.0;  // of log(1 + s e) - log(1 + r), natural logarithm
  double rmse = 0.0;      // of s e - r
  double dssim = 0.0;     // of s e and r, see image_metrics.h
};

// Maps of any size. Refuses maps that are not finite or a reference that is
// black; the message starts with "estimate" or "reference".
StatusOr<SphereMetrics> CompareSpheres(const Image& estimate,
                                       const Image& reference, Sphere sphere,
                                       int num_threads);

}  // namespace ibrdf
