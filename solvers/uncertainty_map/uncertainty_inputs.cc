#include "ibrdf/solvers/uncertainty_map/uncertainty_inputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/surface/prefiltered_map.h"
#include "ibrdf/uncertainty/band_limit.h"

namespace ibrdf {

StatusOr<UncertaintyInputs> LoadUncertaintyInputs(const Problem& problem,
                                                  int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckTextures(problem));
  UncertaintyInputs out;
  StatusOr<TexturedSurface> surface =
      LoadTexturedSurface(problem, &out.warnings);
  if (!surface.ok()) return surface.status();
  out.surface = *std::move(surface);
  const StatusOr<Image> map =
      LoadKnownIllumination(problem.illumination, &out.warnings);
  if (!map.ok()) return map.status();
  out.mean_radiance = MeanRadiance(*map).mean();
  if (!(out.mean_radiance > 0.0) || !std::isfinite(out.mean_radiance)) {
    return InvalidInput(problem.path + ": illumination.known",
                        "expected finite light, found a map of mean radiance " +
                            std::to_string(out.mean_radiance));
  }
  StatusOr<std::vector<PhotographedView>> views =
      LoadPhotographedViews(problem, &out.warnings);
  if (!views.ok()) return views.status();
  out.views = *std::move(views);
  out.prefilter_alpha = PrefilterAlpha(static_cast<int>(out.views.size()));
  out.prefiltered = PrefilterMap(*map, out.prefilter_alpha, num_threads);
  out.irradiance = std::make_shared<const TexelIrradiance>(
      out.surface.scene, *map,
      problem.uncertainty.shadows == EntropyShadows::kMirror);
  return out;
}

CandidateSetting SettingOf(const UncertaintyInputs& inputs) {
  CandidateSetting out;
  const std::vector<SurfaceTexel>& texels = inputs.surface.atlas.texels;
  Eigen::Vector3d low = texels[0].position, high = low;
  for (const SurfaceTexel& texel : texels) {
    low = low.cwiseMin(texel.position);
    high = high.cwiseMax(texel.position);
  }
  out.centre = 0.5 * (low + high);
  out.radius = 0.0;
  for (const SurfaceTexel& texel : texels) {
    out.radius = std::max(out.radius, (texel.position - out.centre).norm());
  }
  for (const PhotographedView& view : inputs.views) {
    out.photographs.push_back(
        {view.camera, view.radiance.width, view.radiance.height});
  }
  return out;
}

}  // namespace ibrdf
