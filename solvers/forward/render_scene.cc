#include "ibrdf/solvers/forward/render_scene.h"

#include <utility>

#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/image_noise.h"
#include "ibrdf/solvers/problem/load_views.h"

namespace ibrdf {
namespace {

uint64_t SeedOf(const Problem& problem, const RenderSceneOptions& options) {
  return problem.solver.seed.has_value()
             ? static_cast<uint64_t>(*problem.solver.seed)
             : options.seed;
}

StatusOr<RenderedScene> RenderInputs(const Problem& problem,
                                     ForwardInputs inputs,
                                     const RenderSceneOptions& options) {
  StatusOr<ForwardScene> scene =
      PlaceForwardScene(problem, std::move(inputs), options.num_threads);
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
  AddNoise(problem.noise, SeedOf(problem, options), &out.image);
  if (scene->texture) out.painted_brdf = SampleMerl(scene->brdf.function);
  if (scene->paint) out.painted_brdf = scene->paint->MeanTable(scene->brdf);
  out.mask = std::move(scene->view.mask);
  out.illumination = std::move(scene->map);
  return out;
}

}  // namespace

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
  StatusOr<ForwardInputs> inputs = LoadForwardInputs(problem);
  if (!inputs.ok()) return inputs.status();
  return RenderInputs(problem, *std::move(inputs), options);
}

Status RenderViews(const Problem& problem, const RenderSceneOptions& options,
                   const TakeRender& take) {
  const StatusOr<std::vector<ViewSpec>> views =
      LoadViews(problem, problem.image.width, problem.image.height);
  if (!views.ok()) return views.status();
  const StatusOr<ForwardInputs> inputs = LoadForwardInputs(problem);
  if (!inputs.ok()) return inputs.status();
  const uint64_t seed = SeedOf(problem, options);
  for (size_t i = 0; i < views->size(); ++i) {
    const ViewSpec& view = (*views)[i];
    Problem of_view = problem;
    of_view.camera = view.camera;
    of_view.path = problem.path + ": view " + view.name;
    of_view.solver.seed.reset();
    RenderSceneOptions own = options;
    own.seed = seed + i;
    if (options.progress) {
      const auto before = static_cast<double>(i);
      const auto count = static_cast<double>(views->size());
      own.progress = [&options, before, count](double share) {
        return options.progress((before + share) / count);
      };
    }
    const StatusOr<RenderedScene> rendered =
        RenderInputs(of_view, *inputs, own);
    if (!rendered.ok()) return rendered.status();
    IBRDF_RETURN_IF_ERROR(take(view, *rendered));
  }
  return OkStatus();
}

}  // namespace ibrdf
