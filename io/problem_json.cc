#include "ibrdf/io/problem_json.h"

#include <Eigen/Core>
#include <optional>
#include <string>

#include "ibrdf/io/problem_schema.h"

namespace ibrdf {
namespace {
using nlohmann::json;

template <typename Vector>
json Triple(const Vector& v) {
  return json::array({v[0], v[1], v[2]});
}

json AutoOr(const std::optional<double>& value) {
  return value.has_value() ? json(*value) : json("auto");
}

json AutoOr(const std::optional<Eigen::Array3d>& value) {
  return value.has_value() ? Triple(*value) : json("auto");
}

json ImageJson(const ImageSpec& image) {
  if (image.width > 0) {
    return {{"width", image.width}, {"height", image.height}};
  }
  json out;
  if (!image.file.empty() && image.other_lights.empty()) {
    out["file"] = image.file;
  }
  if (!image.mask.empty()) out["mask"] = image.mask;
  if (!image.layer.empty()) out["layer"] = image.layer;
  out["response"] = WordOf("image.response", image.response);
  const auto or_auto = [](const std::optional<double>& value) {
    return value.has_value() ? json(*value) : json("auto");
  };
  out["response_parameter"] = or_auto(image.response_parameter);
  out["white"] = or_auto(image.white);
  out["black"] = or_auto(image.black);
  out["exposure"] = image.exposure;
  if (!image.brackets.empty()) out["brackets"] = image.brackets;
  if (!image.bracket_exposures.empty()) {
    out["bracket_exposures"] = image.bracket_exposures;
  }
  return out;
}

// A camera as the file has it, before it was turned.
json CameraJson(const Camera& turned, UpAxis up, bool placed) {
  const Camera camera = Turned(turned, YUpFrom(up).transpose());
  json out = {{"type", WordOf("camera.type", camera.type)}};
  if (placed && camera.world_from_camera) {
    for (int row = 0; row < 4; ++row) {
      const Eigen::RowVector4d& r = camera.world_from_camera->row(row);
      out["world_from_camera"].push_back({r[0], r[1], r[2], r[3]});
    }
  }
  if (camera.type == CameraType::kOrthographic) return out;
  if (camera.focal_pixels) {
    out["focal_pixels"] = {camera.focal_pixels->x(), camera.focal_pixels->y()};
  } else {
    out["fov_degrees"] = camera.fov_degrees;
  }
  if (camera.centre_pixels) {
    out["centre_pixels"] = {camera.centre_pixels->x(),
                            camera.centre_pixels->y()};
  }
  if (!placed || camera.world_from_camera) return out;
  out["from"] = Triple(camera.from);
  out["to"] = Triple(camera.to);
  out["up"] = Triple(camera.up);
  return out;
}

json ViewsJson(const ViewsSpec& views, UpAxis up) {
  json out;
  if (!views.transforms.empty()) out["transforms"] = views.transforms;
  if (!views.colmap.empty()) out["colmap"] = views.colmap;
  if (!views.images.empty()) out["images"] = views.images;
  if (!views.masks.empty()) out["masks"] = views.masks;
  if (!out.empty()) return out;
  out = json::array();
  for (const ViewSpec& view : views.list) {
    out.push_back({{"name", view.name},
                   {"camera", CameraJson(view.camera, up, /*placed=*/true)}});
    if (!view.file.empty()) out.back()["file"] = view.file;
    if (!view.mask.empty()) out.back()["mask"] = view.mask;
    if (!view.labels.empty()) out.back()["labels"] = view.labels;
    if (view.exposure) out.back()["exposure"] = *view.exposure;
  }
  return out;
}

json FrameOfNormalsJson(const NormalFrame& frame) {
  if (frame == kOpenGlFrame) return "opengl";
  if (frame == kOpenCvFrame) return "opencv";
  return {{"x", WordOf("geometry.frame.x", frame[0])},
          {"y", WordOf("geometry.frame.y", frame[1])},
          {"z", WordOf("geometry.frame.z", frame[2])}};
}

json ShapeJson(const GeometrySpec& geometry) {
  switch (geometry.kind) {
    case GeometryKind::kSphere:
      if (!geometry.outline.has_value()) break;
      return {{"sphere",
               {{"centre", {geometry.outline->x, geometry.outline->y}},
                {"radius", geometry.outline->radius}}}};
    case GeometryKind::kMesh:
      return {{"mesh", geometry.file},
              {"fit", WordOf("geometry.fit", geometry.fit)}};
    case GeometryKind::kNormals:
      return {{"normals", geometry.file},
              {"frame", FrameOfNormalsJson(geometry.frame)},
              {"encoding", WordOf("geometry.encoding", geometry.encoding)}};
    case GeometryKind::kDepth:
      return {{"depth", geometry.file},
              {"depth_scale", AutoOr(geometry.depth_scale)}};
  }
  return {{"sphere", json::object()}};
}

json GeometryJson(const GeometrySpec& geometry) {
  json out = ShapeJson(geometry);
  out["up"] = WordOf("geometry.up", geometry.up);
  return out;
}

json AnalyticJson(const CookTorrance& f) {
  if (f.specular.maxCoeff() == 0.0) {
    return {{"lambertian", Triple(f.diffuse)}};
  }
  return {{"cook_torrance",
           {{"diffuse", Triple(f.diffuse)},
            {"specular", Triple(f.specular)},
            {"roughness", Triple(f.roughness)},
            {"f0", Triple(f.f0)}}}};
}

json ValueJson(const SurfaceValue& v, bool triple) {
  if (!v.texture.empty()) return v.texture;
  return triple ? Triple(v.value) : json(v.value[0]);
}

json PrincipledJson(const PrincipledSpec& p) {
  return {{"principled",
           {{"base", ValueJson(p.base, true)},
            {"roughness", ValueJson(p.roughness, false)},
            {"metallic", ValueJson(p.metallic, false)},
            {"specular", ValueJson(p.specular, false)}}}};
}

json KnownReflectanceJson(const ReflectanceSpec& reflectance) {
  const std::optional<PaintSpec>& paint = reflectance.paint;
  if (!paint.has_value() && !reflectance.known_file.empty()) {
    return reflectance.known_file;
  }
  json known = reflectance.principled.has_value()
                   ? PrincipledJson(*reflectance.principled)
               : reflectance.analytic.has_value()
                   ? AnalyticJson(*reflectance.analytic)
                   : json{{"brdf", reflectance.known_file}};
  if (paint.has_value()) {
    known["albedo"] = paint->albedo;
    known["unpainted_albedo"] = AutoOr(paint->unpainted_albedo);
  }
  return known;
}

json ReflectanceJson(const ReflectanceSpec& reflectance) {
  if (reflectance.known()) {
    return {{"known", KnownReflectanceJson(reflectance)}};
  }
  json out = {{"model", reflectance.model.empty() ? "auto" : reflectance.model},
              {"lobes", reflectance.lobes},
              {"prior_sigma", reflectance.prior_sigma},
              {"variation", ReflectanceVariationName(reflectance.variation)}};
  if (!reflectance.labels.empty()) out["labels"] = reflectance.labels;
  return out;
}

std::string FrameJson(const std::optional<MapFrame>& frame) {
  return frame.has_value() ? MapFrameName(*frame) : "auto";
}

json IlluminationJson(const IlluminationSpec& illumination, bool rendered) {
  const bool file = !illumination.known_file.empty();
  json out = {{"output_frame", MapFrameName(illumination.output_frame)}};
  if (!rendered && illumination.known()) {
    out["ambient"] = AutoOr(illumination.ambient);
  }
  // A render takes the file's map as it is, an estimate may resample it.
  if (!file || (!rendered && illumination.sized)) {
    out["width"] = illumination.width;
    out["height"] = illumination.height;
  }
  if (file) {
    out["known"] = illumination.known_file;
    out["frame"] = FrameJson(illumination.frame);
    return out;
  }
  if (illumination.sky.has_value()) {
    const SkyOptions& sky = *illumination.sky;
    out["known"]["sky"] = {{"sun_theta_degrees", sky.sun_theta_degrees},
                           {"sun_phi_degrees", sky.sun_phi_degrees},
                           {"sun_radius_degrees", sky.sun_radius_degrees},
                           {"sun_irradiance", sky.sun_irradiance},
                           {"zenith_radiance", sky.zenith_radiance},
                           {"haze", sky.haze},
                           {"clouds", sky.clouds},
                           {"skyline", sky.skyline},
                           {"ground_albedo", sky.ground_albedo}};
    return out;
  }
  out["prior"] = WordOf("illumination.prior", illumination.prior);
  if (illumination.prior == IlluminationPrior::kUNet) {
    out["unet_channels"] = illumination.unet_channels;
  }
  return out;
}

json EffectsJson(const EffectsSpec& effects) {
  if (effects.mode != EffectsMode::kList) {
    return WordOf("effects", effects.mode);
  }
  json list = json::array();
  for (const Effect effect : effects.list) list.push_back(EffectName(effect));
  return list;
}

json SolverJson(const SolverSpec& solver, ProblemKind kind) {
  json out = {{"estimator", WordOf("solver.estimator", solver.estimator)},
              {"method", SolverMethodName(solver.method)},
              {"quadrature", QuadratureLevelName(solver.quadrature)},
              {"seconds", solver.seconds},
              {"tolerance", solver.tolerance},
              {"max_iterations", solver.max_iterations}};
  // Only where both parts are unknown may scale move between them, and is a
  // reflectance searched for among many.
  if (kind == ProblemKind::kJoint) {
    out["search"] = SolverSearchName(solver.search);
    out["turns"] = solver.turns;
    out["gauge"] = SolverGaugeName(solver.gauge);
  }
  if (solver.seed.has_value()) out["seed"] = *solver.seed;
  return out;
}

json UncertaintyJson(const UncertaintySpec& u) {
  return {{"evaluator", WordOf("uncertainty.evaluator", u.evaluator)},
          {"order", u.order},
          {"sigma", AutoOr(u.sigma)},
          {"shadows", WordOf("uncertainty.shadows", u.shadows)},
          {"prior", WordOf("uncertainty.prior", u.prior)}};
}

json TexturesJson(const Problem& problem) {
  return {
      {"problem", WordOf("problem", problem.kind)},
      {"image", ImageJson(problem.image)},
      {"views", ViewsJson(problem.views, problem.geometry.up)},
      {"geometry", GeometryJson(problem.geometry)},
      {"illumination",
       IlluminationJson(problem.illumination, /*rendered=*/true)},
      {"texture",
       {{"width", problem.texture.width}, {"height", problem.texture.height}}},
      {"uncertainty", UncertaintyJson(problem.uncertainty)}};
}

void AppendLeaves(const std::string& key, const json& value,
                  std::vector<ProblemSetting>* settings) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [name, member] : value.items()) {
      AppendLeaves(key.empty() ? name : key + "." + name, member, settings);
    }
    return;
  }
  // Paths need not be UTF-8.
  settings->push_back(
      {key, value.is_string()
                ? value.get<std::string>()
                : value.dump(-1, ' ', false, json::error_handler_t::replace)});
}

}  // namespace

nlohmann::json ProblemToJson(const Problem& problem) {
  if (problem.kind == ProblemKind::kTextures) return TexturesJson(problem);
  const bool rendered = problem.image.file.empty();
  json out = {
      {"image", ImageJson(problem.image)},
      {"geometry", GeometryJson(problem.geometry)},
      {"reflectance", ReflectanceJson(problem.reflectance)},
      {"illumination", IlluminationJson(problem.illumination, rendered)},
      {"effects", EffectsJson(problem.effects)}};
  if (problem.views.given()) {
    out["views"] = ViewsJson(problem.views, problem.geometry.up);
  } else {
    // Maps of normals and depth are in the camera's frame.
    out["camera"] = CameraJson(problem.camera, problem.geometry.up,
                               !problem.geometry.HasNormalMap());
  }
  if (rendered) {
    out["quality"] = WordOf("quality", problem.quality);
    out["noise"] = problem.noise;
    if (problem.solver.seed.has_value()) {
      out["solver"]["seed"] = *problem.solver.seed;  // of the noise
    }
    return out;
  }
  out["problem"] = WordOf("problem", problem.kind);
  out["likelihood"] = {{"scale", AutoOr(problem.likelihood.scale)},
                       {"epsilon", AutoOr(problem.likelihood.epsilon)}};
  out["solver"] = SolverJson(problem.solver, problem.kind);
  if (!problem.image.other_lights.empty()) {
    out["images"] = {problem.image.file};
    for (const std::string& file : problem.image.other_lights) {
      out["images"].push_back(file);
    }
  }
  json truth = json::object();
  if (!problem.truth.brdf.empty()) truth["brdf"] = problem.truth.brdf;
  if (!problem.truth.illumination.empty()) {
    truth["illumination"] = problem.truth.illumination;
    truth["frame"] = FrameJson(problem.truth.frame);
  }
  if (!truth.empty()) out["truth"] = truth;
  return out;
}

std::vector<ProblemSetting> ListSettings(const Problem& problem) {
  std::vector<ProblemSetting> settings;
  AppendLeaves("", ProblemToJson(problem), &settings);
  return settings;
}

}  // namespace ibrdf
