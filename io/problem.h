// What a problem file (joint.yaml, scene.yaml) asks for, checked.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/geometry/up_axis.h"
#include "ibrdf/image/response_curve.h"
#include "ibrdf/light/map_frame.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {

// Paths are resolved: usable from the current folder. Whether the files exist
// is found out by whoever reads them.

// kTextures: of every texel, from several views (ibrdf_uncertainty).
enum class ProblemKind { kJoint, kReflectance, kIllumination, kTextures };

// Which curve made the values of an image of radiance. kAuto: what the file
// says; sRGB of 8 bits that say nothing. From kLinear on the kinds of
// response_curve.h, kTable not among them. kUnknown: to be found among several
// kinds; kUnknownPower, kUnknownAces: that curve, of a parameter to be found.
enum class ResponseChoice {
  kAuto,
  kLinear,
  kSrgb,
  kPower,
  kAces,
  kReinhard,
  kLog,
  kUnknown,
  kUnknownPower,
  kUnknownAces,
};
// None: kAuto, or unknown.
inline std::optional<ResponseKind> KnownResponse(ResponseChoice choice) {
  if (choice == ResponseChoice::kAuto || choice >= ResponseChoice::kUnknown) {
    return std::nullopt;
  }
  return static_cast<ResponseKind>(static_cast<int>(choice) - 1);
}

// Photographs of one view beside the first: each takes a solve of its light.
inline constexpr size_t kMaxOtherLights = 15;

struct ImageSpec {
  std::string file;   // any of photo_file.h; empty: to be rendered
  std::string mask;   // .png; empty: none
  std::string layer;  // of OpenEXR; empty: the beauty part
  ResponseChoice response = ResponseChoice::kAuto;
  std::optional<double> response_parameter;  // unset: the curve's usual one
  // Codes of a file of whole numbers: from `white` on they are clipped, up to
  // `black` they are 0. Unset: the largest code, and 0.
  std::optional<double> white, black;
  double exposure = 1.0;  // values are the curve of exposure times radiance
  // Further files of the same view, each of its own exposure.
  std::vector<std::string> brackets;
  std::vector<double> bracket_exposures;
  // Further files of the same view, each under a light of its own.
  std::vector<std::string> other_lights;
  int width = 0;  // pixels, of an image to be rendered; 0 with a file
  int height = 0;
};

// One of several views.
struct ViewSpec {
  std::string name;  // ViewNameFault; unlike the others'
  Camera camera;
  // The photograph and its mask, as ImageSpec has them, and the view's
  // reflectance.labels. Empty: none, as of a view that is to be rendered.
  std::string file = {}, mask = {}, labels = {};
  // In place of ImageSpec::exposure, > 0; unset: that one.
  std::optional<double> exposure = std::nullopt;
};

// Several views: at most one of the three is set.
struct ViewsSpec {
  std::vector<ViewSpec> list;
  std::string transforms;  // .json
  std::string colmap;      // a folder
  // kTextures has these: the folder of the images that such a file names
  // (empty: the file's folder, or the model's), and that of their masks (empty:
  // none).
  std::string images, masks;

  bool given() const {
    return !list.empty() || !transforms.empty() || !colmap.empty();
  }
  // One of a list is a problem's image and camera.
  bool several() const { return given() && list.size() != 1; }
};

enum class GeometryKind { kSphere, kMesh, kNormals, kDepth };
enum class MeshFit { kUnitSphere, kNone };
// As the picture has them: toward the camera, away from it.
enum class PictureAxis { kRight, kLeft, kUp, kDown, kToward, kAway };
// Where x, y and z of a normal map point. Each of the picture's three axes has
// one of them.
using NormalFrame = std::array<PictureAxis, 3>;
inline constexpr NormalFrame kOpenGlFrame = {
    PictureAxis::kRight, PictureAxis::kUp, PictureAxis::kToward};
inline constexpr NormalFrame kOpenCvFrame = {
    PictureAxis::kRight, PictureAxis::kDown, PictureAxis::kAway};
// kFloat: the vector. kUnit01: (n + 1) / 2. kAuto: see LoadNormals.
enum class NormalEncoding { kAuto, kFloat, kUnit01 };

// In pixels from the image's top left corner, x right and y down; centres of
// pixels are at halves.
struct PixelCircle {
  double x = 0.0, y = 0.0, radius = 1.0;
};

struct GeometrySpec {
  // A sphere without an outline is the unit sphere at the origin, or what the
  // mask shows (sphere_outline.h).
  GeometryKind kind = GeometryKind::kSphere;
  // The sphere's, before an orthographic camera.
  std::optional<PixelCircle> outline;
  // Mesh (.obj, .ply, .stl, .glb); normals or depth (any of photo_file.h).
  std::string file;
  MeshFit fit = MeshFit::kUnitSphere;
  bool fit_stated = false;  // fit is the user's word
  // The axis that points up in the files' world. The cameras of a problem that
  // was read are turned to the library's already; meshes and other programs'
  // views are turned when they are read.
  UpAxis up = UpAxis::kY;
  NormalFrame frame = kOpenGlFrame;
  NormalEncoding encoding = NormalEncoding::kAuto;
  // The file's values times this are depth, which grows away from the camera;
  // not 0. Unset: 1, for files of floats.
  std::optional<double> depth_scale;

  bool HasNormalMap() const {
    return kind == GeometryKind::kNormals || kind == GeometryKind::kDepth;
  }
};

// How the reflectance varies over the object, in the order of the schema.
// kAuto: kAlbedo where the photograph shows several materials
// (photograph_check).
enum class ReflectanceVariation { kAuto, kNone, kAlbedo, kLabels };
inline constexpr int kNumReflectanceVariations = 4;
// "auto", "none", "albedo", "labels".
const char* ReflectanceVariationName(ReflectanceVariation variation);

// Paint over a known reflectance, f = a(x) f_matte + f_gloss.
struct PaintSpec {
  std::string albedo;  // floats, an image of the size of what is rendered
  // What the file's values are divided by: a(x) is 1 there. Unset: the albedo
  // of f_matte, as in albedo.exr of a result.
  std::optional<Eigen::Array3d> unpainted_albedo = Eigen::Array3d::Ones();
};

// A number for all channels, three, or a texture over the surface.
struct SurfaceValue {
  Eigen::Array3d value;
  std::string texture;  // any of photo_file.h; empty: `value`
};

// The principled BRDF (brdf/disney.h); of roughness, metallic and specular the
// three numbers are one.
struct PrincipledSpec {
  SurfaceValue base{Eigen::Array3d::Constant(0.5), ""};
  SurfaceValue roughness{Eigen::Array3d::Constant(0.5), ""};
  SurfaceValue metallic{Eigen::Array3d::Zero(), ""};
  SurfaceValue specular{Eigen::Array3d::Constant(0.5), ""};

  bool textured() const {
    return !(base.texture.empty() && roughness.texture.empty() &&
             metallic.texture.empty() && specular.texture.empty());
  }
};

struct ReflectanceSpec {
  // Unknown reflectance.
  std::string model;         // trained model; empty: auto
  int lobes = 2;             // [1, 8]
  double prior_sigma = 0.5;  // of the codes, > 0
  ReflectanceVariation variation = ReflectanceVariation::kAuto;
  // Image of the materials, of kLabels alone; "auto": they are to be found.
  std::string labels;
  // Known reflectance: at most one is set.
  std::string known_file;                // MERL .binary
  std::optional<CookTorrance> analytic;  // `lambertian` too: specular 0
  std::optional<PrincipledSpec> principled;
  std::optional<PaintSpec> paint;  // over any of these

  bool finds_labels() const { return labels == "auto"; }
  bool known() const {
    return !known_file.empty() || analytic.has_value() ||
           principled.has_value();
  }
};

// kAuto stands in files alone: a problem that was read has one of the others.
enum class IlluminationPrior { kAuto, kProcess, kUNet, kNone };
// Most texels along a side of an estimate under kProcess, whose MAP estimate
// takes O(width height^3).
inline constexpr int kMaxProcessSide = 256;

struct IlluminationSpec {
  // The size of the estimate, of the map that a sky is made into, or of what a
  // known map is resampled to.
  int width = 128;
  int height = 64;
  bool sized = false;  // they were asked for
  IlluminationPrior prior = IlluminationPrior::kProcess;
  int unet_channels = 32;  // of the network's feature maps, [1, 128]
  // Known illumination: at most one is set.
  std::string known_file;  // floats of any format of photo_file.h
  std::optional<SkyOptions> sky;
  // The frame of the file. Unset: what the file says, else camera
  // (io/map_file.h).
  std::optional<MapFrame> frame;
  MapFrame output_frame = MapFrame::kCamera;  // of the maps that are written
  // Radiance that every pixel has beside the known light's, >= 0; unset: found
  // where pixels show it.
  std::optional<Eigen::Array3d> ambient;

  bool known() const { return !known_file.empty() || sky.has_value(); }
};

struct LikelihoodSpec {
  std::optional<double> scale;    // Laplacian b, natural log; unset: automatic
  std::optional<double> epsilon;  // radiance added inside the logarithms
};

enum class Effect {
  kVisibility,
  kInterreflection,
  kReflectanceMap,
  kHarmonics,
  kGaussians,
};
inline constexpr int kNumEffects = 5;
// Name in problem files, e.g. "reflectance_map".
const char* EffectName(Effect effect);

// kAuto: the program decides. kAll: every effect; no approximation of
// unshadowed light but the reflectance map. kList: the listed ones and no
// other.
enum class EffectsMode { kAuto, kAll, kNone, kList };
struct EffectsSpec {
  EffectsMode mode = EffectsMode::kAuto;
  std::vector<Effect> list;  // each at most once
  bool Lists(Effect effect) const;
};

// What minimises the map, under SolverEstimator::kMaximum map and reflectance.
// With IlluminationPrior::kUNet it is the network's: the MAP estimate under
// the Gaussian process before it is found by kGaussNewton. kAuto: the program
// decides.
enum class SolverMethod {
  kAuto,
  kAlternating,
  kGaussNewton,
  kLbfgs,
  kAdam,
  kTrustRegion,
};
inline constexpr int kNumSolverMethods = 6;
// Name in problem files, e.g. "gauss_newton".
const char* SolverMethodName(SolverMethod method);

// What a joint problem's reflectance maximises. kMarginal: its posterior with
// the light integrated out; the map is then the most probable one given it.
// kMaximum: the posterior of both together (Chen et al. 2020, Eq. 8).
enum class SolverEstimator { kMarginal, kMaximum };

// How far a joint problem's reflectance is searched for. kThorough: twice, with
// and without tolerance of materials that are unlike the object's. kAuto: the
// second time where the first leaves the reflectance wide open.
enum class SolverSearch { kAuto, kStandard, kThorough };
inline constexpr int kNumSolverSearches = 3;
// Name in problem files, e.g. "thorough".
const char* SolverSearchName(SolverSearch search);

// How finely the integral over light directions is taken.
enum class QuadratureLevel { kCoarse, kStandard, kFine };
inline constexpr int kNumQuadratureLevels = 3;
// Name in problem files, e.g. "standard".
const char* QuadratureLevelName(QuadratureLevel level);

// Where a joint estimate has the scale per channel between reflectance and
// light, which no image tells. kPrior: where the priors do. kGreyLight: the
// light's mean radiance over the sphere is the same in all channels, at the
// geometric mean of what kPrior makes of them. kUnitLight: it is 1 in all.
enum class SolverGauge { kPrior, kGreyLight, kUnitLight };
inline constexpr int kNumSolverGauges = 3;
// Name in problem files, e.g. "grey_light".
const char* SolverGaugeName(SolverGauge gauge);

inline constexpr int kMostSolverTurns = 20;

struct SolverSpec {
  SolverEstimator estimator = SolverEstimator::kMarginal;
  SolverSearch search = SolverSearch::kAuto;  // of joint problems
  int turns = 2;  // of joint problems, in [0, kMostSolverTurns]
  SolverMethod method = SolverMethod::kAuto;
  QuadratureLevel quadrature = QuadratureLevel::kStandard;
  SolverGauge gauge = SolverGauge::kGreyLight;  // of joint problems
  double seconds = 120.0;                       // wall-clock budget, > 0
  double tolerance = 1e-4;    // relative decrease of the cost to stop at, >= 0
  int max_iterations = 1000;  // >= 0
  std::optional<int64_t> seed;  // unset: the program's --seed
};

// Empty: not given.
struct TruthSpec {
  std::string brdf;               // MERL .binary
  std::string illumination;       // as IlluminationSpec::known_file
  std::optional<MapFrame> frame;  // of illumination; unset: as there
};

// The picture of a surface.
struct TextureSpec {
  int width = 256, height = 256;  // texels
};

// The model that an entropy is of (src/ibrdf/uncertainty).
enum class EntropyModel { kAngular, kSpectrum };
// kMirror: light that the object hides is left out, in the mirror direction and
// of the irradiance.
enum class EntropyShadows { kNone, kMirror };
// kMaterials: as the measured materials are (measured_materials.h).
enum class EntropyPrior { kUniform, kMaterials };
struct UncertaintySpec {
  EntropyModel evaluator = EntropyModel::kAngular;
  int order = 5;  // of the harmonics, [1, 10]
  // Standard deviation, in units of the map's mean radiance; unset: the
  // evaluator's own.
  std::optional<double> sigma;
  EntropyShadows shadows = EntropyShadows::kMirror;
  EntropyPrior prior = EntropyPrior::kUniform;
};

enum class RenderQuality { kPreview, kReference };

struct Problem {
  std::string path;  // of the file it was read from
  ProblemKind kind = ProblemKind::kJoint;
  ImageSpec image;
  Camera camera;               // the view's, where `views` lists one
  bool camera_placed = false;  // from, to or a pose was given
  ViewsSpec views;
  bool SeveralViews() const { return views.several(); }
  GeometrySpec geometry;
  ReflectanceSpec reflectance;
  IlluminationSpec illumination;
  LikelihoodSpec likelihood;
  EffectsSpec effects;
  SolverSpec solver;
  TruthSpec truth;
  // For ibrdf_uncertainty alone.
  TextureSpec texture;
  UncertaintySpec uncertainty;
  // For ibrdf_render alone.
  RenderQuality quality = RenderQuality::kReference;
  double noise = 0.0;  // standard deviation of the log-normal noise, >= 0
};

}  // namespace ibrdf
