#include "ibrdf/solvers/forward/forward_scene.h"

#include <algorithm>
#include <utility>

#include "ibrdf/io/merl.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

StatusOr<KnownBrdf> LoadBrdf(const ReflectanceSpec& reflectance) {
  KnownBrdf brdf;
  if (reflectance.principled.has_value()) {
    brdf.function = PrincipledBrdf(*reflectance.principled).Function();
    return brdf;
  }
  if (reflectance.analytic.has_value()) {
    brdf.function = reflectance.analytic->Function();
    return brdf;
  }
  StatusOr<MerlTable> table = ReadMerl(reflectance.known_file);
  if (!table.ok()) return table.status();
  brdf.table = *std::move(table);
  return brdf;
}

Status AddKnownPaint(const PaintSpec& spec, ForwardScene* scene) {
  StatusOr<KnownPaint> paint =
      LoadKnownPaint(spec, scene->view.points, scene->view.mask, scene->brdf);
  if (!paint.ok()) return paint.status();
  if (paint->pixels_without > 0) {
    scene->warnings.push_back(
        spec.albedo + ": " + std::to_string(paint->pixels_without) + " of " +
        std::to_string(scene->view.mask.CountInside()) +
        " pixels of the object are 0, which is black paint");
  }
  scene->paint = *std::move(paint);
  return OkStatus();
}

StatusOr<ViewPoints> SeePoints(const Problem& problem, const Scene& scene,
                               int num_threads) {
  const int width = problem.image.width, height = problem.image.height;
  StatusOr<std::vector<ShadingPoint>> found =
      FindShadingPoints(scene, problem.camera, width, height, Mask(),
                        SamplesPerSide(problem.quality), num_threads);
  if (!found.ok()) {
    return InvalidInput(problem.path, found.status().message());
  }
  ViewPoints view;
  view.scene = scene;
  view.points = *std::move(found);
  view.mask = Mask(width, height, 0);
  for (const ShadingPoint& p : view.points) view.mask.inside[p.pixel] = 255;
  SortByAngle(&view.points);
  return view;
}

}  // namespace

void SortByAngle(std::vector<ShadingPoint>* points) {
  std::stable_sort(points->begin(), points->end(),
                   [](const ShadingPoint& a, const ShadingPoint& b) {
                     return a.normal.dot(a.wo) < b.normal.dot(b.wo);
                   });
}

int SamplesPerSide(RenderQuality quality) {
  return quality == RenderQuality::kReference ? kMostSamplesPerSide : 1;
}

Status RenderInterrupted(const Problem& problem) {
  return Status(StatusCode::kInterrupted, problem.path + ": interrupted");
}

StatusOr<ViewPoints> FindViewPoints(const Problem& problem, int num_threads,
                                    std::vector<std::string>* warnings) {
  const StatusOr<Scene> scene =
      LoadScene(problem, problem.image.width, problem.image.height, warnings);
  if (!scene.ok()) return scene.status();
  return SeePoints(problem, *scene, num_threads);
}

StatusOr<ForwardInputs> LoadForwardInputs(const Problem& problem) {
  ForwardInputs inputs;
  StatusOr<Scene> scene = LoadScene(problem, problem.image.width,
                                    problem.image.height, &inputs.warnings);
  if (!scene.ok()) return scene.status();
  StatusOr<Image> map =
      LoadKnownIllumination(problem.illumination, &inputs.warnings);
  if (!map.ok()) return map.status();
  StatusOr<KnownBrdf> brdf = LoadBrdf(problem.reflectance);
  if (!brdf.ok()) return brdf.status();
  inputs.scene = *std::move(scene);
  inputs.map = *std::move(map);
  inputs.brdf = *std::move(brdf);
  const std::optional<PrincipledSpec>& values = problem.reflectance.principled;
  if (values.has_value() && values->textured()) {
    StatusOr<KnownTexture> texture = KnownTexture::Load(
        *values, problem.geometry.kind == GeometryKind::kSphere);
    if (!texture.ok()) return texture.status();
    inputs.texture = *std::move(texture);
  }
  return inputs;
}

StatusOr<ForwardScene> PlaceForwardScene(const Problem& problem,
                                         ForwardInputs inputs,
                                         int num_threads) {
  StatusOr<ViewPoints> view = SeePoints(problem, inputs.scene, num_threads);
  if (!view.ok()) return view.status();
  ForwardScene scene;
  scene.view = *std::move(view);
  scene.map = std::move(inputs.map);
  scene.brdf = std::move(inputs.brdf);
  scene.texture = std::move(inputs.texture);
  if (scene.texture) {
    scene.brdf.function = scene.texture->Mean(scene.view.points).Function();
    scene.sharpest = scene.texture->Sharpest(scene.view.points).Function();
  }
  scene.warnings = std::move(inputs.warnings);
  if (problem.reflectance.paint.has_value()) {
    IBRDF_RETURN_IF_ERROR(AddKnownPaint(*problem.reflectance.paint, &scene));
  }
  if (scene.view.scene.CastsShadows()) {
    scene.grid =
        scene.paint ? scene.paint->MeanGrid(scene.brdf) : scene.brdf.Grid();
    scene.narrow_lobe =
        LobeHalfWidth(scene.texture ? scene.sharpest : scene.brdf.Lookup()) <
        kNarrowLobe;
  }
  return scene;
}

}  // namespace ibrdf
