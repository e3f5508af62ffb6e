#include "ibrdf/solvers/solve/unpainted_object.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/metrics/albedo.h"
#include "ibrdf/solvers/estimation/pixel_renders.h"

namespace ibrdf {

UnpaintedReflectance UnpaintedOf(const LobeModel& lobes,
                                 const double* parameters) {
  UnpaintedReflectance out;
  out.whole = lobes.Grid(parameters);
  out.matte = lobes.Combine(parameters, MatteShapes(lobes, parameters), 1);
  out.albedo = MatteAlbedo(out.matte);
  return out;
}

UnpaintedRadiance RenderUnpainted(const SolveSetup& setup,
                                  const UnpaintedReflectance& reflectance,
                                  const std::vector<float>& map, MapSize size) {
  UnpaintedRadiance out;
  std::vector<PixelRender> renders;
  for (const BesideRender& part : UnpaintedRenders(reflectance, &out)) {
    renders.push_back({part.brdfs, map.data(), part.radiance});
  }
  RenderPixels(setup, size, renders);
  TakeMatteOff(&out);
  return out;
}

std::vector<BesideRender> UnpaintedRenders(
    const UnpaintedReflectance& reflectance, UnpaintedRadiance* out) {
  return {{{&reflectance.matte}, &out->matte},
          {{&reflectance.whole}, &out->gloss}};
}

void TakeMatteOff(UnpaintedRadiance* out) {
  for (size_t i = 0; i < out->gloss.size(); ++i) {
    out->gloss[i] = std::max(out->gloss[i] - out->matte[i], 0.0);
  }
}

std::vector<double> MatteShading(const SolveSetup& setup) {
  BrdfGrid white(setup.lobes->grid_shape());
  for (float& f : white.values) f = static_cast<float>(1.0 / kPi);
  std::vector<double> shading;
  RenderPixels(setup, setup.map_size(),
               {{{&white}, setup.known_map.data(), &shading}});
  return shading;
}

void ScalePixels(const std::vector<double>& factors,
                 const std::vector<ShadingPoint>& points, Image* image) {
  for (size_t i = 0; i < points.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      float& v = image->rgb[size_t{3} * points[i].pixel + c];
      v = static_cast<float>(v * factors[3 * i + c]);
    }
  }
}

InverseProblem WithoutPaint(const InverseProblem& problem,
                            const std::vector<double>& gain,
                            const std::vector<ShadingPoint>& points) {
  std::vector<double> factors;
  for (const double g : gain) factors.push_back(1.0 / g);
  InverseProblem out = problem;
  ScalePixels(factors, points, &out.image);
  if (out.bounds) {
    ScalePixels(factors, points, &out.bounds->low);
    ScalePixels(factors, points, &out.bounds->high);
  }
  return out;
}

void SetPaint(const SolveSetup& setup, const UnpaintedReflectance& reflectance,
              const UnpaintedRadiance& unpainted,
              const std::vector<double>& log_albedo,
              const std::vector<double>& log_std, Solution* solution) {
  std::vector<double> albedo(log_albedo.size()), of_channels;
  for (size_t i = 0; i < albedo.size(); ++i) {
    albedo[i] = reflectance.albedo[i % 3] * std::exp(log_albedo[i]);
  }
  solution->albedo = AtPixels(setup, albedo);
  for (const double std : log_std) {
    of_channels.insert(of_channels.end(), 3, std);
  }
  solution->gloss = AtPixels(setup, unpainted.gloss);
  solution->albedo_log_std = AtPixels(setup, of_channels);
}

}  // namespace ibrdf
