// Renders of every pixel of the object, and images of what holds there.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// What is rendered, and where to.
struct PixelRender {
  MaterialGrids brdfs;
  const float* map = nullptr;               // radiance [H, W, 3]
  std::vector<double>* radiance = nullptr;  // receives [pixels * 3]
};

// Renders all under maps of one size, slice by slice: the lists of pairs of all
// pixels would take gigabytes.
void RenderPixels(const SolveSetup& setup, MapSize size,
                  const std::vector<PixelRender>& renders);

// The same of any points.
void RenderPoints(const std::vector<ShadingPoint>& points, MapSize size,
                  const TransportOptions& options,
                  const std::vector<PixelRender>& renders);

// Values [pixels * 3] at the object's pixels, 0 elsewhere.
Image AtPixels(const SolveSetup& setup, const std::vector<double>& values);

}  // namespace ibrdf
