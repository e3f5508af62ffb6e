#include "ibrdf/io/problem_file.h"

#include <filesystem>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/problem_reader.h"
#include "ibrdf/io/problem_section_readers.h"
#include "ibrdf/io/renamed_keys.h"

namespace ibrdf {
namespace {

constexpr size_t kMaxFileBytes = size_t{1} << 20;

// The context keeps the first error, so the order of the sections is that of
// the messages.
void ReadKeys(ProblemReader root, Problem* problem) {
  root.Read("problem", &problem->kind);
  for (const char* key : {"image", "geometry"}) {
    // CheckTextures says what textures need in the image's place.
    const bool needed =
        problem->kind != ProblemKind::kTextures || std::string(key) != "image";
    if (!needed || root.Has(key)) continue;
    root.Fail(key, "expected this key, found nothing");
  }
  ReadImageSpec(root.Below("image"), problem->kind, &problem->image);
  ReadCamera(root.Below("camera"), &problem->camera);
  ReadViews(&root, problem->kind, &problem->views);
  const std::vector<ViewSpec>& list = problem->views.list;
  if (list.size() == 1) problem->camera = list[0].camera;
  ReadGeometry(root.Below("geometry"),
               problem->camera.type == CameraType::kPerspective, problem->views,
               &problem->geometry);
  problem->camera_placed = problem->camera.world_from_camera.has_value() ||
                           root.Below("camera").Has("from") ||
                           root.Below("camera").Has("to");
  CheckCameraStays(root.Below("camera"), problem->geometry);
  ReadReflectance(root.Below("reflectance"), &problem->reflectance);
  ReadIllumination(root.Below("illumination"), &problem->illumination);
  ReadLikelihood(root.Below("likelihood"), &problem->likelihood);
  ReadEffects(&root, &problem->effects);
  ReadSolver(root.Below("solver"), problem->kind, &problem->solver);
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
