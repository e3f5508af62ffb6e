#include "ibrdf/solvers/forward/render_scene.h"

#include <utility>

#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/image_noise.h"

namespace ibrdf {

std::string Describe(const RenderedScene& rendered) {
  const RenderPlan& plan = rendered.plan;
  const PixelCounts& counts = rendered.counts;
  std::string text = Describe(plan.effects);
  if (plan.lobe_rays > 0) {
    text += "; " + std::to_string(plan.lobe_rays) +
            " rays of its own for each narrow lobe";
  }
  text += Describe(plan.approximation);
  if (counts.refined > 0) {
    text += "; " + std::to_string(counts.refined) + " pixels are sampled " +
            std::to_string(kMostSamplesPerSide * kMostSamplesPerSide) +
            " times";
  }
  if (plan.approximation.approximation == Approximation::kReflectanceMap &&
      counts.points > 0) {
    text += "; " + std::to_string(counts.interpolated) + " of " +
            std::to_string(counts.points) +
            " points are interpolated by their normal from others";
  }
  return text;
}

StatusOr<RenderedScene> RenderScene(const Problem& problem,
                                    const RenderSceneOptions& options) {
  StatusOr<ForwardScene> scene = LoadForwardScene(problem, options.num_threads);
  if (!scene.ok()) return scene.status();
  const StatusOr<PlannedRender> planned =
      PlanRender(problem, *scene, options.num_threads);
  if (!planned.ok()) return planned.status();
  RenderedScene out;
  out.plan = planned->plan;
  out.warnings = std::move(scene->warnings);
  if (options.plan_only) return out;

  PixelRenderer pixels(problem, *scene, *planned, options.num_threads,
                       options.progress);
  StatusOr<Image> image = pixels.Render();
  if (!image.ok()) return image.status();
  out.image = *std::move(image);
  out.counts = pixels.counts();
  const uint64_t seed = problem.solver.seed.has_value()
                            ? static_cast<uint64_t>(*problem.solver.seed)
                            : options.seed;
  AddNoise(problem.noise, seed, &out.image);
  if (scene->paint) out.painted_brdf = scene->paint->MeanTable(scene->brdf);
  out.mask = std::move(scene->view.mask);
  out.illumination = std::move(scene->map);
  return out;
}

}  // namespace ibrdf
