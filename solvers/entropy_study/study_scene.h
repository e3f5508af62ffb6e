// A surface of random materials under a measured map, seen from many sides.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/solvers/entropy_study/study_surface.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// Kd and Ks by channel; f = Kd / pi + D F G / (4 cos cos), with GGX, Smith's
// factor for each direction and Schlick's F of F_0 = Ks.
struct StudyMaterial {
  double roughness;
  Eigen::Array3d Kd, Ks;
};

struct SceneOptions {
  int num_views = 100;        // on a sphere of four radii
  bool one_material = false;  // else one for each texel
  double occluders = 2.0;     // caps between texel and cameras, in the mean
  double noise = 0.02;        // of log radiance
  int samples = 512;          // of the light, a view
  int num_threads = 0;        // <= 0: all
  unsigned seed = 1;
};

// Roughnesses of the grid of brute force.
inline constexpr int kBruteRoughnesses = 8;

// A texel is a point of the surface. Radiance is in units of the map's mean.
struct StudyScene {
  // What evaluators see. The surface hides cameras from its texels, and light
  // of which `incoming` knows nothing. There is no light from one part of it to
  // another.
  TexelSamples samples;
  // `incoming` without what the surface hides in the mirror direction.
  std::vector<float> unhidden_incoming;
  std::vector<StudyMaterial> materials;  // [num_texels]
  std::vector<Eigen::Vector3d> cameras;  // [num_views]

  // [texels, 3] by TexelIrradiance: as if the surface hid nothing, and without
  // what it hides.
  std::vector<float> open_irradiance, unhidden_irradiance;

  // The exact model, of every texel: radiance of a white matte surface, E / pi,
  // [texels, 3].
  std::vector<float> matte;
  // And of every view and roughness i / 7 of the grid: what a gloss of Ks = 0
  // and the increase by Ks reflect, [texels, views, 8, 3]; zeros where the
  // texel is not seen. B = Kd matte + fixed + Ks slope.
  std::vector<float> fixed, slope;
};

// map: in the library's frame.
StudyScene MakeStudyScene(const StudySurface& surface, const Image& map,
                          const SceneOptions& options);

}  // namespace ibrdf
