#include "ibrdf/io/problem_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem_reader.h"
#include "ibrdf/io/renamed_keys.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;
using Strings = std::vector<std::string>;

constexpr size_t kMaxFileBytes = size_t{1} << 20;

// The views of textures have the files.
void ReadImageSpec(ProblemReader reader, ProblemKind kind, ImageSpec* image) {
  reader.Read("file", &image->file);
  reader.Read("mask", &image->mask);
  reader.Read("layer", &image->layer);
  reader.Read("response", &image->response);
  reader.Read("response_parameter", &image->response_parameter);
  reader.Read("white", &image->white);
  reader.Read("black", &image->black);
  reader.Read("exposure", &image->exposure);
  reader.Read("brackets", &image->brackets);
  reader.Read("bracket_exposures", &image->bracket_exposures);
  reader.Read("width", &image->width);
  reader.Read("height", &image->height);
  const bool sized = reader.Has("width") || reader.Has("height");
  if (kind == ProblemKind::kTextures && !reader.Has("file") && !sized) return;
  if (reader.Has("file") == sized) {
    reader.Fail(reader.Has("file")
                    ? "expected either file or width and height, found both"
                    : "expected file or width and height");
  } else if (reader.Has("width") != reader.Has("height")) {
    reader.Fail("expected both width and height");
  } else if (int64_t{image->width} * image->height > kMaxImagePixels) {
    reader.Fail("expected at most " + std::to_string(kMaxImagePixels) +
                " pixels");
  }
}

void ReadPose(ProblemReader* reader, Camera* camera) {
  const char* const name = "world_from_camera";
  std::optional<Eigen::Matrix4d>& pose = camera->world_from_camera;
  reader->Read(name, &pose);
  if (!reader->Has(name)) return;
  for (const char* key : {"from", "to", "up"}) {
    if (reader->Has(key)) reader->Fail(key, "expected without a pose");
  }
  if (!pose.has_value()) return;
  const std::string fault = PoseFault(*pose);
  if (fault.empty()) {
    pose = NearestPose(*pose);
  } else {
    reader->Fail(name, fault);
  }
}

void ReadLens(ProblemReader* reader, Camera* camera) {
  reader->Read("fov_degrees", &camera->fov_degrees);
  reader->Read("focal_pixels", &camera->focal_pixels);
  reader->Read("centre_pixels", &camera->centre_pixels);
  if (reader->Has("focal_pixels") && reader->Has("fov_degrees")) {
    reader->Fail("fov_degrees", "expected without focal_pixels");
  }
}

void ReadCamera(ProblemReader reader, Camera* camera) {
  reader.Read("type", &camera->type);
  const bool perspective = camera->type == CameraType::kPerspective;
  for (const char* key :
       {"fov_degrees", "from", "to", "up", "focal_pixels", "centre_pixels"}) {
    reader.CheckNeeds(key, perspective);
  }
  ReadPose(&reader, camera);
  if (!perspective) return;
  ReadLens(&reader, camera);
  reader.Read("from", &camera->from);
  reader.Read("to", &camera->to);
  reader.Read("up", &camera->up);
  if (!IsValidCamera(*camera)) {
    reader.Fail(
        "expected `from` apart from `to` and `up` not parallel to the view");
  }
}

// One of a list.
void ReadView(const ProblemReader& root, const std::string& shown,
              const ConfigNode& node, ProblemKind kind,
              std::vector<ViewSpec>* views) {
  ConfigReader reader =
      root.Other(shown, node, {"name", "camera", "file", "mask"});
  ViewSpec view;
  reader.Text("name", &view.name);
  if (!reader.Has("name")) reader.FailExpected("name", "the view's name");
  const std::string fault = ViewNameFault(view.name);
  if (!fault.empty()) reader.Fail("name", fault);
  for (const ViewSpec& other : *views) {
    if (other.name != view.name) continue;
    reader.Fail("name", "expected a name that no other view has");
  }
  ReadCamera(root.Like("camera", shown + ".camera", reader.Find("camera")),
             &view.camera);
  reader.Path("file", &view.file);
  reader.Path("mask", &view.mask);
  for (const char* key : {"file", "mask"}) {
    if (kind == ProblemKind::kTextures || !reader.Has(key)) continue;
    reader.Fail(key, "expected with problem: textures only");
  }
  views->push_back(view);
}

void ReadViews(ProblemReader* root, ProblemKind kind, ViewsSpec* views) {
  const ConfigNode* node = root->Find("views");
  if (node == nullptr) return;
  if (root->Has("camera")) {
    root->Fail("views", "expected without camera");
  }
  if (node->kind == Kind::kList) {
    if (node->items.empty() || node->items.size() > kMaxViews) {
      root->FailExpected(
          "views", "a list of 1 to " + std::to_string(kMaxViews) + " views");
      return;
    }
    for (size_t i = 0; i < node->items.size(); ++i) {
      ReadView(*root, "views[" + std::to_string(i) + "]", node->items[i], kind,
               &views->list);
    }
    return;
  }
  ProblemReader reader = root->Below("views");
  for (const char* key : {"images", "masks"}) {
    reader.CheckNeeds(key, kind == ProblemKind::kTextures);
  }
  reader.Read("transforms", &views->transforms);
  reader.Read("colmap", &views->colmap);
  reader.Read("images", &views->images);
  reader.Read("masks", &views->masks);
  if (reader.Has("transforms") == reader.Has("colmap")) {
    reader.Fail("expected a list, or one of transforms and colmap");
  }
}

void ReadSphere(ProblemReader reader, GeometrySpec* geometry) {
  if (!reader.Has("centre") && !reader.Has("radius")) return;
  if (!reader.Has("centre") || !reader.Has("radius")) {
    reader.Fail("expected both centre and radius, or {}");
    return;
  }
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  PixelCircle outline;
  reader.Read("centre", &centre);
  reader.Read("radius", &outline.radius);
  outline.x = centre.x();
  outline.y = centre.y();
  geometry->outline = outline;
}

void ReadFrame(ProblemReader* geometry, NormalFrame* frame) {
  const ConfigNode* node = geometry->Find("frame");
  if (node == nullptr) return;
  if (node->kind != Kind::kMap) {
    int word = 0;
    geometry->ReadChoice("frame", &word);
    *frame = word == 0 ? kOpenGlFrame : kOpenCvFrame;
    return;
  }
  ProblemReader reader = geometry->Below("frame");
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (size_t k = 0; k < 3; ++k) reader.Read(kNames[k], &(*frame)[k]);
  // Words of one axis of the picture are neighbours.
  const auto axis = [&](size_t k) { return static_cast<int>((*frame)[k]) / 2; };
  for (size_t k = 1; k < 3; ++k) {
    for (size_t other = 0; other < k; ++other) {
      if (axis(k) != axis(other)) continue;
      reader.Fail(kNames[k],
                  "expected another axis of the picture than that of " +
                      std::string(kNames[other]) +
                      ": one of left and right, of up and down, of toward "
                      "and away");
    }
  }
}

void ReadDepth(ProblemReader* reader, bool perspective,
               GeometrySpec* geometry) {
  reader->Read("depth", &geometry->file);
  reader->Read("depth_scale", &geometry->depth_scale);
  const double scale = geometry->depth_scale.value_or(1.0);
  if (scale == 0.0) {
    reader->FailExpected("depth_scale", "a number other than 0");
  } else if (scale < 0.0 && perspective) {
    reader->FailExpected("depth_scale",
                         "a number > 0 with camera.type: perspective");
  }
}

void ReadShape(ProblemReader* reader, bool perspective,
               GeometrySpec* geometry) {
  if (reader->Has("sphere")) {
    ReadSphere(reader->Below("sphere"), geometry);
    if (geometry->outline.has_value() && perspective) {
      reader->Fail("sphere",
                   "expected {} with camera.type: perspective: centre and "
                   "radius are of an orthographic picture");
    }
  } else if (reader->Has("mesh")) {
    geometry->kind = GeometryKind::kMesh;
    reader->Read("mesh", &geometry->file);
  } else if (reader->Has("normals")) {
    geometry->kind = GeometryKind::kNormals;
    reader->Read("normals", &geometry->file);
  } else {
    geometry->kind = GeometryKind::kDepth;
    ReadDepth(reader, perspective, geometry);
  }
}

// One picture's geometry.
void CheckOneView(ProblemReader* reader, const ViewsSpec& views,
                  const GeometrySpec& geometry) {
  if (!views.given() || views.list.size() == 1) return;
  if (geometry.HasNormalMap()) {
    reader->Fail("expected a sphere or a mesh with several views: a map of " +
                 std::string(geometry.kind == GeometryKind::kDepth
                                 ? "depth"
                                 : "normals") +
                 " is of one");
  } else if (geometry.outline.has_value()) {
    reader->Fail("sphere",
                 "expected {} with several views: centre and radius are of "
                 "one picture");
  }
}

void ReadGeometry(ProblemReader reader, bool perspective,
                  const ViewsSpec& views, GeometrySpec* geometry) {
  int found = 0;
  for (const char* key : {"sphere", "mesh", "normals", "depth"}) {
    found += reader.Has(key);
  }
  if (found != 1) {
    reader.Fail("expected one of sphere, mesh, normals and depth, found " +
                std::to_string(found));
    return;
  }
  reader.CheckNeeds("fit", reader.Has("mesh"));
  reader.CheckNeeds("depth_scale", reader.Has("depth"));
  for (const char* key : {"frame", "encoding"}) {
    reader.CheckNeeds(key, reader.Has("normals"));
  }
  ReadShape(&reader, perspective, geometry);
  if (views.given() && reader.Has("mesh")) geometry->fit = MeshFit::kNone;
  reader.Read("fit", &geometry->fit);
  geometry->fit_stated = reader.Has("fit");
  CheckOneView(&reader, views, *geometry);
  ReadFrame(&reader, &geometry->frame);
  reader.Read("encoding", &geometry->encoding);
}

// Maps of normals and depth are in the camera's frame.
void CheckCameraStays(ProblemReader camera, const GeometrySpec& geometry) {
  if (!geometry.HasNormalMap()) return;
  const bool depth = geometry.kind == GeometryKind::kDepth;
  for (const char* key : {"from", "to", "up", "world_from_camera"}) {
    if (!camera.Has(key)) continue;
    camera.Fail(key, std::string("expected without geometry.") +
                         (depth ? "depth" : "normals") +
                         ", which is in the camera's frame");
  }
}

void ReadPaint(ProblemReader* reader, std::optional<PaintSpec>* paint) {
  reader->CheckNeeds("unpainted_albedo", reader->Has("albedo"));
  if (!reader->Has("albedo")) return;
  paint->emplace();
  reader->Read("albedo", &(*paint)->albedo);
  if (!reader->Has("unpainted_albedo")) return;
  (*paint)->unpainted_albedo.reset();
  reader->Read("unpainted_albedo", &(*paint)->unpainted_albedo);
}

void ReadPrincipled(ProblemReader reader, PrincipledSpec* principled) {
  reader.Read("base", &principled->base);
  reader.Read("roughness", &principled->roughness);
  reader.Read("metallic", &principled->metallic);
  reader.Read("specular", &principled->specular);
}

void ReadKnownBrdf(ProblemReader reader, ReflectanceSpec* reflectance) {
  ReadPaint(&reader, &reflectance->paint);
  if (reader.Has("brdf") + reader.Has("lambertian") +
          reader.Has("cook_torrance") + reader.Has("principled") !=
      1) {
    reader.Fail(
        "expected a file or one of brdf, lambertian, cook_torrance and "
        "principled");
    return;
  }
  if (reader.Has("principled")) {
    reflectance->principled.emplace();
    ReadPrincipled(reader.Below("principled"), &*reflectance->principled);
    if (reflectance->principled->textured() && reader.Has("albedo")) {
      reader.Fail("albedo", "expected without textures");
    }
    return;
  }
  if (reader.Has("brdf")) {
    reader.Read("brdf", &reflectance->known_file);
    return;
  }
  CookTorrance brdf;
  if (reader.Has("lambertian")) {
    brdf.specular.setZero();
    reader.Read("lambertian", &brdf.diffuse);
  } else {
    ProblemReader lobe = reader.Below("cook_torrance");
    lobe.Read("diffuse", &brdf.diffuse);
    lobe.Read("specular", &brdf.specular);
    lobe.Read("roughness", &brdf.roughness);
    lobe.Read("f0", &brdf.f0);
  }
  reflectance->analytic = brdf;
}

void ReadVariation(ProblemReader* reader, ReflectanceSpec* reflectance) {
  ReflectanceVariation& variation = reflectance->variation;
  reader->Read("variation", &variation);
  reader->Read("labels", &reflectance->labels);
  if (!reader->Has("labels")) return;
  if (variation == ReflectanceVariation::kAuto) {
    variation = ReflectanceVariation::kLabels;
  }
  if (variation != ReflectanceVariation::kLabels) {
    reader->Fail("labels", std::string("expected without variation: ") +
                               ReflectanceVariationName(variation));
  }
  if (reader->Has("known")) {
    reader->Fail("labels", "expected without reflectance.known");
  }
}

void ReadReflectance(ProblemReader reader, ReflectanceSpec* reflectance) {
  reader.Read("model", &reflectance->model);
  reader.Read("lobes", &reflectance->lobes);
  reader.Read("prior_sigma", &reflectance->prior_sigma);
  ReadVariation(&reader, reflectance);
  const ConfigNode* known = reader.Find("known");
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    ReadKnownBrdf(reader.Below("known"), reflectance);
  } else {
    reader.Read("known", &reflectance->known_file);
  }
}

void ReadSky(ProblemReader known, SkyOptions* sky) {
  if (!known.Has("sky")) {
    known.Fail("expected a file or sky");
    return;
  }
  ProblemReader reader = known.Below("sky");
  reader.Read("sun_theta_degrees", &sky->sun_theta_degrees);
  reader.Read("sun_phi_degrees", &sky->sun_phi_degrees);
  reader.Read("sun_radius_degrees", &sky->sun_radius_degrees);
  reader.Read("sun_irradiance", &sky->sun_irradiance);
  reader.Read("zenith_radiance", &sky->zenith_radiance);
  reader.Read("haze", &sky->haze);
  reader.Read("clouds", &sky->clouds);
  reader.Read("skyline", &sky->skyline);
  reader.Read("ground_albedo", &sky->ground_albedo);
}

// One side given: the map stays twice as wide as high.
void ReadMapSize(ProblemReader* reader, IlluminationSpec* illumination) {
  reader->Read("width", &illumination->width);
  illumination->sized = reader->Has("width") || reader->Has("height");
  if (reader->Has("width") && !reader->Has("height")) {
    illumination->height = illumination->width / 2;
  }
  reader->Read("height", &illumination->height);
  if (reader->Has("height") && !reader->Has("width")) {
    const int most = static_cast<int>(reader->Key("width").most);
    illumination->width = std::min(2 * illumination->height, most);
  }
  if (illumination->width % 2 != 0) {
    reader->FailExpected("width", "an even number");
  }
}

void ReadIllumination(ProblemReader reader, IlluminationSpec* illumination) {
  ReadMapSize(&reader, illumination);
  illumination->prior = IlluminationPrior::kAuto;
  reader.Read("prior", &illumination->prior);
  if (illumination->prior == IlluminationPrior::kAuto &&
      reader.Has("unet_channels")) {
    illumination->prior = IlluminationPrior::kUNet;
  }
  reader.Read("unet_channels", &illumination->unet_channels);
  reader.CheckNeeds("unet_channels",
                    illumination->prior == IlluminationPrior::kUNet);
  reader.Read("frame", &illumination->frame);
  reader.Read("output_frame", &illumination->output_frame);
  const ConfigNode* known = reader.Find("known");
  reader.CheckNeeds("frame", known != nullptr);
  reader.Read("ambient", &illumination->ambient);
  reader.CheckNeeds("ambient", known != nullptr);
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    if (reader.Has("frame")) {
      reader.Fail("frame", "expected with the file of a known map only");
    }
    illumination->sky.emplace();
    ReadSky(reader.Below("known"), &*illumination->sky);
  } else {
    reader.Read("known", &illumination->known_file);
  }
}

void ReadLikelihood(ProblemReader reader, LikelihoodSpec* likelihood) {
  reader.Read("scale", &likelihood->scale);
  reader.Read("epsilon", &likelihood->epsilon);
}

// Adds the effect that `item`, of the list or in its place, names.
void AddEffect(const ConfigNode& item, ProblemReader* root,
               EffectsSpec* effects) {
  const ProblemKey& key = root->Key("effects");
  const Strings names = key.ListWords();
  const auto name = std::find(names.begin(), names.end(), item.scalar);
  if (item.kind != Kind::kScalar || name == names.end()) {
    Strings expected = key.Words();
    expected.push_back("a list of " + JoinWords(names));
    root->Fail(
        "effects",
        "expected " + JoinWords(expected) + ", found " + Describe(item) +
            (item.kind == Kind::kScalar ? "; the nearest known one is " +
                                              NearestWord(item.scalar, names)
                                        : ""));
    return;
  }
  const auto effect = static_cast<Effect>(name - names.begin());
  if (effects->Lists(effect)) {
    root->Fail("effects", *name + " is listed twice");
  } else {
    effects->list.push_back(effect);
  }
}

void CheckEffects(const EffectsSpec& effects, ProblemReader* root) {
  for (const Effect approximation : {Effect::kHarmonics, Effect::kGaussians}) {
    for (const Effect shadow :
         {Effect::kVisibility, Effect::kInterreflection}) {
      if (!effects.Lists(approximation) || !effects.Lists(shadow)) continue;
      root->Fail("effects",
                 std::string("expected ") + EffectName(approximation) + " or " +
                     EffectName(shadow) + ", found both: " +
                     EffectName(approximation) + " knows no shadows");
      return;
    }
  }
}

void ReadEffects(ProblemReader* root, EffectsSpec* effects) {
  const ConfigNode* node = root->Find("effects");
  if (node == nullptr) return;
  if (node->kind == Kind::kList) {
    effects->mode = EffectsMode::kList;
    for (const ConfigNode& item : node->items) AddEffect(item, root, effects);
    CheckEffects(*effects, root);
    return;
  }
  const Strings modes = root->Key("effects").Words();
  const auto mode = std::find(modes.begin(), modes.end(), node->scalar);
  if (node->kind == Kind::kScalar && mode != modes.end()) {
    effects->mode = static_cast<EffectsMode>(mode - modes.begin());
    return;
  }
  effects->mode = EffectsMode::kList;
  AddEffect(*node, root, effects);
}

void ReadSolver(ProblemReader reader, ProblemKind kind, SolverSpec* solver) {
  reader.Read("estimator", &solver->estimator);
  reader.Read("method", &solver->method);
  reader.Read("quadrature", &solver->quadrature);
  reader.Read("gauge", &solver->gauge);
  reader.CheckNeeds("gauge", kind == ProblemKind::kJoint);
  reader.Read("seconds", &solver->seconds);
  reader.Read("tolerance", &solver->tolerance);
  reader.Read("max_iterations", &solver->max_iterations);
  reader.Read("seed", &solver->seed);
}

void ReadTruth(ProblemReader reader, TruthSpec* truth) {
  reader.Read("brdf", &truth->brdf);
  reader.Read("illumination", &truth->illumination);
  reader.Read("frame", &truth->frame);
  reader.CheckNeeds("frame", reader.Has("illumination"));
}

void ReadTexture(ProblemReader reader, ProblemKind kind, TextureSpec* texture) {
  for (const char* key : {"width", "height"}) {
    reader.CheckNeeds(key, kind == ProblemKind::kTextures);
  }
  reader.Read("width", &texture->width);
  reader.Read("height", &texture->height);
}

void ReadUncertainty(ProblemReader reader, ProblemKind kind,
                     UncertaintySpec* uncertainty) {
  for (const char* key : {"evaluator", "order", "sigma", "shadows"}) {
    reader.CheckNeeds(key, kind == ProblemKind::kTextures);
  }
  reader.Read("evaluator", &uncertainty->evaluator);
  reader.Read("order", &uncertainty->order);
  reader.Read("sigma", &uncertainty->sigma);
  reader.Read("shadows", &uncertainty->shadows);
}

// What `auto` stands for.
void SettlePrior(const SolverSpec& solver, IlluminationSpec* illumination) {
  if (illumination->prior != IlluminationPrior::kAuto) return;
  const bool large =
      std::max(illumination->width, illumination->height) > kMaxProcessSide;
  const bool network = large || solver.estimator == SolverEstimator::kMaximum;
  illumination->prior = network && !illumination->known()
                            ? IlluminationPrior::kUNet
                            : IlluminationPrior::kProcess;
}

// The first error is the context's.
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
  if (problem->solver.estimator == SolverEstimator::kMaximum) {
    ReflectanceVariation& variation = problem->reflectance.variation;
    if (variation == ReflectanceVariation::kAlbedo) {
      root.Below("reflectance")
          .Fail("variation", "expected none with solver.estimator: maximum");
    } else if (variation == ReflectanceVariation::kLabels) {
      root.Below("reflectance")
          .Fail("labels", "expected without solver.estimator: maximum");
    }
    variation = ReflectanceVariation::kNone;
  }
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

std::vector<NamedFile> NamedFiles(const Problem& problem) {
  constexpr std::array<const char*, 4> kShapes = {
      "geometry.sphere", "geometry.mesh", "geometry.normals", "geometry.depth"};
  std::vector<NamedFile> files = {
      {"problem", problem.path},
      {"image.file", problem.image.file},
      {"image.mask", problem.image.mask},
      {"reflectance.labels", problem.reflectance.labels},
      {kShapes[static_cast<size_t>(problem.geometry.kind)],
       problem.geometry.file},
      {"reflectance.model", problem.reflectance.model},
      {"reflectance.known", problem.reflectance.known_file},
      {"reflectance.known.albedo", problem.reflectance.paint.has_value()
                                       ? problem.reflectance.paint->albedo
                                       : ""},
      {"illumination.known", problem.illumination.known_file},
      {"views.transforms", problem.views.transforms},
      {"views.colmap", problem.views.colmap},
      {"truth.brdf", problem.truth.brdf},
      {"truth.illumination", problem.truth.illumination}};
  if (problem.reflectance.principled.has_value()) {
    const PrincipledSpec& values = *problem.reflectance.principled;
    const std::string key = "reflectance.known.principled.";
    files.push_back({key + "base", values.base.texture});
    files.push_back({key + "roughness", values.roughness.texture});
    files.push_back({key + "metallic", values.metallic.texture});
    files.push_back({key + "specular", values.specular.texture});
  }
  for (const std::string& bracket : problem.image.brackets) {
    files.push_back({"image.brackets", bracket});
  }
  const std::vector<ViewSpec>& list = problem.views.list;
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string key = "views[" + std::to_string(i) + "].";
    files.push_back({key + "file", list[i].file});
    files.push_back({key + "mask", list[i].mask});
  }
  files.erase(std::remove_if(files.begin(), files.end(),
                             [](const NamedFile& f) { return f.path.empty(); }),
              files.end());
  return files;
}

namespace {

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

// Textures are another program's.
Status CheckNotTextures(const Problem& problem) {
  if (problem.kind != ProblemKind::kTextures) return OkStatus();
  return InvalidInput(problem.path + ": problem",
                      "textures are ibrdf_uncertainty's alone");
}

}  // namespace

Status CheckSolvable(const Problem& problem) {
  IBRDF_RETURN_IF_ERROR(CheckNotTextures(problem));
  const auto fail = [&](const std::string& key, const std::string& what) {
    return InvalidInput(problem.path + ": " + key, what);
  };
  if (problem.image.file.empty()) {
    return fail("image.file", "expected the image to be explained");
  }
  if (problem.views.given() && problem.views.list.size() != 1) {
    return fail("views",
                "expected one view: a solve of several is not there yet");
  }
  if (problem.image.brackets.size() != problem.image.bracket_exposures.size()) {
    return fail("image.bracket_exposures",
                "expected one for each of image.brackets, " +
                    std::to_string(problem.image.brackets.size()) + ", found " +
                    std::to_string(problem.image.bracket_exposures.size()));
  }
  if (problem.reflectance.variation == ReflectanceVariation::kLabels &&
      problem.reflectance.labels.empty()) {
    return fail("reflectance.labels",
                "expected this key with variation: labels, found nothing");
  }
  for (const Effect approximation : {Effect::kHarmonics, Effect::kGaussians}) {
    if (problem.effects.Lists(approximation)) {
      return fail("effects", std::string(EffectName(approximation)) +
                                 " are ibrdf_render's alone");
    }
  }
  const IlluminationSpec& light = problem.illumination;
  if (!light.known() && light.prior == IlluminationPrior::kProcess) {
    for (const auto& [key, side] :
         {std::pair("width", light.width), std::pair("height", light.height)}) {
      if (side <= kMaxProcessSide) continue;
      return fail(std::string("illumination.") + key,
                  "expected at most " + std::to_string(kMaxProcessSide) +
                      " with illumination.prior: process, found " +
                      std::to_string(side));
    }
  }
  IBRDF_RETURN_IF_ERROR(CheckSolvableReflectance(problem));
  const bool illumination_known = problem.kind == ProblemKind::kReflectance;
  if (problem.illumination.known() != illumination_known) {
    return fail("illumination.known",
                illumination_known
                    ? "expected with problem: reflectance, found nothing"
                    : "expected with problem: reflectance only");
  }
  return OkStatus();
}

Status CheckTextures(const Problem& problem) {
  const auto fail = [&](const std::string& key, const std::string& what) {
    return InvalidInput(problem.path + ": " + key, what);
  };
  if (problem.kind != ProblemKind::kTextures) {
    return fail("problem",
                "expected textures, found " + WordOf("problem", problem.kind));
  }
  if (!problem.views.given()) {
    return fail("views", "expected with problem: textures, found nothing");
  }
  const ImageSpec& image = problem.image;
  if (!image.file.empty() || !image.mask.empty() || image.width > 0 ||
      !image.brackets.empty()) {
    return fail("image",
                "expected no file, mask, size or brackets beside views: each "
                "view has its file");
  }
  if (image.response >= ResponseChoice::kUnknown) {
    return fail("image.response", "expected a known curve");
  }
  for (size_t i = 0; i < problem.views.list.size(); ++i) {
    if (!problem.views.list[i].file.empty()) continue;
    return fail("views[" + std::to_string(i) + "].file",
                "expected the view's image, found nothing");
  }
  if (problem.geometry.HasNormalMap() || problem.geometry.outline.has_value()) {
    return fail("geometry",
                "expected a mesh, or sphere: {}, with problem: textures");
  }
  if (problem.reflectance.known()) {
    return fail("reflectance.known", "expected without problem: textures");
  }
  if (!problem.illumination.known()) {
    return fail("illumination.known",
                "expected with problem: textures, found nothing");
  }
  return OkStatus();
}

Status CheckRenderable(const Problem& problem) {
  IBRDF_RETURN_IF_ERROR(CheckNotTextures(problem));
  const auto fail = [&](const std::string& key, const std::string& what) {
    return InvalidInput(problem.path + ": " + key, what);
  };
  if (problem.image.width <= 0 || problem.image.height <= 0) {
    return fail("image", "expected width and height of the image to render");
  }
  if (!problem.reflectance.known()) {
    return fail("reflectance.known", "expected for a render, found nothing");
  }
  if (!problem.illumination.known()) {
    return fail("illumination.known", "expected for a render, found nothing");
  }
  if (problem.reflectance.principled.has_value() &&
      problem.reflectance.principled->textured() &&
      problem.geometry.HasNormalMap()) {
    return fail("reflectance.known.principled",
                "expected a sphere or a mesh with textures: a map of normals "
                "has no surface");
  }
  for (const Effect effect : {Effect::kHarmonics, Effect::kGaussians}) {
    if (problem.reflectance.principled.has_value() &&
        problem.reflectance.principled->textured() &&
        problem.effects.Lists(effect)) {
      return fail("effects", std::string("expected no ") + EffectName(effect) +
                                 " with textures");
    }
  }
  if (problem.reflectance.paint.has_value() && problem.views.given() &&
      problem.views.list.size() != 1) {
    return fail("reflectance.known.albedo",
                "expected without several views: it is an image of one");
  }
  return OkStatus();
}

}  // namespace ibrdf
