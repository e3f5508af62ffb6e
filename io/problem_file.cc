#include "ibrdf/io/problem_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/config_reader.h"
#include "ibrdf/io/image_limits.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;
using Strings = std::vector<std::string>;

constexpr size_t kMaxFileBytes = size_t{1} << 20;
// A map's far light and the solver's unknowns grow with these.
constexpr int kMaxMapSide = 8192;
constexpr int kMaxUnetChannels = 128;
// A draw of the light's process takes O(width height^3).
constexpr int kMaxProcessSide = 256;
constexpr int kMaxLobes = 8;
constexpr double kMaxSeconds = 1e7;

const Range kPositive{0.0, std::numeric_limits<double>::infinity(), false,
                      true};
const Range kNotNegative{0.0, std::numeric_limits<double>::infinity(), true,
                         true};
const Range kUnitInterval{0.0, 1.0, true, true};
const Range kAnyNumber{};

template <typename Enum>
void ReadChoice(ConfigReader* reader, const std::string& key,
                const Strings& words, Enum* out) {
  int index = static_cast<int>(*out);
  reader->Choice(key, words, &index);
  *out = static_cast<Enum>(index);
}

// What problem files call the values 0 to count - 1 of an enumeration.
template <typename Enum>
Strings Names(int count, const char* (*name)(Enum)) {
  Strings names;
  for (int i = 0; i < count; ++i) {
    names.emplace_back(name(static_cast<Enum>(i)));
  }
  return names;
}

void ReadAutoNumber(ConfigReader* reader, const std::string& key,
                    const Range& range, std::optional<double>* out) {
  if (!reader->Has(key) || reader->IsWord(key, "auto")) return;
  const ConfigNode* node = reader->Find(key);
  double value = 0.0;
  if (node->kind == Kind::kScalar) {
    reader->Number(key, range, &value);
    *out = value;
  } else {
    reader->FailExpected(key, "auto or a number");
  }
}

void ReadImageSpec(ConfigContext* context, const ConfigNode* node,
                   ImageSpec* image) {
  ConfigReader reader(context, node, "image",
                      {"file", "mask", "width", "height"});
  reader.Path("file", &image->file);
  reader.Path("mask", &image->mask);
  reader.Integer("width", 1, static_cast<int>(kMaxImageSide), &image->width);
  reader.Integer("height", 1, static_cast<int>(kMaxImageSide), &image->height);
  if (reader.Has("file") == (reader.Has("width") || reader.Has("height"))) {
    context->Fail("image", reader.Has("file")
                               ? "expected either file or width and height, "
                                 "found both"
                               : "expected file or width and height");
  } else if (reader.Has("width") != reader.Has("height")) {
    context->Fail("image", "expected both width and height");
  } else if (int64_t{image->width} * image->height > kMaxImagePixels) {
    context->Fail("image", "expected at most " +
                               std::to_string(kMaxImagePixels) + " pixels");
  }
}

void ReadCamera(ConfigContext* context, const ConfigNode* node,
                Camera* camera) {
  ConfigReader reader(context, node, "camera",
                      {"type", "fov_degrees", "from", "to", "up"});
  ReadChoice(&reader, "type", {"orthographic", "perspective"}, &camera->type);
  if (camera->type == CameraType::kOrthographic) {
    for (const char* key : {"fov_degrees", "from", "to", "up"}) {
      if (reader.Has(key)) {
        reader.Fail(key, "expected with camera.type: perspective only");
      }
    }
    return;
  }
  reader.Number("fov_degrees", {0.0, 180.0, false, false},
                &camera->fov_degrees);
  reader.Triple("from", kAnyNumber, false, &camera->from);
  reader.Triple("to", kAnyNumber, false, &camera->to);
  reader.Triple("up", kAnyNumber, false, &camera->up);
  if (!IsValidCamera(*camera)) {
    context->Fail("camera",
                  "expected `from` apart from `to` and `up` not parallel to "
                  "the view");
  }
}

void ReadGeometry(ConfigContext* context, const ConfigNode* node,
                  GeometrySpec* geometry) {
  ConfigReader reader(context, node, "geometry",
                      {"sphere", "mesh", "normals", "fit"});
  int found = 0;
  for (const char* key : {"sphere", "mesh", "normals"}) {
    found += reader.Has(key);
  }
  if (found != 1) {
    context->Fail("geometry",
                  "expected one of sphere, mesh and normals, "
                  "found " +
                      std::to_string(found));
    return;
  }
  if (reader.Has("sphere")) {
    const ConfigNode* sphere = reader.Find("sphere");
    if (sphere->kind != Kind::kNull &&
        !(sphere->kind == Kind::kMap && sphere->entries.empty())) {
      reader.FailExpected("sphere", "{}");
    }
  } else if (reader.Has("mesh")) {
    geometry->kind = GeometryKind::kMesh;
    reader.Path("mesh", &geometry->file);
  } else {
    geometry->kind = GeometryKind::kNormals;
    reader.Path("normals", &geometry->file);
  }
  if (reader.Has("fit") && !reader.Has("mesh")) {
    reader.Fail("fit", "expected with geometry.mesh only");
  }
  ReadChoice(&reader, "fit", {"unit_sphere", "none"}, &geometry->fit);
}

void ReadArray(ConfigReader* reader, const std::string& key, const Range& range,
               Eigen::Array3d* out) {
  Eigen::Vector3d value = out->matrix();
  reader->Triple(key, range, /*one_for_all=*/true, &value);
  *out = value.array();
}

void ReadAnalyticBrdf(ConfigContext* context, const ConfigNode* node,
                      ReflectanceSpec* reflectance) {
  ConfigReader reader(context, node, "reflectance.known",
                      {"lambertian", "cook_torrance"});
  CookTorrance brdf;
  if (reader.Has("lambertian") == reader.Has("cook_torrance")) {
    context->Fail("reflectance.known",
                  "expected a file or one of lambertian and cook_torrance");
  } else if (reader.Has("lambertian")) {
    brdf.specular.setZero();
    ReadArray(&reader, "lambertian", kUnitInterval, &brdf.diffuse);
  } else {
    ConfigReader lobe(context, reader.Find("cook_torrance"),
                      "reflectance.known.cook_torrance",
                      {"diffuse", "specular", "roughness", "f0"});
    ReadArray(&lobe, "diffuse", kUnitInterval, &brdf.diffuse);
    ReadArray(&lobe, "specular", kNotNegative, &brdf.specular);
    ReadArray(&lobe, "roughness", {1e-3, 10.0, true, true}, &brdf.roughness);
    ReadArray(&lobe, "f0", kUnitInterval, &brdf.f0);
  }
  reflectance->analytic = brdf;
}

void ReadReflectance(ConfigContext* context, const ConfigNode* node,
                     ReflectanceSpec* reflectance) {
  ConfigReader reader(context, node, "reflectance",
                      {"model", "lobes", "prior_sigma", "known"});
  if (reader.Has("model") && !reader.IsWord("model", "default")) {
    reader.Path("model", &reflectance->model);
  }
  reader.Integer("lobes", 1, kMaxLobes, &reflectance->lobes);
  reader.Number("prior_sigma", kPositive, &reflectance->prior_sigma);
  const ConfigNode* known = reader.Find("known");
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    ReadAnalyticBrdf(context, known, reflectance);
  } else {
    reader.Path("known", &reflectance->known_file);
  }
}

void ReadSky(ConfigContext* context, const ConfigNode* node, SkyOptions* sky) {
  ConfigReader known(context, node, "illumination.known", {"sky"});
  if (!known.Has("sky")) {
    context->Fail("illumination.known", "expected a file or sky");
    return;
  }
  ConfigReader reader(
      context, known.Find("sky"), "illumination.known.sky",
      {"sun_theta_degrees", "sun_phi_degrees", "sun_radius_degrees",
       "sun_irradiance", "zenith_radiance", "haze", "clouds", "skyline",
       "ground_albedo"});
  reader.Number("sun_theta_degrees", {0.0, 90.0, true, true},
                &sky->sun_theta_degrees);
  reader.Number("sun_phi_degrees", {-360.0, 360.0, true, true},
                &sky->sun_phi_degrees);
  reader.Number("sun_radius_degrees", {0.1, 30.0, true, true},
                &sky->sun_radius_degrees);
  reader.Number("sun_irradiance", kNotNegative, &sky->sun_irradiance);
  reader.Number("zenith_radiance", kPositive, &sky->zenith_radiance);
  reader.Number("haze", kUnitInterval, &sky->haze);
  reader.Number("clouds", kUnitInterval, &sky->clouds);
  reader.Number("skyline", kUnitInterval, &sky->skyline);
  reader.Number("ground_albedo", kUnitInterval, &sky->ground_albedo);
}

void ReadIllumination(ConfigContext* context, const ConfigNode* node,
                      IlluminationSpec* illumination) {
  ConfigReader reader(context, node, "illumination",
                      {"width", "height", "prior", "unet_channels", "known"});
  reader.Integer("width", 8, kMaxMapSide, &illumination->width);
  illumination->sized = reader.Has("width") || reader.Has("height");
  // One side given: the map stays twice as wide as high.
  if (reader.Has("width") && !reader.Has("height")) {
    illumination->height = illumination->width / 2;
  }
  reader.Integer("height", 4, kMaxMapSide, &illumination->height);
  if (reader.Has("height") && !reader.Has("width")) {
    illumination->width = std::min(2 * illumination->height, kMaxMapSide);
  }
  if (illumination->width % 2 != 0) {
    reader.FailExpected("width", "an even number");
  }
  ReadChoice(&reader, "prior", {"unet", "process", "none"},
             &illumination->prior);
  reader.Integer("unet_channels", 1, kMaxUnetChannels,
                 &illumination->unet_channels);
  if (reader.Has("unet_channels") &&
      illumination->prior != IlluminationPrior::kUNet) {
    reader.Fail("unet_channels", "expected with illumination.prior: unet only");
  }
  const ConfigNode* known = reader.Find("known");
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    illumination->sky.emplace();
    ReadSky(context, known, &*illumination->sky);
  } else {
    reader.Path("known", &illumination->known_file);
  }
}

void ReadEffects(ConfigContext* context, const ConfigNode* node,
                 EffectsSpec* effects) {
  if (node == nullptr) return;
  const Strings names = Names(kNumEffects, EffectName);
  const auto add = [&](const ConfigNode& item) {
    const auto name = std::find(names.begin(), names.end(), item.scalar);
    if (item.kind != Kind::kScalar || name == names.end()) {
      context->Fail(
          "effects",
          "expected auto, all, none or a list of " + JoinWords(names) +
              ", found " + Describe(item) +
              (item.kind == Kind::kScalar ? "; the nearest known one is " +
                                                NearestWord(item.scalar, names)
                                          : ""));
      return;
    }
    const auto effect = static_cast<Effect>(name - names.begin());
    if (effects->Lists(effect)) {
      context->Fail("effects", *name + " is listed twice");
    } else {
      effects->list.push_back(effect);
    }
  };
  if (node->kind == Kind::kList) {
    effects->mode = EffectsMode::kList;
    for (const ConfigNode& item : node->items) add(item);
    for (const Effect approximation :
         {Effect::kHarmonics, Effect::kGaussians}) {
      for (const Effect shadow :
           {Effect::kVisibility, Effect::kInterreflection}) {
        if (!effects->Lists(approximation) || !effects->Lists(shadow)) continue;
        context->Fail("effects",
                      std::string("expected ") + EffectName(approximation) +
                          " or " + EffectName(shadow) + ", found both: " +
                          EffectName(approximation) + " knows no shadows");
        return;
      }
    }
    return;
  }
  const Strings modes = {"auto", "all", "none"};
  const auto mode = std::find(modes.begin(), modes.end(), node->scalar);
  if (node->kind == Kind::kScalar && mode != modes.end()) {
    effects->mode = static_cast<EffectsMode>(mode - modes.begin());
    return;
  }
  effects->mode = EffectsMode::kList;
  add(*node);
}

void ReadSolver(ConfigContext* context, const ConfigNode* node,
                ProblemKind kind, SolverSpec* solver) {
  ConfigReader reader(context, node, "solver",
                      {"estimator", "method", "quadrature", "gauge", "seconds",
                       "tolerance", "max_iterations", "seed"});
  ReadChoice(&reader, "estimator", {"marginal", "maximum"}, &solver->estimator);
  ReadChoice(&reader, "method", Names(kNumSolverMethods, SolverMethodName),
             &solver->method);
  ReadChoice(&reader, "quadrature",
             Names(kNumQuadratureLevels, QuadratureLevelName),
             &solver->quadrature);
  ReadChoice(&reader, "gauge", Names(kNumSolverGauges, SolverGaugeName),
             &solver->gauge);
  if (reader.Has("gauge") && kind != ProblemKind::kJoint) {
    reader.Fail("gauge", "expected with problem: joint only");
  }
  reader.Number("seconds", {0.0, kMaxSeconds, false, true}, &solver->seconds);
  reader.Number("tolerance", {0.0, 1.0, true, false}, &solver->tolerance);
  reader.Integer("max_iterations", 0, 100000000, &solver->max_iterations);
  if (reader.Has("seed")) {
    int64_t seed = 0;
    reader.Integer("seed", int64_t{0}, std::numeric_limits<int64_t>::max(),
                   &seed);
    solver->seed = seed;
  }
}

}  // namespace

const char* SolverMethodName(SolverMethod method) {
  switch (method) {
    case SolverMethod::kAuto:
      return "auto";
    case SolverMethod::kAlternating:
      return "alternating";
    case SolverMethod::kGaussNewton:
      return "gauss_newton";
    case SolverMethod::kLbfgs:
      return "lbfgs";
    case SolverMethod::kAdam:
      return "adam";
    case SolverMethod::kTrustRegion:
      return "trust_region";
  }
  return "";
}

const char* QuadratureLevelName(QuadratureLevel level) {
  switch (level) {
    case QuadratureLevel::kCoarse:
      return "coarse";
    case QuadratureLevel::kStandard:
      return "standard";
    case QuadratureLevel::kFine:
      return "fine";
  }
  return "";
}

const char* SolverGaugeName(SolverGauge gauge) {
  switch (gauge) {
    case SolverGauge::kPrior:
      return "prior";
    case SolverGauge::kGreyLight:
      return "grey_light";
    case SolverGauge::kUnitLight:
      return "unit_light";
  }
  return "";
}

const char* EffectName(Effect effect) {
  switch (effect) {
    case Effect::kVisibility:
      return "visibility";
    case Effect::kInterreflection:
      return "interreflection";
    case Effect::kReflectanceMap:
      return "reflectance_map";
    case Effect::kHarmonics:
      return "harmonics";
    case Effect::kGaussians:
      return "gaussians";
  }
  return "";
}

bool EffectsSpec::Lists(Effect effect) const {
  return std::find(list.begin(), list.end(), effect) != list.end();
}

StatusOr<Problem> ReadProblem(const std::string& path,
                              const std::vector<std::string>& overrides) {
  const StatusOr<std::string> text = ReadFile(path, kMaxFileBytes);
  if (!text.ok()) return text.status();
  return ParseProblem(path, *text, overrides);
}

StatusOr<Problem> ParseProblem(const std::string& path, const std::string& text,
                               const std::vector<std::string>& overrides) {
  StatusOr<ConfigNode> root = ParseConfig(path, text);
  if (!root.ok()) return root.status();
  for (const std::string& text_of_one : overrides) {
    IBRDF_RETURN_IF_ERROR(ApplyOverride(text_of_one, &*root));
  }

  ConfigContext context;
  context.file = path;
  context.folder = std::filesystem::path(path).parent_path().string();
  ConfigReader reader(
      &context, &*root, "",
      {"problem", "image", "camera", "geometry", "reflectance", "illumination",
       "likelihood", "effects", "solver", "truth", "noise", "quality"});
  for (const char* key : {"image", "geometry"}) {
    if (!reader.Has(key)) reader.Fail(key, "expected, found nothing");
  }

  Problem problem;
  problem.path = path;
  ReadChoice(&reader, "problem", {"joint", "reflectance", "illumination"},
             &problem.kind);
  ReadImageSpec(&context, reader.Find("image"), &problem.image);
  ReadCamera(&context, reader.Find("camera"), &problem.camera);
  ReadGeometry(&context, reader.Find("geometry"), &problem.geometry);
  if (problem.geometry.kind == GeometryKind::kNormals &&
      problem.camera.type == CameraType::kPerspective) {
    context.Fail("camera.type",
                 "expected orthographic with geometry.normals, found "
                 "'perspective'");
  }
  ReadReflectance(&context, reader.Find("reflectance"), &problem.reflectance);
  ReadIllumination(&context, reader.Find("illumination"),
                   &problem.illumination);
  ConfigReader likelihood(&context, reader.Find("likelihood"), "likelihood",
                          {"scale", "epsilon"});
  ReadAutoNumber(&likelihood, "scale", kPositive, &problem.likelihood.scale);
  ReadAutoNumber(&likelihood, "epsilon", kNotNegative,
                 &problem.likelihood.epsilon);
  ReadEffects(&context, reader.Find("effects"), &problem.effects);
  ReadSolver(&context, reader.Find("solver"), problem.kind, &problem.solver);
  ConfigReader truth(&context, reader.Find("truth"), "truth",
                     {"brdf", "illumination"});
  truth.Path("brdf", &problem.truth.brdf);
  truth.Path("illumination", &problem.truth.illumination);
  reader.Number("noise", {0.0, 1.0, true, true}, &problem.noise);
  ReadChoice(&reader, "quality", {"preview", "reference"}, &problem.quality);
  if (!context.error.ok()) return context.error;
  return problem;
}

std::vector<NamedFile> NamedFiles(const Problem& problem) {
  const bool mesh = problem.geometry.kind == GeometryKind::kMesh;
  std::vector<NamedFile> files = {
      {"problem", problem.path},
      {"image.file", problem.image.file},
      {"image.mask", problem.image.mask},
      {mesh ? "geometry.mesh" : "geometry.normals", problem.geometry.file},
      {"reflectance.model", problem.reflectance.model},
      {"reflectance.known", problem.reflectance.known_file},
      {"illumination.known", problem.illumination.known_file},
      {"truth.brdf", problem.truth.brdf},
      {"truth.illumination", problem.truth.illumination}};
  files.erase(std::remove_if(files.begin(), files.end(),
                             [](const NamedFile& f) { return f.path.empty(); }),
              files.end());
  return files;
}

Status CheckSolvable(const Problem& problem) {
  const auto fail = [&](const std::string& key, const std::string& what) {
    return InvalidInput(problem.path + ": " + key, what);
  };
  if (problem.image.file.empty()) {
    return fail("image.file", "expected the image to be explained");
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
  const bool reflectance_known = problem.kind == ProblemKind::kIllumination;
  const bool illumination_known = problem.kind == ProblemKind::kReflectance;
  if (problem.reflectance.known() != reflectance_known) {
    return fail("reflectance.known",
                reflectance_known
                    ? "expected with problem: illumination, found nothing"
                    : "expected with problem: illumination only");
  }
  if (problem.illumination.known() != illumination_known) {
    return fail("illumination.known",
                illumination_known
                    ? "expected with problem: reflectance, found nothing"
                    : "expected with problem: reflectance only");
  }
  return OkStatus();
}

Status CheckRenderable(const Problem& problem) {
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
  return OkStatus();
}

}  // namespace ibrdf
