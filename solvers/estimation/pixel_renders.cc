#include "ibrdf/solvers/estimation/pixel_renders.h"

#include <algorithm>

#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr size_t kPointsAtOnce = 1024;

}  // namespace

void RenderPixels(const SolveSetup& setup, MapSize size,
                  const std::vector<PixelRender>& renders) {
  RenderPoints(setup.pixels.points, size, setup.transport, renders);
}

void RenderPoints(const std::vector<ShadingPoint>& points, MapSize size,
                  const TransportOptions& options,
                  const std::vector<PixelRender>& renders) {
  if (renders.empty()) return;
  for (const PixelRender& render : renders) {
    render.radiance->resize(3 * points.size());
  }
  const bool bounces = options.patches != nullptr;
  const size_t at_once = bounces ? kPointsAtOnceWithBounces : kPointsAtOnce;
  for (size_t begin = 0; begin < points.size(); begin += at_once) {
    const size_t end = std::min(begin + at_once, points.size());
    const Transport transport(
        std::vector<ShadingPoint>(points.begin() + begin, points.begin() + end),
        size.height, size.width, options);
    for (const PixelRender& render : renders) {
      transport.Render(render.brdfs, render.map,
                       render.radiance->data() + 3 * begin);
    }
  }
}

Image AtPixels(const SolveSetup& setup, const std::vector<double>& values) {
  Image image(setup.problem->image.width, setup.problem->image.height);
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  for (size_t i = 0; i < points.size(); ++i) {
    float* rgb = image.rgb.data() + size_t{3} * points[i].pixel;
    for (int c = 0; c < 3; ++c) {
      rgb[c] = static_cast<float>(values[3 * i + c]);
    }
  }
  return image;
}

}  // namespace ibrdf
