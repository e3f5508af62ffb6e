// What a result says of its problem is that problem.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "ibrdf/io/config_tree.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"
#include "tests/properties/generators.h"

namespace ibrdf {
namespace {

// Finite numbers of any bits in an interval, its ends, and round ones.
double AnyNumber(double low, double high) {
  std::vector<double> candidates = {low, high, 0.1, 1.0, 5e-324, 1e300};
  const std::vector<double> any = AnyFiniteDoubles(6);
  candidates.insert(candidates.end(), any.begin(), any.end());
  candidates.push_back(low / 2 + *Unit() * (high / 2 - low / 2));
  std::vector<double> inside;
  for (const double x : candidates) {
    if (x >= low && x <= high) inside.push_back(x);
  }
  return inside[*Choice(static_cast<int>(inside.size()))];
}

constexpr double kMost = std::numeric_limits<double>::max();
constexpr double kLeast = 5e-324;

template <typename Vector>
Vector AnyTriple(double low, double high) {
  return Vector(AnyNumber(low, high), AnyNumber(low, high),
                AnyNumber(low, high));
}

// Absolute, of any characters that UTF-8 and a file system allow, for JSON is
// UTF-8: quotes, colons, line feeds, what looks like a number or a comment.
std::string AnyPath() {
  const auto letters = *rc::gen::container<std::vector<std::string>>(
      rc::gen::oneOf(rc::gen::map(rc::gen::inRange<int>(1, 128),
                                  [](int c) {
                                    return std::string(1, static_cast<char>(c));
                                  }),
                     rc::gen::element<std::string>(
                         "\xc3\xa9", "\xe2\x80\xa8", "\xc2\x85",
                         "\xf0\x9f\x98\x80", "\xef\xbb\xbf", " #", ": ",
                         "\\u0041", "\r\n", "~", "null", "- ")));
  std::string path = "/";
  for (const std::string& letter : letters) path += letter;
  if (*Choice(20) == 0) path += std::string(3000, 'x');
  return path;
}

template <typename Enum>
Enum AnyOf(int count) {
  return static_cast<Enum>(*Choice(count));
}

Camera AnyCamera() {
  Camera camera;
  if (*rc::gen::arbitrary<bool>()) return camera;
  Camera view;
  view.type = CameraType::kPerspective;
  view.fov_degrees = AnyNumber(kLeast, 179.99);
  view.from = AnyTriple<Eigen::Vector3d>(-1e9, 1e9);
  view.to = AnyTriple<Eigen::Vector3d>(-1e9, 1e9);
  view.up = AnyTriple<Eigen::Vector3d>(-1e9, 1e9);
  if (*rc::gen::arbitrary<bool>()) {
    view.fov_degrees = Camera().fov_degrees;
    view.focal_pixels =
        Eigen::Vector2d(AnyNumber(kLeast, kMost), AnyNumber(kLeast, kMost));
  }
  if (*rc::gen::arbitrary<bool>()) {
    view.centre_pixels =
        Eigen::Vector2d(AnyNumber(-kMost, kMost), AnyNumber(-kMost, kMost));
  }
  return IsValidCamera(view) ? view : camera;
}

// In place of from, to and up.
Camera WithAnyPose(Camera camera) {
  Eigen::Vector4d q(AnyNumber(-1, 1), AnyNumber(-1, 1), AnyNumber(-1, 1), 0.5);
  q.normalize();
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() =
      Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  pose.topRightCorner<3, 1>() = AnyTriple<Eigen::Vector3d>(-kMost, kMost);
  camera.world_from_camera = pose;
  camera.from = Camera().from;
  camera.to = Camera().to;
  camera.up = Camera().up;
  return camera;
}

ViewsSpec AnyViews() {
  ViewsSpec views;
  switch (*Choice(3)) {
    case 0:
      views.transforms = AnyPath();
      break;
    case 1:
      views.colmap = AnyPath();
      break;
    default:
      for (int i = *Choice(3); i >= 0; --i) {
        views.list.push_back({"view " + std::to_string(i), AnyCamera()});
      }
  }
  return views;
}

CookTorrance AnyAnalyticBrdf() {
  CookTorrance brdf;
  brdf.diffuse = AnyTriple<Eigen::Array3d>(0.0, 1.0);
  if (*rc::gen::arbitrary<bool>()) {  // Lambertian, the rest as it is
    brdf.specular.setZero();
    return brdf;
  }
  brdf.specular = AnyTriple<Eigen::Array3d>(kLeast, kMost);
  brdf.roughness = AnyTriple<Eigen::Array3d>(1e-3, 10.0);
  brdf.f0 = AnyTriple<Eigen::Array3d>(0.0, 1.0);
  return brdf;
}

SurfaceValue AnySurfaceValue(double most, bool triple) {
  SurfaceValue value{Eigen::Array3d::Constant(AnyNumber(0.0, most)), ""};
  if (triple) value.value = AnyTriple<Eigen::Array3d>(0.0, most);
  return value;
}

PrincipledSpec AnyPrincipled(bool textured) {
  PrincipledSpec spec;
  spec.base = AnySurfaceValue(1.0, true);
  spec.roughness = AnySurfaceValue(1.0, false);
  spec.metallic = AnySurfaceValue(1.0, false);
  spec.specular = AnySurfaceValue(12.5, false);
  if (textured) {
    spec.base = {PrincipledSpec().base.value, AnyPath()};
    spec.metallic = {PrincipledSpec().metallic.value, AnyPath()};
  }
  return spec;
}

PaintSpec AnyPaint() {
  PaintSpec paint;
  paint.albedo = AnyPath();
  if (*rc::gen::arbitrary<bool>()) {
    paint.unpainted_albedo.reset();
  } else {
    paint.unpainted_albedo = AnyTriple<Eigen::Array3d>(kLeast, kMost);
  }
  return paint;
}

SkyOptions AnySky() {
  SkyOptions sky;
  sky.sun_theta_degrees = AnyNumber(0.0, 90.0);
  sky.sun_phi_degrees = AnyNumber(-360.0, 360.0);
  sky.sun_radius_degrees = AnyNumber(0.1, 30.0);
  sky.sun_irradiance = AnyNumber(0.0, kMost);
  sky.zenith_radiance = AnyNumber(kLeast, kMost);
  sky.haze = AnyNumber(0.0, 1.0);
  sky.clouds = AnyNumber(0.0, 1.0);
  sky.skyline = AnyNumber(0.0, 1.0);
  sky.ground_albedo = AnyNumber(0.0, 1.0);
  return sky;
}

// Or none.
std::optional<MapFrame> AnyFrame() {
  if (*rc::gen::arbitrary<bool>()) return std::nullopt;
  return AnyOf<MapFrame>(kMapFrames.size());
}

GeometrySpec AnyGeometry(CameraType camera) {
  const bool perspective = camera == CameraType::kPerspective;
  GeometrySpec geometry;
  geometry.kind = AnyOf<GeometryKind>(4);
  if (geometry.kind != GeometryKind::kSphere) geometry.file = AnyPath();
  switch (geometry.kind) {
    case GeometryKind::kSphere:
      if (perspective || *rc::gen::arbitrary<bool>()) break;
      geometry.outline = {AnyNumber(-1e6, 1e6), AnyNumber(-1e6, 1e6),
                          AnyNumber(kLeast, 1e6)};
      break;
    case GeometryKind::kMesh:
      geometry.fit = AnyOf<MeshFit>(2);
      break;
    case GeometryKind::kNormals:
      for (PictureAxis& axis : geometry.frame) {  // or the opposite
        const int word = static_cast<int>(axis) / 2 * 2 + *Choice(2);
        axis = static_cast<PictureAxis>(word);
      }
      std::swap(geometry.frame[0], geometry.frame[*Choice(3)]);
      geometry.encoding = AnyOf<NormalEncoding>(3);
      break;
    case GeometryKind::kDepth:
      geometry.depth_scale = AnyNumber(kLeast, 1e6);
      break;
  }
  return geometry;
}

// To be solved or, without an image, rendered; what does not apply is as by
// default.
Problem AnyProblem() {
  Problem p;
  const bool rendered = *Choice(4) == 0;
  if (rendered) {
    p.image.width = *rc::gen::inRange(1, 8000);
    p.image.height = *rc::gen::inRange(1, 8000);
    p.quality = AnyOf<RenderQuality>(2);
    p.noise = AnyNumber(0.0, 1.0);
  } else {
    p.kind = AnyOf<ProblemKind>(3);
    p.image.file = AnyPath();
    if (*rc::gen::arbitrary<bool>()) p.image.mask = AnyPath();
    if (*rc::gen::arbitrary<bool>()) {
      p.likelihood.scale = AnyNumber(kLeast, kMost);
    }
    if (*rc::gen::arbitrary<bool>()) {
      p.likelihood.epsilon = AnyNumber(0.0, kMost);
    }
    p.solver.estimator = AnyOf<SolverEstimator>(2);
    p.solver.method = AnyOf<SolverMethod>(kNumSolverMethods);
    p.solver.quadrature = AnyOf<QuadratureLevel>(kNumQuadratureLevels);
    if (p.kind == ProblemKind::kJoint) {
      p.solver.search = AnyOf<SolverSearch>(kNumSolverSearches);
      p.solver.gauge = AnyOf<SolverGauge>(kNumSolverGauges);
    }
    p.solver.seconds = AnyNumber(kLeast, 1e7);
    p.solver.tolerance = AnyNumber(0.0, 1.0 - 1e-16);
    p.solver.max_iterations = *rc::gen::inRange(0, 100000001);
    if (*rc::gen::arbitrary<bool>()) p.truth.brdf = AnyPath();
    if (*rc::gen::arbitrary<bool>()) {
      p.truth.illumination = AnyPath();
      p.truth.frame = AnyFrame();
    }
  }
  if (*rc::gen::arbitrary<bool>()) {
    p.solver.seed =
        *rc::gen::oneOf(rc::gen::inRange<int64_t>(0, 1000),
                        rc::gen::just(std::numeric_limits<int64_t>::max()));
  }
  p.camera = AnyCamera();
  p.geometry = AnyGeometry(p.camera.type);
  if (p.geometry.HasNormalMap()) {  // in the camera's frame
    p.camera.from = Camera().from;
    p.camera.to = Camera().to;
    p.camera.up = Camera().up;
  }
  if (!p.geometry.HasNormalMap() && *rc::gen::arbitrary<bool>()) {
    p.camera = WithAnyPose(p.camera);
  }
  if (!p.geometry.HasNormalMap() && !p.geometry.outline.has_value() &&
      *rc::gen::arbitrary<bool>()) {
    p.views = AnyViews();
    p.camera = p.views.list.size() == 1 ? p.views.list[0].camera : Camera();
  }
  if (rendered || p.kind == ProblemKind::kIllumination) {
    const int known = *Choice(3);
    const bool textured = rendered && *rc::gen::arbitrary<bool>();
    if (known == 0) {
      p.reflectance.known_file = AnyPath();
    } else if (known == 1) {
      p.reflectance.principled = AnyPrincipled(textured);
    } else {
      p.reflectance.analytic = AnyAnalyticBrdf();
    }
    if (rendered && !(known == 1 && textured) && *rc::gen::arbitrary<bool>()) {
      p.reflectance.paint = AnyPaint();
    }
  } else {
    if (*rc::gen::arbitrary<bool>()) p.reflectance.model = AnyPath();
    p.reflectance.lobes = *rc::gen::inRange(1, 9);
    p.reflectance.prior_sigma = AnyNumber(kLeast, kMost);
    if (p.kind == ProblemKind::kJoint &&
        p.solver.estimator == SolverEstimator::kMarginal) {
      p.reflectance.variation =
          AnyOf<ReflectanceVariation>(kNumReflectanceVariations);
      if (p.reflectance.variation == ReflectanceVariation::kLabels) {
        p.reflectance.labels = AnyPath();
      }
    }
  }
  if (p.solver.estimator == SolverEstimator::kMaximum) {
    p.reflectance.variation = ReflectanceVariation::kNone;
  }
  const bool map_file = (rendered || p.kind == ProblemKind::kReflectance) &&
                        *rc::gen::arbitrary<bool>();
  // A render takes the file's map as it is; else it may be resampled.
  if (!map_file || (!rendered && *rc::gen::arbitrary<bool>())) {
    p.illumination.sized = true;
    p.illumination.width = 2 * *rc::gen::inRange(4, 4097);
    p.illumination.height = *rc::gen::inRange(4, 8193);
  }
  p.illumination.output_frame = AnyOf<MapFrame>(kMapFrames.size());
  const bool known =
      map_file || rendered || p.kind == ProblemKind::kReflectance;
  if (!rendered && known && *rc::gen::arbitrary<bool>()) {
    p.illumination.ambient = AnyTriple<Eigen::Array3d>(0.0, 1e9);
  }
  if (map_file) {
    p.illumination.known_file = AnyPath();
    p.illumination.frame = AnyFrame();
  } else if (rendered || p.kind == ProblemKind::kReflectance) {
    p.illumination.sky = AnySky();
  } else {
    p.illumination.prior =
        *rc::gen::element(IlluminationPrior::kProcess, IlluminationPrior::kUNet,
                          IlluminationPrior::kNone);
    if (p.illumination.prior == IlluminationPrior::kUNet) {
      p.illumination.unet_channels = *rc::gen::inRange(1, 129);
    }
  }
  p.effects.mode = AnyOf<EffectsMode>(4);
  if (p.effects.mode == EffectsMode::kList) {
    bool shadows = false;
    for (int e = 0; e < kNumEffects; ++e) {
      const auto effect = static_cast<Effect>(e);
      // These two know none and are not listed with them.
      const bool approximation =
          effect == Effect::kHarmonics || effect == Effect::kGaussians;
      if ((approximation && shadows) || !*rc::gen::arbitrary<bool>()) continue;
      shadows = shadows || effect == Effect::kVisibility ||
                effect == Effect::kInterreflection;
      p.effects.list.push_back(effect);
    }
    if (*rc::gen::arbitrary<bool>()) {
      std::reverse(p.effects.list.begin(), p.effects.list.end());
    }
  }
  return p;
}

void AssertSame(const Camera& a, const Camera& b) {
  RC_ASSERT(a.type == b.type && a.fov_degrees == b.fov_degrees);
  RC_ASSERT(a.from == b.from && a.to == b.to && a.up == b.up);
  RC_ASSERT(a.world_from_camera == b.world_from_camera);
  RC_ASSERT(a.focal_pixels == b.focal_pixels);
  RC_ASSERT(a.centre_pixels == b.centre_pixels);
}

void AssertSame(const CookTorrance& a, const CookTorrance& b) {
  RC_ASSERT((a.diffuse == b.diffuse).all());
  RC_ASSERT((a.specular == b.specular).all());
  RC_ASSERT((a.roughness == b.roughness).all());
  RC_ASSERT((a.f0 == b.f0).all());
}

void AssertSame(const PrincipledSpec& a, const PrincipledSpec& b) {
  for (const auto member :
       {&PrincipledSpec::base, &PrincipledSpec::roughness,
        &PrincipledSpec::metallic, &PrincipledSpec::specular}) {
    RC_ASSERT(((a.*member).value == (b.*member).value).all());
    RC_ASSERT((a.*member).texture == (b.*member).texture);
  }
}

void AssertSame(const PaintSpec& a, const PaintSpec& b) {
  RC_ASSERT(a.albedo == b.albedo);
  RC_ASSERT(a.unpainted_albedo.has_value() == b.unpainted_albedo.has_value());
  if (a.unpainted_albedo.has_value()) {
    RC_ASSERT((*a.unpainted_albedo == *b.unpainted_albedo).all());
  }
}

void AssertSame(const SkyOptions& a, const SkyOptions& b) {
  RC_ASSERT(a.sun_theta_degrees == b.sun_theta_degrees);
  RC_ASSERT(a.sun_phi_degrees == b.sun_phi_degrees);
  RC_ASSERT(a.sun_radius_degrees == b.sun_radius_degrees);
  RC_ASSERT(a.sun_irradiance == b.sun_irradiance);
  RC_ASSERT(a.zenith_radiance == b.zenith_radiance);
  RC_ASSERT(a.haze == b.haze && a.clouds == b.clouds);
  RC_ASSERT(a.skyline == b.skyline && a.ground_albedo == b.ground_albedo);
}

RC_GTEST_PROP(ProblemProperty, ResultsRepeatEveryKeyOfTheProblem, ()) {
  const Problem p = AnyProblem();
  // As result.json is written, and more tightly.
  const int indent = *rc::gen::element(-1, 2);
  const StatusOr<Problem> read =
      ParseProblem("/p.yaml", ProblemToJson(p).dump(indent), {});
  if (!read.ok()) RC_FAIL(read.status().message());
  const Problem& q = *read;
  RC_ASSERT(p.kind == q.kind);
  RC_ASSERT(p.image.file == q.image.file && p.image.mask == q.image.mask);
  RC_ASSERT(p.image.width == q.image.width);
  RC_ASSERT(p.image.height == q.image.height);
  AssertSame(p.camera, q.camera);
  RC_ASSERT(p.views.transforms == q.views.transforms);
  RC_ASSERT(p.views.colmap == q.views.colmap);
  RC_ASSERT(p.views.list.size() == q.views.list.size());
  for (size_t i = 0; i < p.views.list.size(); ++i) {
    RC_ASSERT(p.views.list[i].name == q.views.list[i].name);
    AssertSame(p.views.list[i].camera, q.views.list[i].camera);
  }
  RC_ASSERT(p.geometry.kind == q.geometry.kind);
  RC_ASSERT(p.geometry.file == q.geometry.file);
  RC_ASSERT(p.geometry.fit == q.geometry.fit);
  RC_ASSERT(p.geometry.frame == q.geometry.frame);
  RC_ASSERT(p.geometry.encoding == q.geometry.encoding);
  RC_ASSERT(p.geometry.depth_scale == q.geometry.depth_scale);
  RC_ASSERT(p.geometry.outline.has_value() == q.geometry.outline.has_value());
  if (p.geometry.outline.has_value()) {
    RC_ASSERT(p.geometry.outline->x == q.geometry.outline->x);
    RC_ASSERT(p.geometry.outline->y == q.geometry.outline->y);
    RC_ASSERT(p.geometry.outline->radius == q.geometry.outline->radius);
  }
  RC_ASSERT(p.reflectance.model == q.reflectance.model);
  RC_ASSERT(p.reflectance.lobes == q.reflectance.lobes);
  RC_ASSERT(p.reflectance.prior_sigma == q.reflectance.prior_sigma);
  RC_ASSERT(p.reflectance.variation == q.reflectance.variation);
  RC_ASSERT(p.reflectance.labels == q.reflectance.labels);
  RC_ASSERT(p.reflectance.known_file == q.reflectance.known_file);
  RC_ASSERT(p.reflectance.analytic.has_value() ==
            q.reflectance.analytic.has_value());
  if (p.reflectance.analytic.has_value()) {
    AssertSame(*p.reflectance.analytic, *q.reflectance.analytic);
  }
  RC_ASSERT(p.reflectance.principled.has_value() ==
            q.reflectance.principled.has_value());
  if (p.reflectance.principled.has_value()) {
    AssertSame(*p.reflectance.principled, *q.reflectance.principled);
  }
  RC_ASSERT(p.reflectance.paint.has_value() == q.reflectance.paint.has_value());
  if (p.reflectance.paint.has_value()) {
    AssertSame(*p.reflectance.paint, *q.reflectance.paint);
  }
  RC_ASSERT(p.illumination.width == q.illumination.width);
  RC_ASSERT(p.illumination.height == q.illumination.height);
  RC_ASSERT(p.illumination.sized == q.illumination.sized);
  RC_ASSERT(p.illumination.prior == q.illumination.prior);
  RC_ASSERT(p.illumination.unet_channels == q.illumination.unet_channels);
  RC_ASSERT(p.illumination.known_file == q.illumination.known_file);
  RC_ASSERT(p.illumination.sky.has_value() == q.illumination.sky.has_value());
  if (p.illumination.sky.has_value()) {
    AssertSame(*p.illumination.sky, *q.illumination.sky);
  }
  RC_ASSERT(p.illumination.frame == q.illumination.frame);
  RC_ASSERT(p.illumination.ambient.has_value() ==
            q.illumination.ambient.has_value());
  if (p.illumination.ambient.has_value()) {
    RC_ASSERT((*p.illumination.ambient == *q.illumination.ambient).all());
  }
  RC_ASSERT(p.illumination.output_frame == q.illumination.output_frame);
  RC_ASSERT(p.truth.frame == q.truth.frame);
  RC_ASSERT(p.likelihood.scale == q.likelihood.scale);
  RC_ASSERT(p.likelihood.epsilon == q.likelihood.epsilon);
  RC_ASSERT(p.effects.mode == q.effects.mode);
  RC_ASSERT(p.effects.list == q.effects.list);
  RC_ASSERT(p.solver.estimator == q.solver.estimator);
  RC_ASSERT(p.solver.search == q.solver.search);
  RC_ASSERT(p.solver.method == q.solver.method);
  RC_ASSERT(p.solver.quadrature == q.solver.quadrature);
  RC_ASSERT(p.solver.gauge == q.solver.gauge);
  RC_ASSERT(p.solver.seconds == q.solver.seconds);
  RC_ASSERT(p.solver.tolerance == q.solver.tolerance);
  RC_ASSERT(p.solver.max_iterations == q.solver.max_iterations);
  RC_ASSERT(p.solver.seed == q.solver.seed);
  RC_ASSERT(p.truth.brdf == q.truth.brdf);
  RC_ASSERT(p.truth.illumination == q.truth.illumination);
  RC_ASSERT(p.quality == q.quality && p.noise == q.noise);
}

using Kind = ConfigNode::Kind;

std::string AnyWord() {
  static const char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789_";
  std::string word(1, kLetters[*Choice(26)]);
  const int length = *rc::gen::inRange(0, 8);
  for (int i = 0; i < length; ++i) word += kLetters[*Choice(37)];
  // Not a null.
  return word == "null" ? "none" : word;
}

ConfigNode AnyTree(int depth) {
  ConfigNode node;
  node.kind = depth == 0 ? Kind::kScalar : AnyOf<Kind>(4);
  const int children = *Choice(4);
  switch (node.kind) {
    case Kind::kNull:
      break;
    case Kind::kScalar:
      node.quoted = *rc::gen::arbitrary<bool>();
      // The rest of what a path may hold, in quotes alone.
      node.scalar = node.quoted ? AnyPath() : AnyWord();
      break;
    case Kind::kList:
      for (int i = 0; i < children; ++i) {
        node.items.push_back(AnyTree(depth - 1));
      }
      break;
    case Kind::kMap: {
      std::set<std::string> keys;
      for (int i = 0; i < children; ++i) {
        const std::string key = AnyWord();
        if (!keys.insert(key).second) continue;
        node.entries.emplace_back(key, AnyTree(depth - 1));
      }
      break;
    }
  }
  return node;
}

// In YAML's flow style.
std::string FlowText(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::kNull:
      return "~";
    case Kind::kScalar:
      return node.quoted ? nlohmann::json(node.scalar).dump() : node.scalar;
    case Kind::kList: {
      std::string text = "[";
      for (size_t i = 0; i < node.items.size(); ++i) {
        text += (i > 0 ? ", " : "") + FlowText(node.items[i]);
      }
      return text + "]";
    }
    case Kind::kMap:
      break;
  }
  std::string text = "{";
  for (size_t i = 0; i < node.entries.size(); ++i) {
    text += (i > 0 ? ", " : "") + node.entries[i].first + ": " +
            FlowText(node.entries[i].second);
  }
  return text + "}";
}

// In block style, an entry a line; children that would be empty stay in flow.
std::string BlockText(const ConfigNode& node, int indent) {
  const std::string margin(static_cast<size_t>(indent), ' ');
  const auto below = [indent](const ConfigNode& child) {
    return child.items.empty() && child.entries.empty()
               ? " " + FlowText(child) + "\n"
               : "\n" + BlockText(child, indent + 2);
  };
  std::string text;
  for (const ConfigNode& item : node.items) text += margin + "-" + below(item);
  for (const auto& [key, value] : node.entries) {
    text += margin + key + ":" + below(value);
  }
  return text.empty() ? FlowText(node) : text;
}

void AssertSame(const ConfigNode& a, const ConfigNode& b) {
  RC_ASSERT(a.kind == b.kind);
  RC_ASSERT(a.scalar == b.scalar && a.quoted == b.quoted);
  RC_ASSERT(a.items.size() == b.items.size());
  RC_ASSERT(a.entries.size() == b.entries.size());
  for (size_t i = 0; i < a.items.size(); ++i) {
    AssertSame(a.items[i], b.items[i]);
  }
  for (size_t i = 0; i < a.entries.size(); ++i) {
    RC_ASSERT(a.entries[i].first == b.entries[i].first);
    AssertSame(a.entries[i].second, b.entries[i].second);
  }
}

RC_GTEST_PROP(ConfigTreeProperty, EitherStyleReadsBack, ()) {
  const ConfigNode tree = AnyTree(3);
  for (const std::string& text : {FlowText(tree), BlockText(tree, 0)}) {
    const StatusOr<ConfigNode> back = ParseConfig("c.yaml", text);
    if (!back.ok()) RC_FAIL(back.status().message());
    AssertSame(tree, *back);
  }
}

// Sets every leaf by its path; a null would remove its key.
void OverrideLeaves(const ConfigNode& node, const std::string& path,
                    ConfigNode* root, ConfigNode* expected) {
  if (node.kind == Kind::kMap && !node.entries.empty()) {
    for (const auto& [key, value] : node.entries) {
      if (value.kind == Kind::kNull) continue;
      ConfigNode child;
      OverrideLeaves(value, path.empty() ? key : path + "." + key, root,
                     &child);
      if (child.kind != Kind::kNull) {
        expected->kind = Kind::kMap;
        expected->entries.emplace_back(key, child);
      }
    }
    return;
  }
  *expected = node;
  const Status set = ApplyOverride(path + "=" + FlowText(node), root);
  if (!set.ok()) RC_FAIL(set.message());
}

RC_GTEST_PROP(ConfigTreeProperty, OverridesOfEveryLeafMakeTheTree, ()) {
  ConfigNode tree;
  tree.kind = Kind::kMap;
  tree.entries = {{"a", AnyTree(3)}, {"b", AnyTree(3)}};
  ConfigNode made, expected;
  made.kind = expected.kind = Kind::kMap;
  OverrideLeaves(tree, "", &made, &expected);
  AssertSame(expected, made);
  // Again: nothing changes.
  ConfigNode ignored;
  OverrideLeaves(tree, "", &made, &ignored);
  AssertSame(expected, made);
}

}  // namespace
}  // namespace ibrdf
