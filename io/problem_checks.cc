// What a solve, a map of uncertainty and a render need of a problem.
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/io/problem_file.h"

namespace ibrdf {
namespace {

// The failure of a key of the problem.
Status KeyFailure(const Problem& problem, const std::string& key,
                  const std::string& what) {
  return InvalidInput(problem.path + ": " + key, what);
}

// Refuses textures, which are another program's.
Status CheckNotTextures(const Problem& problem) {
  if (problem.kind != ProblemKind::kTextures) return OkStatus();
  return KeyFailure(problem, "problem",
                    "textures are ibrdf_uncertainty's alone");
}

// Several views have each its photograph, and `image` what they share.
Status CheckViewImages(const Problem& problem) {
  const ImageSpec& image = problem.image;
  if (!image.file.empty() || !image.mask.empty() || image.width > 0 ||
      !image.brackets.empty()) {
    return KeyFailure(
        problem, "image",
        "expected no file, mask, size or brackets beside views: each "
        "view has its file");
  }
  for (size_t i = 0; i < problem.views.list.size(); ++i) {
    if (!problem.views.list[i].file.empty()) continue;
    return KeyFailure(problem, "views[" + std::to_string(i) + "].file",
                      "expected the view's image, found nothing");
  }
  return OkStatus();
}

// Labelled materials have labels, of all views where there are several.
Status CheckLabels(const Problem& problem) {
  if (problem.reflectance.variation != ReflectanceVariation::kLabels ||
      problem.reflectance.finds_labels()) {
    return OkStatus();
  }
  if (!problem.SeveralViews()) {
    if (!problem.reflectance.labels.empty()) return OkStatus();
    return KeyFailure(
        problem, "reflectance.labels",
        "expected this key with variation: labels, found nothing");
  }
  if (!problem.reflectance.labels.empty() || problem.views.list.empty()) {
    return KeyFailure(
        problem, "reflectance.labels",
        "expected auto, or labels of each view in a list of views");
  }
  for (size_t i = 0; i < problem.views.list.size(); ++i) {
    if (!problem.views.list[i].labels.empty()) continue;
    return KeyFailure(problem, "views[" + std::to_string(i) + "].labels",
                      "expected labels as of the other views, found nothing");
  }
  return OkStatus();
}

Status CheckSolvableImage(const Problem& problem) {
  if (problem.SeveralViews()) return CheckViewImages(problem);
  if (problem.image.file.empty()) {
    return KeyFailure(problem, "image.file",
                      "expected the image to be explained");
  }
  if (problem.image.brackets.size() != problem.image.bracket_exposures.size()) {
    return KeyFailure(
        problem, "image.bracket_exposures",
        "expected one for each of image.brackets, " +
            std::to_string(problem.image.brackets.size()) + ", found " +
            std::to_string(problem.image.bracket_exposures.size()));
  }
  return OkStatus();
}

Status CheckProcessSize(const Problem& problem) {
  const IlluminationSpec& light = problem.illumination;
  if (!light.known() && light.prior == IlluminationPrior::kProcess) {
    for (const auto& [key, side] :
         {std::pair("width", light.width), std::pair("height", light.height)}) {
      if (side <= kMaxProcessSide) continue;
      return KeyFailure(problem, std::string("illumination.") + key,
                        "expected at most " + std::to_string(kMaxProcessSide) +
                            " with illumination.prior: process, found " +
                            std::to_string(side));
    }
  }
  return OkStatus();
}

Status CheckSolvableReflectance(const Problem& problem) {
  const ReflectanceSpec& reflectance = problem.reflectance;
  const auto fail = [&](const std::string& key, const std::string& what) {
    return InvalidInput(problem.path + ": reflectance.known" + key, what);
  };
  const bool known = problem.kind == ProblemKind::kIllumination;
  if (reflectance.known() != known) {
    return fail("", known ? "expected with problem: illumination, found nothing"
                          : "expected with problem: illumination only");
  }
  if (reflectance.paint.has_value()) {
    return fail(".albedo", "expected in a render alone");
  }
  if (reflectance.principled.has_value() &&
      reflectance.principled->textured()) {
    return fail(".principled",
                "expected numbers: textures are ibrdf_render's alone");
  }
  return OkStatus();
}

}  // namespace

Status CheckSolvable(const Problem& problem) {
  IBRDF_RETURN_IF_ERROR(CheckNotTextures(problem));
  IBRDF_RETURN_IF_ERROR(CheckSolvableImage(problem));
  IBRDF_RETURN_IF_ERROR(CheckLabels(problem));
  for (const Effect approximation : {Effect::kHarmonics, Effect::kGaussians}) {
    if (problem.effects.Lists(approximation)) {
      return KeyFailure(
          problem, "effects",
          std::string(EffectName(approximation)) + " are ibrdf_render's alone");
    }
  }
  IBRDF_RETURN_IF_ERROR(CheckProcessSize(problem));
  IBRDF_RETURN_IF_ERROR(CheckSolvableReflectance(problem));
  const bool illumination_known = problem.kind == ProblemKind::kReflectance;
  if (problem.illumination.known() != illumination_known) {
    return KeyFailure(problem, "illumination.known",
                      illumination_known
                          ? "expected with problem: reflectance, found nothing"
                          : "expected with problem: reflectance only");
  }
  return OkStatus();
}

Status CheckTextures(const Problem& problem) {
  if (problem.kind != ProblemKind::kTextures) {
    return KeyFailure(
        problem, "problem",
        "expected textures, found " + WordOf("problem", problem.kind));
  }
  if (!problem.views.given()) {
    return KeyFailure(problem, "views",
                      "expected with problem: textures, found nothing");
  }
  IBRDF_RETURN_IF_ERROR(CheckViewImages(problem));
  if (problem.image.response >= ResponseChoice::kUnknown) {
    return KeyFailure(problem, "image.response", "expected a known curve");
  }
  if (problem.geometry.HasNormalMap() || problem.geometry.outline.has_value()) {
    return KeyFailure(problem, "geometry",
                      "expected a mesh, or sphere: {}, with problem: textures");
  }
  if (problem.reflectance.known()) {
    return KeyFailure(problem, "reflectance.known",
                      "expected without problem: textures");
  }
  if (!problem.illumination.known()) {
    return KeyFailure(problem, "illumination.known",
                      "expected with problem: textures, found nothing");
  }
  return OkStatus();
}

Status CheckRenderable(const Problem& problem) {
  IBRDF_RETURN_IF_ERROR(CheckNotTextures(problem));
  if (problem.image.width <= 0 || problem.image.height <= 0) {
    return KeyFailure(problem, "image",
                      "expected width and height of the image to render");
  }
  for (const ViewSpec& view : problem.views.list) {
    if (view.file.empty()) continue;
    return KeyFailure(problem, "views",
                      "expected no files of views in a render");
  }
  if (!problem.reflectance.known()) {
    return KeyFailure(problem, "reflectance.known",
                      "expected for a render, found nothing");
  }
  if (!problem.illumination.known()) {
    return KeyFailure(problem, "illumination.known",
                      "expected for a render, found nothing");
  }
  if (problem.reflectance.principled.has_value() &&
      problem.reflectance.principled->textured() &&
      problem.geometry.HasNormalMap()) {
    return KeyFailure(
        problem, "reflectance.known.principled",
        "expected a sphere or a mesh with textures: a map of normals "
        "has no surface");
  }
  for (const Effect effect : {Effect::kHarmonics, Effect::kGaussians}) {
    if (problem.reflectance.principled.has_value() &&
        problem.reflectance.principled->textured() &&
        problem.effects.Lists(effect)) {
      return KeyFailure(
          problem, "effects",
          std::string("expected no ") + EffectName(effect) + " with textures");
    }
  }
  if (problem.reflectance.paint.has_value() && problem.SeveralViews()) {
    return KeyFailure(problem, "reflectance.known.albedo",
                      "expected without several views: it is an image of one");
  }
  return OkStatus();
}

}  // namespace ibrdf
