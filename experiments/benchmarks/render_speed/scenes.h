// Shapes, materials and lights of the studies, and how they time.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/geometry/triangle_mesh.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

struct Look {
  std::string name;
  MerlTable table;
};
// matte (albedo 0.5), glossy (slopes of 0.15) and mirror (slopes of 0.02).
std::vector<Look> Materials();

struct Light {
  std::string name;
  Image map;
};
// soft: the sky without its sun; hard: with one of 0.5 degrees. 256 x 128.
std::vector<Light> Lights();

// `meshes`/NAME.obj in the unit sphere. Ends the program where it cannot be
// read.
TriangleMesh LoadMesh(const std::string& meshes, const std::string& name);
// The same as a scene; "sphere": the unit sphere.
Scene LoadShape(const std::string& meshes, const std::string& name);

// Points of the orthographic camera by view angle, as solvers/render_scene
// takes them.
std::vector<ShadingPoint> PointsByAngle(const Scene& scene, int size,
                                        int samples_per_side);

// Mean |log a - log b| of radiance; darker than 1e-3 of the mean of b counts as
// that.
double LogError(const std::vector<double>& a, const std::vector<double>& b);

// Seconds of a call.
double Seconds(const std::function<void()>& call);

}  // namespace ibrdf
