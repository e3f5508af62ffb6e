#include "experiments/benchmarks/render_speed/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {

std::vector<Look> Materials() {
  const auto look = [](const char* name, double diffuse, double specular,
                       double roughness, double f0) {
    CookTorrance brdf;
    brdf.diffuse = Eigen::Array3d::Constant(diffuse);
    brdf.specular = Eigen::Array3d::Constant(specular);
    brdf.roughness = Eigen::Array3d::Constant(roughness);
    brdf.f0 = Eigen::Array3d::Constant(f0);
    return Look{name, SampleMerl(brdf.Function())};
  };
  return {look("matte", 0.5, 0.0, 1.0, 0.04),
          look("glossy", 0.2, 1.0, 0.15, 0.04),
          look("mirror", 0.0, 1.0, 0.02, 0.9)};
}

std::vector<Light> Lights() {
  SkyOptions sky;
  sky.sun_radius_degrees = 0.5;
  SkyOptions overcast = sky;
  overcast.sun_irradiance = 0.0;
  return {{"soft", RenderSky(overcast, 128, 256)},
          {"hard", RenderSky(sky, 128, 256)}};
}

TriangleMesh LoadMesh(const std::string& meshes, const std::string& name) {
  std::string path = meshes;
  path += "/" + name + ".obj";
  StatusOr<TriangleMesh> mesh = ReadMesh(path);
  if (!mesh.ok()) {
    std::fprintf(stderr, "%s\n", mesh.status().message().c_str());
    std::exit(2);
  }
  FitUnitSphere(&*mesh);
  return *std::move(mesh);
}

Scene LoadShape(const std::string& meshes, const std::string& name) {
  if (name == "sphere") return Scene::UnitSphere();
  return Scene::FromMesh(LoadMesh(meshes, name)).value();
}

std::vector<ShadingPoint> PointsByAngle(const Scene& scene, int size,
                                        int samples_per_side) {
  std::vector<ShadingPoint> points =
      FindShadingPoints(scene, Camera(), size, size, Mask(), samples_per_side)
          .value();
  std::stable_sort(points.begin(), points.end(),
                   [](const ShadingPoint& a, const ShadingPoint& b) {
                     return a.normal.dot(a.wo) < b.normal.dot(b.wo);
                   });
  return points;
}

double LogError(const std::vector<double>& a, const std::vector<double>& b) {
  const auto count = static_cast<double>(b.size());
  double mean = 0.0, error = 0.0;
  for (const double v : b) mean += v / count;
  const double least = 1e-3 * mean;
  for (size_t i = 0; i < b.size(); ++i) {
    error += std::abs(std::log(std::max(a[i], least)) -
                      std::log(std::max(b[i], least))) /
             count;
  }
  return error;
}

double Seconds(const std::function<void()>& call) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  call();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace ibrdf
