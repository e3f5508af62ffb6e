#include "ibrdf/io/problem_file.h"

#include <filesystem>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/problem_reader.h"
#include "ibrdf/io/problem_section_readers.h"
#include "ibrdf/io/renamed_keys.h"

namespace ibrdf {
namespace {

constexpr size_t kMaxFileBytes = size_t{1} << 20;

// One view of a list is the problem's image and camera.
void TakeOneView(ProblemReader* root, Problem* problem) {
  if (problem->views.list.size() != 1) return;
  const ViewSpec& view = problem->views.list[0];
  problem->camera = view.camera;
  if (view.file.empty() || problem->kind == ProblemKind::kTextures) return;
  ImageSpec* const image = &problem->image;
  if (!image->file.empty() || !image->mask.empty() || image->width > 0) {
    root->Fail("image",
               "expected no file, mask or size beside the view's own file");
    return;
  }
  image->file = view.file;
  image->mask = view.mask;
  image->exposure = view.exposure.value_or(image->exposure);
}

void TurnCameras(const Eigen::Matrix3d& rotation, Problem* problem) {
  problem->camera = Turned(problem->camera, rotation);
  for (ViewSpec& view : problem->views.list) {
    view.camera = Turned(view.camera, rotation);
  }
}

// Labels of views are those of the reflectance, and ask for it.
void TakeLabelsOfViews(const ViewsSpec& views, ProblemReader reader,
                       ReflectanceSpec* reflectance) {
  for (const ViewSpec& view : views.list) {
    if (view.labels.empty()) continue;
    if (!reflectance->labels.empty()) {
      reader.Fail("labels", "expected without labels of the views");
    } else if (reflectance->known()) {
      reader.Fail("known", "expected without labels of the views");
    } else if (reflectance->variation != ReflectanceVariation::kAuto &&
               reflectance->variation != ReflectanceVariation::kLabels) {
      reader.Fail("variation", "expected labels with labels of the views");
    }
    reflectance->variation = ReflectanceVariation::kLabels;
    if (views.list.size() == 1) reflectance->labels = view.labels;
    return;
  }
}

// The context keeps the first error, so the order of the sections is that of
// the messages.
void ReadKeys(ProblemReader root, Problem* problem) {
  root.Read("problem", &problem->kind);
  // CheckTextures says what textures need in the image's place.
  const bool others = root.Has("views") || root.Has("images") ||
                      problem->kind == ProblemKind::kTextures;
  for (const char* key : {"image", "geometry"}) {
    if (root.Has(key) || (others && std::string(key) == "image")) continue;
    root.Fail(key, "expected this key, found nothing");
  }
  ReadImageSpec(root.Below("image"), others, &problem->image);
  ReadCamera(root.Below("camera"), &problem->camera);
  ReadViews(&root, &problem->views);
  TakeOneView(&root, problem);
  ReadGeometry(root.Below("geometry"),
               problem->camera.type == CameraType::kPerspective, problem->views,
               &problem->geometry);
  problem->camera_placed = problem->camera.world_from_camera.has_value() ||
                           root.Below("camera").Has("from") ||
                           root.Below("camera").Has("to");
  CheckCameraStays(root.Below("camera"), problem->geometry);
  TurnCameras(YUpFrom(problem->geometry.up), problem);
  ReadReflectance(root.Below("reflectance"), &problem->reflectance);
  ReadIllumination(root.Below("illumination"), &problem->illumination);
  ReadLikelihood(root.Below("likelihood"), &problem->likelihood);
  ReadEffects(&root, &problem->effects);
  ReadSolver(root.Below("solver"), problem->kind, &problem->solver);
  TakeLabelsOfViews(problem->views, root.Below("reflectance"),
                    &problem->reflectance);
  ReadOtherLights(&root, problem);
  SettleVariation(problem->solver, root.Below("reflectance"),
                  &problem->reflectance);
  SettlePrior(problem->solver, &problem->illumination);
  ReadTruth(root.Below("truth"), &problem->truth);
  ReadTexture(root.Below("texture"), problem->kind, &problem->texture);
  ReadUncertainty(root.Below("uncertainty"), problem->kind,
                  &problem->uncertainty);
  root.Read("noise", &problem->noise);
  root.Read("quality", &problem->quality);
}

}  // namespace

StatusOr<Problem> ReadProblem(const std::string& path,
                              const std::vector<std::string>& overrides) {
  const StatusOr<std::string> text = ReadFile(path, kMaxFileBytes);
  if (!text.ok()) return text.status();
  return ParseProblem(path, *text, overrides);
}

StatusOr<Problem> ParseProblem(const std::string& path, const std::string& text,
                               const std::vector<std::string>& overrides,
                               const ProblemSchema& schema) {
  StatusOr<ConfigNode> tree = ParseConfig(path, text);
  if (!tree.ok()) return tree.status();
  IBRDF_RETURN_IF_ERROR(RenameOldKeys(schema, path, &*tree));
  for (const std::string& text_of_one : overrides) {
    IBRDF_RETURN_IF_ERROR(
        ApplyOverride(WithNewName(schema, path, text_of_one), &*tree));
  }
  // An override may have set a whole map.
  IBRDF_RETURN_IF_ERROR(RenameOldKeys(schema, path, &*tree));

  ConfigContext context;
  context.file = path;
  context.folder = std::filesystem::path(path).parent_path().string();
  Problem problem;
  problem.path = path;
  ReadKeys(ProblemReader(&schema, "", &*tree, &context), &problem);
  if (!context.error.ok()) return context.error;
  return problem;
}

}  // namespace ibrdf
