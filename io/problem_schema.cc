#include "ibrdf/io/problem_schema.h"

#include <glog/logging.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Range kPositive{0.0, kInfinity, false, true};
const Range kNotNegative{0.0, kInfinity, true, true};
const Range kUnitInterval{0.0, 1.0, true, true};
const Range kAnyNumber{};

constexpr char kTextureFiles[] = ".exr, .png";
constexpr char kMapFiles[] = ".exr, .hdr, .pfm, .tif, .npy";

// A map's far light and the solver's unknowns grow with these.
constexpr int kMaxMapSide = 8192;
constexpr int kMaxUnetChannels = 128;
constexpr int kMaxLobes = 8;
constexpr int kMaxTextureSide = 4096;
constexpr int kMaxOrder = 10;
constexpr double kMaxPixels = 1e6;
constexpr double kMaxDepthScale = 1e6;
constexpr double kMaxSeconds = 1e7;
constexpr int64_t kMaxIterations = 100000000;

constexpr unsigned kUnknownReflectance = kUsedByJoint | kUsedByReflectance;
constexpr unsigned kUnknownLight = kUsedByJoint | kUsedByIllumination;
constexpr unsigned kKnownReflectance = kUsedByIllumination | kUsedByRender;
constexpr unsigned kKnownLight =
    kUsedByReflectance | kUsedByRender | kUsedByTextures;
constexpr unsigned kPhotographs = kUsedBySolve | kUsedByTextures;
constexpr unsigned kSolveOrRender = kUsedBySolve | kUsedByRender;

using Words = std::vector<ProblemWord>;
using Keys = std::vector<ProblemKey>;

// Puts a key together. Type first, then what else there is to say.
class Row {
 public:
  Row(const std::string& path, const std::string& meaning) {
    key_.path = path;
    key_.meaning = meaning;
  }
  operator ProblemKey() const { return key_; }  // NOLINT

  Row& Number(const Range& range, const std::string& default_value) {
    key_.range = range;
    return Type(ValueType::kNumber, default_value);
  }
  Row& AutoOrNumber(const Range& range) {
    key_.range = range;
    return Type(ValueType::kAutoOrNumber, "auto");
  }
  Row& Integer(int64_t least, int64_t most, const std::string& default_value) {
    key_.least = least;
    key_.most = most;
    return Type(ValueType::kInteger, default_value);
  }
  Row& Triple(const Range& range, const std::string& default_value) {
    key_.range = range;
    return Type(ValueType::kTriple, default_value);
  }
  Row& OneOrTriple(const Range& range, const std::string& default_value) {
    key_.range = range;
    return Type(ValueType::kOneOrTriple, default_value);
  }
  Row& AutoOrTriple(const Range& range,
                    const std::string& default_value = "auto") {
    key_.range = range;
    return Type(ValueType::kAutoOrTriple, default_value);
  }
  Row& NumberList(const Range& range) {
    key_.range = range;
    return Type(ValueType::kNumberList, "");
  }
  Row& PathList(const std::string& files) {
    key_.files = files;
    return Type(ValueType::kPathList, "");
  }
  Row& Choice(const std::string& default_value, Words words) {
    key_.words = std::move(words);
    return Type(ValueType::kChoice, default_value);
  }
  Row& ChoiceOrMap(const std::string& default_value, Words words) {
    key_.words = std::move(words);
    return Type(ValueType::kChoiceOrMap, default_value);
  }
  Row& Pair(const Range& range) {
    key_.range = range;
    return Type(ValueType::kPair, "");
  }
  Row& NumberOrPath(const Range& range, const std::string& default_value) {
    key_.range = range;
    key_.files = kTextureFiles;
    return Type(ValueType::kNumberOrPath, default_value);
  }
  Row& TripleOrPath(const Range& range, const std::string& default_value) {
    key_.range = range;
    key_.files = kTextureFiles;
    return Type(ValueType::kTripleOrPath, default_value);
  }
  Row& OneOrPair(const Range& range) {
    key_.range = range;
    return Type(ValueType::kOneOrPair, "");
  }
  Row& Matrix() { return Type(ValueType::kMatrix, ""); }
  Row& WordOrList(const std::string& default_value, Words words, Words listed) {
    key_.words = std::move(words);
    key_.list_words = std::move(listed);
    return Type(ValueType::kWordOrList, default_value);
  }
  Row& Path(const std::string& files, const std::string& default_value = "") {
    key_.files = files;
    return Type(ValueType::kPath, default_value);
  }
  Row& Text() { return Type(ValueType::kText, ""); }
  Row& PathOrMap(const std::string& files) {
    key_.files = files;
    return Type(ValueType::kPathOrMap, "");
  }
  Row& OptionalMap() { return Type(ValueType::kOptionalMap, ""); }
  Row& ListOrMap() { return Type(ValueType::kListOrMap, ""); }

  Row& Unit(const std::string& unit) {
    key_.unit = unit;
    return *this;
  }
  Row& Without(const std::string& text) {
    key_.without = text;
    return *this;
  }
  Row& UsedBy(unsigned uses) {
    key_.used_by = uses;
    return *this;
  }
  Row& Needs(const std::string& what) {
    key_.needs = what;
    return *this;
  }
  Row& Formerly(const std::string& name) {
    key_.old_name = name;
    return *this;
  }
  Row& Notes(std::vector<std::string> notes) {
    key_.notes = std::move(notes);
    return *this;
  }
  Row& Example(const std::string& value) {
    key_.example = value;
    return *this;
  }

 private:
  Row& Type(ValueType type, const std::string& default_value) {
    key_.type = type;
    key_.default_value = default_value;
    return *this;
  }

  ProblemKey key_;
};

// Of MapFrame, in its order.
Words MapFrames() {
  return {
      {"camera",
       "The middle is what the camera looks at (-z), and right in the map is "
       "right in the picture."},
      {"openexr",
       "OpenEXR's `envmap`: the middle is +z, and the outer texels' centres "
       "are the borders; or a cube as a column."},
      {"mitsuba", "Mitsuba 3, and USD's dome light: the middle is +z."},
      {"blender", "Blender's Environment Texture: the left quarter is -z."},
      {"polyhaven_y_up",
       "Maps of Poly Haven in three.js; the same as `blender`."},
      {"debevec_probe", "The angular map of Debevec's probes, square."},
      {"cube_cross", "A cube: a cross (3:4 or 4:3) or OpenEXR's column (1:6)."},
      {"ibrdf_0_1",
       "This project's until version 0.1: `camera` mirrored left to right."}};
}

Words AutoOrMapFrames() {
  Words words = MapFrames();
  words.insert(words.begin(),
               {"auto",
                "What an OpenEXR file says (`ibrdf:frame`, which results "
                "carry, else `envmap`). Else `camera`."});
  return words;
}

Keys KindKeys() {
  return {
      Row("problem", "What is unknown, and so estimated.")
          .Choice("joint",
                  {{"joint", "Reflectance and illumination are both unknown."},
                   {"reflectance",
                    "The illumination is known, so `illumination.known` is "
                    "needed."},
                   {"illumination",
                    "The reflectance is known, so `reflectance.known` is "
                    "needed."},
                   {"textures",
                    "Roughness, gloss and albedo of every texel, of several "
                    "`views` under known light. `ibrdf_uncertainty` says what "
                    "they leave unknown."}})
          .UsedBy(kPhotographs)};
}

Keys ImageKeys() {
  return {
      Row("image", "The image to explain, or the size of the image to render.")
          .Without("needed")
          .Notes(
              {"A solve needs `file`. A render needs `width` and `height`. "
               "One problem cannot have both.",
               "With `problem: textures` it has neither: each of `views` has "
               "its file and mask, and the curve is that of all.",
               "An image has at most " + std::to_string(kMaxImagePixels) +
                   " pixels."}),
      Row("image.file",
          "The image: radiance up to one factor that may be unknown, or codes "
          "that `image.response` makes radiance.")
          .Path(".exr, .hdr, .pfm, .png, .jpg, .tif, .npy")
          .Unit("W/(m² sr)")
          .Without("needed by a solve")
          .UsedBy(kUsedBySolve)
          .Example("photo.exr"),
      Row("image.layer",
          "Layer or part of an OpenEXR file, as `ViewLayer.Combined`.")
          .Text()
          .Without("the beauty part")
          .UsedBy(kPhotographs),
      Row("image.response", "The curve that made the image's values.")
          .Choice("auto",
                  {{"auto",
                    "What the file says (cICP, ICC, sRGB, gAMA, EXIF). Floats "
                    "are linear, 8 bits that say nothing are sRGB; 16 bits "
                    "that say nothing are refused."},
                   {"linear", "Values are proportional to radiance."},
                   {"srgb", "IEC 61966-2-1."},
                   {"power", "value = radiance^(1/p)."},
                   {"aces",
                    "Narkowicz's fit of the ACES curve, scaled by "
                    "gamma^(-1/5)."},
                   {"reinhard", "Reinhard et al. 2002, Eq. 4, by `white`."},
                   {"log", "log(1 + mu x) / log(1 + mu)."},
                   {"unknown",
                    "Found with the rest: sRGB, `power` or `aces`, by "
                    "evidence. Files of codes alone."},
                   {"unknown_power", "`power`, and p is found."},
                   {"unknown_aces", "`aces`, and gamma is found."}})
          .UsedBy(kPhotographs),
      Row("image.response_parameter",
          "p, gamma, white or mu of the response. `auto`: the usual one.")
          .AutoOrNumber(kPositive)
          .UsedBy(kPhotographs),
      Row("image.white",
          "Codes from here on are clipped: of their radiance the least is "
          "known alone. `auto`: "
          "the file's largest code.")
          .AutoOrNumber(kPositive)
          .UsedBy(kPhotographs),
      Row("image.black", "The code of no light. `auto`: 0.")
          .AutoOrNumber(kNotNegative)
          .UsedBy(kPhotographs),
      Row("image.exposure",
          "Radiance is divided by it: seconds, say, where `image.brackets` has "
          "other exposures.")
          .Number(kPositive, "1")
          .UsedBy(kPhotographs),
      Row("image.brackets",
          "Further pictures of the same view at other exposures, of one size "
          "and curve. A value's radiance is what all pictures allow.")
          .PathList(".png, .jpg, .tif")
          .Without("none")
          .UsedBy(kUsedBySolve),
      Row("image.bracket_exposures", "The exposure of each of them.")
          .NumberList(kPositive)
          .Without("needed by `image.brackets`")
          .UsedBy(kUsedBySolve),
      Row("image.mask",
          "White pixels are the object. Without a mask, all pixels whose "
          "centre sees the geometry are.")
          .Path(".png")
          .UsedBy(kUsedBySolve)
          .Example("mask.png"),
      Row("image.width", "Width of the rendered image.")
          .Integer(1, kMaxImageSide, "")
          .Unit("pixels")
          .Without("needed by a render")
          .UsedBy(kUsedByRender),
      Row("image.height", "Height of the rendered image.")
          .Integer(1, kMaxImageSide, "")
          .Unit("pixels")
          .Without("needed by a render")
          .UsedBy(kUsedByRender)};
}

Keys CameraKeys() {
  const std::string pinhole = "camera.type: perspective";
  return {
      Row("camera",
          "The camera that took the image. "
          "[Conventions](conventions.md#frames) "
          "has its frame.")
          .Notes({"A calibrated camera has `world_from_camera` in place of "
                  "`from`, `to` and `up`, and `focal_pixels` in place of "
                  "`fov_degrees`.",
                  "A rotation may be rounded to three digits. A mirror image "
                  "or a scale is refused."}),
      Row("camera.type", "How the camera projects.")
          .Choice("orthographic",
                  {{"orthographic",
                    "Looks along -z. The shorter side of the image spans "
                    "[-1, 1], the longer one proportionally more."},
                   {"perspective", "A pinhole at `camera.from`."}}),
      Row("camera.fov_degrees", "Full vertical angle of view.")
          .Number({0.0, 180.0, false, false}, "30")
          .Unit("degrees")
          .Needs(pinhole),
      Row("camera.from", "Position of the camera. It differs from `camera.to`.")
          .Triple(kAnyNumber, "[0, 0, 4]")
          .Unit("scene units")
          .Needs(pinhole),
      Row("camera.to", "The point that is seen in the middle of the image.")
          .Triple(kAnyNumber, "[0, 0, 0]")
          .Unit("scene units")
          .Needs(pinhole),
      Row("camera.up", "Upward direction, not parallel to the view.")
          .Triple(kAnyNumber, "[0, 1, 0]")
          .Needs(pinhole),
      Row("camera.world_from_camera",
          "The pose: four rows of a rotation and the camera's centre. Columns: "
          "right, up, against the view (OpenGL), and the centre.")
          .Matrix()
          .Without("by `from`, `to` and `up`"),
      Row("camera.focal_pixels", "Focal length, along x and y.")
          .OneOrPair(kPositive)
          .Unit("pixels")
          .Without("by `fov_degrees`")
          .Needs(pinhole),
      Row("camera.centre_pixels",
          "Where the view meets the image, from its top left corner, x to the "
          "right and y down.")
          .Pair(kAnyNumber)
          .Unit("pixels")
          .Without("the middle")
          .Needs(pinhole)};
}

Keys ViewKeys() {
  return {
      Row("views",
          "Several cameras in place of `camera`: a list, or a file of "
          "another program. All are rendered in one run.")
          .ListOrMap()
          .UsedBy(kUsedByRender | kUsedByTextures)
          .Notes({"Each item of a list has a `name` and a `camera` with "
                  "the keys above: `views: [{name: left, camera: {...}}]`.",
                  "Results of a view have its name. Those of files are "
                  "named by their images.",
                  "With `views`, `geometry.fit` is `none` by default: "
                  "cameras and mesh share one frame.",
                  "The focal length of a file is scaled to the size of "
                  "`image`, which has its proportions.",
                  "With `problem: textures` each item has a `file` as well, "
                  "and may have a `mask`, as `image` has them: `{name: left, "
                  "file: left.exr, mask: left.png, camera: {...}}`.",
                  "A solve takes a list of one view, which is its camera."}),
      Row("views.transforms",
          "transforms.json of NeRF, Stanford-ORB or instant-ngp: poses in "
          "OpenGL's frame, of cameras without distortion.")
          .Path(".json")
          .UsedBy(kUsedByRender | kUsedByTextures),
      Row("views.colmap",
          "Folder of a model of COLMAP, text or binary, with PINHOLE or "
          "SIMPLE_PINHOLE cameras.")
          .Path("a folder")
          .UsedBy(kUsedByRender | kUsedByTextures),
      Row("views.images",
          "Folder of the images that the file or model names. A name without "
          "extension is that of a PNG.")
          .Path("a folder")
          .Without("the file's folder, or `colmap`")
          .Needs("problem: textures")
          .UsedBy(kUsedByTextures),
      Row("views.masks",
          "Folder of the views' masks, NAME.png each. Transparent pixels of an "
          "image are outside without a mask, too.")
          .Path("a folder")
          .Without("none")
          .Needs("problem: textures")
          .UsedBy(kUsedByTextures)};
}

// Of PictureAxis, in its order.
Words PictureAxes() {
  return {{"right", "To the right in the picture."},
          {"left", "To the left."},
          {"up", "To the picture's upper side."},
          {"down", "To its lower side."},
          {"toward", "Toward the camera."},
          {"away", "Away from the camera."}};
}

Keys GeometryKeys() {
  const std::string normals = "geometry.normals";
  Keys keys = {
      Row("geometry",
          "The shape of the object: exactly one of `sphere`, `mesh`, "
          "`normals` and `depth`.")
          .Without("needed")
          .Notes({"The outline of a sphere is in pixels from the image's top "
                  "left corner, x to the right and y down. The first pixel's "
                  "centre is at (0.5, 0.5).",
                  "Without `centre` and `radius` it is the unit sphere's, or, "
                  "where that overlaps the mask by less than 0.98, fitted to "
                  "the mask (orthographic camera).",
                  "A map of normals or depth has the image's size and is in "
                  "the camera's frame: with `camera.type: perspective` leave "
                  "out `camera.from`, `to` and `up`.",
                  "Depth grows away from the camera, along the view. Its unit "
                  "is a pixel's side before the orthographic camera, and any "
                  "before the perspective one.",
                  "Depths that are 0, not finite or beyond 1e8 are holes."}),
      Row("geometry.sphere", "A sphere: `{}`, or its outline in the picture.")
          .OptionalMap()
          .Example("{}"),
      Row("geometry.sphere.centre", "Of the outline.")
          .Pair({-kMaxPixels, kMaxPixels, true, true})
          .Unit("pixels"),
      Row("geometry.sphere.radius", "Of the outline.")
          .Number({0.0, kMaxPixels, false, true}, "")
          .Unit("pixels"),
      Row("geometry.mesh",
          "A mesh of polygons. It shadows and lights itself where that matters "
          "(`effects`).")
          .Path(".obj, .ply, .stl, .glb"),
      Row("geometry.normals",
          "One normal per pixel, in the camera's frame; "
          "zero is outside. Without positions there are no shadows.")
          .Path(".exr, .hdr, .pfm, .png, .tif, .npy"),
      Row("geometry.depth",
          "One depth per pixel, which gives the normals. Without positions "
          "there are no shadows.")
          .Path(".exr, .pfm, .png, .tif, .npy"),
      Row("geometry.depth_scale",
          "The file's values times it are depth. `auto`: 1, and it must be "
          "said of whole numbers. Negative, for the orthographic camera "
          "alone: the file is a map of heights.")
          .AutoOrNumber({-kMaxDepthScale, kMaxDepthScale, true, true})
          .Needs("geometry.depth"),
      Row("geometry.frame",
          "The axes of a normal map: a word, or a map that says where each "
          "points, as `{x: right, y: down, z: toward}`.")
          .ChoiceOrMap("opengl",
                       {{"opengl", "x right, y up, z toward the camera."},
                        {"opencv", "x right, y down, z away from the camera."}})
          .Needs(normals),
      Row("geometry.frame.x", "Where x points.")
          .Choice("", PictureAxes())
          .Without("`right`"),
      Row("geometry.frame.y", "Where y points.")
          .Choice("", PictureAxes())
          .Without("`up`"),
      Row("geometry.frame.z", "Where z points.")
          .Choice("", PictureAxes())
          .Without("`toward`"),
      Row("geometry.encoding", "How a normal map stores a component n.")
          .Choice("auto",
                  {{"auto",
                    "Files of whole numbers as `unit_0_1`; floats too, where "
                    "none is negative and lengths are far from 1."},
                   {"float", "As it is."},
                   {"unit_0_1", "(n + 1) / 2."}})
          .Needs(normals),
      Row("geometry.fit",
          "How a mesh is placed before the camera sees it. It must be said "
          "where `camera.from` or `camera.to` is given and `unit_sphere` would "
          "move the mesh.")
          .Choice("unit_sphere",
                  {{"unit_sphere",
                    "Its bounding box is centred at the origin, and its "
                    "farthest vertex is scaled to distance 1."},
                   {"none", "Its vertices stay as they are."}})
          .Needs("geometry.mesh")};
  // Several views need a surface.
  for (ProblemKey& key : keys) {
    for (const char* map :
         {"geometry.sphere.", "geometry.normals", "geometry.depth",
          "geometry.frame", "geometry.encoding"}) {
      if (key.path.rfind(map, 0) == 0) key.used_by = kSolveOrRender;
    }
  }
  return keys;
}

Keys ReflectanceKeys() {
  const std::string lobe = "reflectance.known.cook_torrance";
  const std::string principled = "reflectance.known.principled";
  return {
      Row("reflectance",
          "The BRDF of the object: a trained model where it is unknown, else "
          "`known`."),
      Row("reflectance.model",
          "Trained model of unknown BRDFs, from `ibrdf_train`. `default` is "
          "the "
          "one that comes with the programs.")
          .Path(".ibrdf", "default")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.lobes",
          "Number of lobes of the flow. Each has a code of the embedding and "
          "an RGB colour. A Lambertian lobe of the model is not counted.")
          .Integer(1, kMaxLobes, "2")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.prior_sigma",
          "Standard deviation of the Gaussian prior of codes. It holds for "
          "lobes "
          "that the model has no fits of, and for all with `solver.estimator: "
          "maximum`.")
          .Number(kPositive, "0.5")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.variation",
          "How the reflectance varies over the object.")
          .Choice("auto",
                  {{"auto",
                    "`albedo` where pixels of like normals far apart differ in "
                    "colour, or where colour has sharp edges that paint "
                    "explains better than mirrored light; else `none`."},
                   {"none", "One material."},
                   {"albedo",
                    "One gloss over paint: the albedo of what is matte is "
                    "found at every pixel, in `albedo.exr`."},
                   {"labels",
                    "Several materials, where `reflectance.labels` says."}})
          .UsedBy(kUnknownReflectance),
      Row("reflectance.labels",
          "Image of the materials, of the image's size: pixels of one value "
          "are of one material. At most 16 values on the object, without "
          "smoothed edges. Implies `variation: labels`.")
          .Path(".png")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.known",
          "The known BRDF: a MERL table, or one of `brdf`, `lambertian`, "
          "`cook_torrance` and `principled`, and perhaps paint over it, "
          "`albedo`.")
          .PathOrMap(".binary")
          .Without("needed")
          .UsedBy(kKnownReflectance),
      Row("reflectance.known.brdf", "A MERL table, to be painted.")
          .Path(".binary")
          .UsedBy(kKnownReflectance),
      Row("reflectance.known.albedo",
          "Paint: an image of the render's size, values >= 0. The matte part "
          "of the BRDF is multiplied by it, pixel by pixel; the gloss stays "
          "([programs](programs.md#painted-objects)).")
          .Path(".exr, .hdr, .pfm, .tif, .npy")
          .UsedBy(kUsedByRender),
      Row("reflectance.known.unpainted_albedo",
          "What the values of `albedo` are divided by. `auto`: the "
          "hemispherical albedo of the matte part, as for `albedo.exr` of a "
          "result.")
          .AutoOrTriple(kPositive, "1")
          .Needs("reflectance.known.albedo")
          .UsedBy(kUsedByRender),
      Row("reflectance.known.lambertian", "Albedo of a matte surface.")
          .OneOrTriple(kUnitInterval, "")
          .UsedBy(kKnownReflectance),
      Row(lobe,
          "A Lambertian part and one microfacet lobe (Cook and Torrance 1982).")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".diffuse", "Albedo of the Lambertian part.")
          .OneOrTriple(kUnitInterval, "0.3")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".specular", "Factor of the microfacet lobe.")
          .OneOrTriple(kNotNegative, "1")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".roughness", "Root mean square slope of the microfacets.")
          .OneOrTriple({1e-3, 10.0, true, true}, "0.1")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".f0", "Reflectance of a microfacet at normal incidence.")
          .OneOrTriple(kUnitInterval, "0.04")
          .UsedBy(kKnownReflectance),
      Row(principled,
          "The principled BRDF's base (Burley 2012): a diffuse part and one "
          "GGX "
          "lobe. A render takes textures ([programs](programs.md#textures)).")
          .UsedBy(kKnownReflectance),
      Row(principled + ".base", "Base colour; a PNG texture is in sRGB.")
          .TripleOrPath(kUnitInterval, "0.5")
          .UsedBy(kKnownReflectance),
      Row(principled + ".roughness",
          "Square root of GGX's alpha. Below 0.03 it is rendered as 0.03.")
          .NumberOrPath(kUnitInterval, "0.5")
          .UsedBy(kKnownReflectance),
      Row(principled + ".metallic", "0: dielectric, 1: metal.")
          .NumberOrPath(kUnitInterval, "0")
          .UsedBy(kKnownReflectance),
      Row(principled + ".specular",
          "F0 of the dielectric part divided by 0.08.")
          .NumberOrPath({0.0, 12.5, true, true}, "0.5")
          .UsedBy(kKnownReflectance)};
}

Keys IlluminationKeys() {
  return {
      Row("illumination",
          "The environment map: its size and prior where it is unknown, else "
          "`known`.")
          .Notes(
              {"One side alone sets the other: the map is twice as wide as "
               "high.",
               "Without a size, a solve resamples a known map to 128x64, or to "
               "256x128 if it has as many texels and no shadows are simulated.",
               "A render takes the map of a file as it is.",
               "`prior: process` takes at most " +
                   std::to_string(kMaxProcessSide) + " texels a side.",
               "A solve needs sides that can be halved often. Powers of two "
               "always can."}),
      Row("illumination.width", "Width of the map, an even number.")
          .Integer(8, kMaxMapSide, "128")
          .Unit("texels"),
      Row("illumination.height", "Height of the map.")
          .Integer(4, kMaxMapSide, "64")
          .Unit("texels"),
      Row("illumination.prior", "What is taken as natural light.")
          .Choice(
              "auto",
              {{"auto",
                "`process`. It is `unet` where `illumination.unet_channels` is "
                "set, with `solver.estimator: maximum`, and for maps of more "
                "than " +
                    std::to_string(kMaxProcessSide) + " texels a side."},
               {"process",
                "The map is the MAP estimate of a Gaussian process."},
               {"unet",
                "The map is a network's output, begun at that MAP estimate, "
                "which stays where the network fits less well."},
               {"none",
                "Texels are independent of each other. It is there for "
                "comparison."}})
          .UsedBy(kUnknownLight),
      Row("illumination.unet_channels",
          "Feature maps of every layer of the network but its skip branches. "
          "Its weights grow with their square, as does most of its time.")
          .Integer(1, kMaxUnetChannels, "32")
          .Needs("illumination.prior: unet")
          .UsedBy(kUnknownLight),
      Row("illumination.known",
          "The known illumination: an environment map, or `sky`.")
          .PathOrMap(kMapFiles)
          .Without("needed")
          .UsedBy(kKnownLight),
      Row("illumination.frame",
          "Which direction a texel of the known map stands for "
          "([frames](frames.md)).")
          .Choice("auto", AutoOrMapFrames())
          .Needs("illumination.known")
          .UsedBy(kKnownLight),
      Row("illumination.output_frame",
          "The frame of the maps that are written.")
          .Choice("camera", MapFrames()),
      Row("illumination.ambient",
          "Stray light beside the known map's. `auto`: found with the "
          "reflectance where pixels without light are not black. 0: none.")
          .AutoOrTriple(kNotNegative)
          .Unit("that of the image")
          .Needs("illumination.known")
          .UsedBy(kUsedByReflectance)};
}

Keys SkyKeys() {
  const std::string sky = "illumination.known.sky";
  Keys keys = {
      Row(sky,
          "An artificial map of sun, sky, clouds, buildings and ground. "
          "`{sky: {}}` takes all its defaults."),
      Row(sky + ".sun_theta_degrees",
          "Angle between the sun and the zenith (+y).")
          .Number({0.0, 90.0, true, true}, "40")
          .Unit("degrees"),
      Row(sky + ".sun_phi_degrees",
          "Azimuth of the sun, from behind the camera (+z) "
          "towards the right (+x).")
          .Number({-360.0, 360.0, true, true}, "60")
          .Unit("degrees"),
      Row(sky + ".sun_radius_degrees",
          "Where the sun's radiance has fallen to 1/e of its peak.")
          .Number({0.1, 30.0, true, true}, "1.5")
          .Unit("degrees"),
      Row(sky + ".sun_irradiance",
          "Irradiance by the sun on a surface that faces it.")
          .Number(kNotNegative, "3")
          .Unit("W/m²"),
      Row(sky + ".zenith_radiance", "Radiance of the clear sky overhead.")
          .Number(kPositive, "0.35")
          .Unit("W/(m² sr)"),
      Row(sky + ".haze", "A whiter horizon, and a wider glow around the sun.")
          .Number(kUnitInterval, "0.4"),
      Row(sky + ".clouds", "Strength of the clouds.")
          .Number(kUnitInterval, "0.6"),
      Row(sky + ".skyline", "Height of the buildings and of their windows.")
          .Number(kUnitInterval, "0.7"),
      Row(sky + ".ground_albedo", "Albedo of the ground.")
          .Number(kUnitInterval, "0.2")};
  for (ProblemKey& key : keys) key.used_by = kKnownLight;
  return keys;
}

Keys LikelihoodKeys() {
  return {
      Row("likelihood",
          "How far the render may differ from the image: log(render + epsilon) "
          "- log(image + epsilon) has a Laplacian distribution.")
          .Notes({"With `solver.estimator: marginal`, the search for the "
                  "reflectance estimates its own noise. `scale` then serves "
                  "the map."})
          .UsedBy(kUsedBySolve),
      Row("likelihood.scale",
          "Scale b of the Laplacian. `auto` lets it fall to the misfit, one "
          "outer iteration after another.")
          .AutoOrNumber(kPositive)
          .Unit("natural log")
          .UsedBy(kUsedBySolve),
      Row("likelihood.epsilon",
          "Radiance that is added before the logarithm. `auto` is 1e-5 of the "
          "object's mean radiance.")
          .AutoOrNumber(kNotNegative)
          .Unit("that of the image")
          .UsedBy(kUsedBySolve)};
}

Keys EffectsKeys() {
  return {
      Row("effects",
          "What is simulated beyond distant light without shadows: a word, or "
          "a "
          "list of effects.")
          .WordOrList(
              "auto",
              {{"auto",
                "Predicts by how much leaving out shadows or bounces would "
                "change the image, and simulates what matters."},
               {"all", "Shadows, and light of up to four bounces."},
               {"none", "None of the effects below."}},
              {{"visibility", "Shadows that a mesh casts on itself."},
               {"interreflection",
                "Light that a mesh throws on itself, up to four bounces. It "
                "implies `visibility`."},
               {"reflectance_map",
                "Some normals are rendered, and the rest interpolated. It "
                "needs "
                "an orthographic camera and no shadows.",
                kUsedByRender},
               {"harmonics",
                "The map in spherical harmonics. It is fast where the "
                "reflectance is not mirror-like.",
                kUsedByRender},
               {"gaussians",
                "The map as a mixture of spherical Gaussians. It is fast where "
                "the reflectance is not mirror-like.",
                kUsedByRender}})
          .UsedBy(kSolveOrRender)
          .Notes(
              {"Effects that are listed are simulated whether or not they "
               "matter. A single one needs no brackets.",
               "`harmonics` and `gaussians` know no shadows: neither goes with "
               "`visibility` or `interreflection`.",
               "A normal map has no positions, so it takes neither "
               "`visibility` nor `interreflection`.",
               "[Settings](settings.md#shadows-and-bounces) says when `auto` "
               "simulates what."})};
}

Row SolverMethodKey() {
  return Row("solver.method",
             "Optimiser of the map, or of both unknowns with `estimator: "
             "maximum`. Before a network, the Gaussian process is always "
             "optimised by `gauss_newton`.")
      .Choice("auto",
              {{"auto",
                "`gauss_newton` for a map, `alternating` for both unknowns."},
               {"alternating",
                "`gauss_newton` for the map and Ceres' trust region for the "
                "lobes, in turns."},
               {"gauss_newton",
                "Gauss-Newton by conjugate gradients, without a matrix."},
               {"lbfgs", "L-BFGS of Ceres."},
               {"adam", "The published schedule, as a reference."},
               {"trust_region",
                "Trust region of Ceres with dense matrices, for small maps "
                "only."}})
      .UsedBy(kUnknownLight);
}

Row QuadratureKey() {
  return Row("solver.quadrature",
             "How finely the integral over light directions is taken.")
      .Choice("standard",
              {{"coarse",
                "Half as many half-vectors about the highlight as `standard`, "
                "and blocks of the map twice as wide."},
               {"standard",
                "The map is summed in blocks, at most 64 along its width."},
               {"fine",
                "Twice as many half-vectors as `standard`, and blocks half as "
                "wide."}})
      .UsedBy(kUsedBySolve);
}

Keys SolverKeys() {
  return {
      Row("solver",
          "How the estimate is computed. "
          "[Settings](settings.md) says what each setting costs."),
      Row("solver.estimator", "What the reflectance maximises.")
          .Choice("marginal",
                  {{"marginal",
                    "Its posterior with the light integrated out. The map is "
                    "then the MAP estimate given it."},
                   {"maximum",
                    "The posterior of both at once, as published (Chen et al. "
                    "2020, Eq. 8). It is there for comparison."}})
          .UsedBy(kUsedByJoint),
      SolverMethodKey(),
      QuadratureKey(),
      Row("solver.gauge",
          "What sets the scale between reflectance and light, which no image "
          "tells ([conventions](conventions.md#scale)).")
          .Choice("prior",
                  {{"prior",
                    "The priors: the level is that of the training materials, "
                    "the hue the most probable one."},
                   {"grey_light",
                    "The light's mean over the sphere is grey. Its level is "
                    "that of `prior`."},
                   {"unit_light",
                    "The light's mean over the sphere is 1 in every channel."}})
          .Needs("problem: joint")
          .UsedBy(kUsedByJoint),
      Row("solver.seconds",
          "Time limit of the whole program, from reading files to writing "
          "results. It may end earlier.")
          .Number({0.0, kMaxSeconds, false, true}, "120")
          .Unit("s")
          .UsedBy(kUsedBySolve),
      Row("solver.tolerance",
          "An optimiser stops when a step lowers the cost by a smaller share "
          "than this.")
          .Number({0.0, 1.0, true, false}, "1e-4")
          .UsedBy(kUsedBySolve),
      Row("solver.max_iterations",
          "Limit of outer iterations, beside the time. 0 keeps the initial "
          "guess.")
          .Integer(0, kMaxIterations, "1000")
          .UsedBy(kUsedBySolve),
      Row("solver.seed",
          "Seed of a render's noise; in a solve, of the samples behind the "
          "expected error and of the network's first weights alone. Equal "
          "results are no sign of robustness.")
          .Integer(0, std::numeric_limits<int64_t>::max(), "")
          .Without("that of `--seed`")
          .UsedBy(kSolveOrRender)};
}

Keys TruthKeys() {
  return {
      Row("truth",
          "The truth, where it is known. The results then have metrics "
          "against it.")
          .UsedBy(kUsedBySolve),
      Row("truth.brdf", "True BRDF, a MERL table.")
          .Path(".binary")
          .UsedBy(kUsedBySolve)
          .Example("true_brdf.binary"),
      Row("truth.illumination", "True environment map.")
          .Path(kMapFiles)
          .UsedBy(kUsedBySolve)
          .Example("true_map.exr"),
      Row("truth.frame", "The frame of the true map, as `illumination.frame`.")
          .Choice("auto", AutoOrMapFrames())
          .Needs("truth.illumination")
          .UsedBy(kUsedBySolve)};
}

Keys TextureKeys() {
  const std::string needs = "problem: textures";
  Keys keys = {
      Row("texture",
          "The picture that the surface is mapped to: by the mesh's own "
          "texture coordinates, else by charts of ours; of a sphere by "
          "longitude and latitude."),
      Row("texture.width", "Its width.")
          .Integer(1, kMaxTextureSide, "256")
          .Unit("texels"),
      Row("texture.height", "Its height.")
          .Integer(1, kMaxTextureSide, "256")
          .Unit("texels"),
      Row("uncertainty",
          "What `ibrdf_uncertainty` takes the views to tell of a texel "
          "([theory](theory.md))."),
      Row("uncertainty.evaluator", "The model of what a texel reflects.")
          .Choice(
              "angular",
              {{"angular",
                "Radiance at every view, with Fresnel's reflectance and "
                "masking; roughness, gloss and albedo are unknown."},
               {"spectrum",
                "The power of each degree of the harmonics, as published "
                "(Wiersma et al. 2025); roughness and gloss are unknown."}}),
      Row("uncertainty.order", "Highest degree of the harmonics.")
          .Integer(1, kMaxOrder, "5"),
      Row("uncertainty.sigma",
          "Standard deviation of radiance: what noise and a simple model may "
          "miss. `auto`: 0.07 with `angular`, 0.05 with `spectrum`.")
          .AutoOrNumber(kPositive)
          .Unit("mean radiance of the light"),
      Row("uncertainty.shadows", "Whether the object hides light from itself.")
          .Choice("none",
                  {{"none", "It hides none, as published."},
                   {"mirror",
                    "Light that it hides in the mirror direction is left "
                    "out."}})};
  for (ProblemKey& key : keys) {
    key.used_by = kUsedByTextures;
    if (!key.Parent().empty()) key.needs = needs;
  }
  return keys;
}

Keys RenderKeys() {
  return {
      Row("noise",
          "Standard deviation of the log-normal noise that a render is "
          "multiplied by.")
          .Number(kUnitInterval, "0")
          .Unit("natural log")
          .UsedBy(kUsedByRender),
      Row("quality", "How exactly the image is rendered.")
          .Choice(
              "reference",
              {{"preview",
                "One sample per pixel, four where neighbours differ, and a "
                "coarser quadrature."},
               {"reference", "Four samples per pixel and a fine quadrature."}})
          .UsedBy(kUsedByRender)};
}

ProblemSchema MakeSchema() {
  ProblemSchema schema;
  for (const auto& section :
       {KindKeys(), ImageKeys(), CameraKeys(), ViewKeys(), GeometryKeys(),
        ReflectanceKeys(), IlluminationKeys(), SkyKeys(), LikelihoodKeys(),
        EffectsKeys(), SolverKeys(), TruthKeys(), TextureKeys(),
        RenderKeys()}) {
    schema.keys.insert(schema.keys.end(), section.begin(), section.end());
  }
  return schema;
}

}  // namespace

const ProblemKey& ProblemSchema::Key(const std::string& path) const {
  const auto key =
      std::find_if(keys.begin(), keys.end(),
                   [&](const ProblemKey& k) { return k.path == path; });
  CHECK(key != keys.end()) << "no key " << path;
  return *key;
}

std::vector<std::string> ProblemSchema::NamesBelow(
    const std::string& map) const {
  std::vector<std::string> names;
  for (const ProblemKey& key : keys) {
    if (key.Parent() == map) names.push_back(key.Name());
  }
  return names;
}

const ProblemSchema& ProblemFileSchema() {
  static const ProblemSchema schema = MakeSchema();
  return schema;
}

}  // namespace ibrdf
