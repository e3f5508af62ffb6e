// A sphere of random materials under a measured map, seen from many sides.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// Kd and Ks by channel; f = Kd / pi + D F G / (4 cos cos), with GGX, Smith's
// factor for each direction and Schlick's F of F_0 = Ks.
struct StudyMaterial {
  double roughness;
  Eigen::Array3d Kd, Ks;
};

struct SceneOptions {
  int num_texels = 200;
  int num_views = 100;        // on a sphere of four radii
  bool one_material = false;  // else one for each texel
  double occluders = 2.0;     // caps in front of a texel, in the mean
  double noise = 0.02;        // of log radiance
  int samples = 512;          // of the light, a view
  unsigned seed = 1;
};

// Roughnesses of the grid of brute force.
inline constexpr int kBruteRoughnesses = 8;

struct StudyScene {
  TexelSamples samples;                  // radiance in units of the map's mean
  std::vector<StudyMaterial> materials;  // [num_texels]
  std::vector<Eigen::Vector3d> cameras;  // [num_views]
  // Of every texel, view and roughness i / 7 of the grid: what a gloss of
  // Ks = 0 and the increase by Ks reflect, [texels, views, 8, 3]; zeros where
  // the texel is not seen. B = Kd E / pi + fixed + Ks slope.
  std::vector<float> fixed, slope;
};

// map: in the library's frame.
StudyScene MakeStudyScene(const Image& map, const SceneOptions& options);

}  // namespace ibrdf
