// Shapes of the studies, and points that are evenly spread over them.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

struct SurfacePoint {
  Eigen::Vector3d position;  // just above the surface, where rays begin
  Eigen::Vector3d normal;    // unit
};

// A surface in the unit sphere about the origin.
struct StudySurface {
  Scene scene = Scene::UnitSphere();
  std::vector<SurfacePoint> points;
};

// shape: "sphere", "torus", or the name without extension of a mesh (.obj,
// .ply, .stl, .glb) in `folder`. num_points >= 1, one in each part of equal
// area; where in its part is drawn with the seed. Those of the sphere are a
// Fibonacci lattice. Fails where there is no such mesh; names the shape.
StatusOr<StudySurface> MakeStudySurface(const std::string& folder,
                                        const std::string& shape,
                                        int num_points, unsigned seed);

// `count` >= 1 unit directions, evenly spread.
std::vector<Eigen::Vector3d> FibonacciSphere(int count);

}  // namespace ibrdf
