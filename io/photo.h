// A photograph as its file holds it: values, curve, masks, tags.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/exif.h"
#include "ibrdf/io/image_limits.h"

namespace ibrdf {

enum class PhotoFormat { kPng, kJpeg, kTiff, kExr, kRadianceHdr, kPfm, kNpy };

// The format's name: PNG, JPEG, TIFF, OpenEXR, Radiance HDR, PFM, NumPy.
const char* NameOf(PhotoFormat format);

enum class PhotoContent {
  kColour,
  kNormals,  // three channels, whose names may be X, Y, Z; no colour conversion
  kDepth,    // one, whose name may be Z; or several, which the caller compares
};

struct PhotoOptions {
  // `layer` names a layer or part of an OpenEXR file, as "ViewLayer.Combined"
  // or, where that names one alone, "Combined". Empty: the rule of photo_exr.h.
  std::string layer;
  PhotoContent content = PhotoContent::kColour;
  ImageLimits limits;
};

enum class CurveKind {
  kUnknown,  // the file says nothing that is understood
  kLinear,
  kSrgb,
  kPower,  // code value = (radiance / white)^(1 / exponent)
  kOther,  // the file names a curve which is none of these
};

struct CurveStatement {
  CurveKind kind = CurveKind::kUnknown;
  double exponent = 1.0;  // of kPower
  // Who says so, in words: "gAMA 0.45455", "ICC profile 'Display P3'". Where
  // the curve is unknown: what else was found, or empty.
  std::string source;
};

// What an ICC profile says.
struct IccProfile {
  std::string description;   // UTF-8, without control characters; may be empty
  std::string colour_space;  // four letters: "RGB ", "GRAY", "CMYK"
  CurveKind curve = CurveKind::kUnknown;  // kOther: tables of other curves
  double exponent = 1.0;                  // of kPower
  bool other_primaries = false;           // than those of Rec. 709
};

// Colour tags of a file as they stand there.
struct ColourTags {
  std::optional<double> png_gamma;  // gAMA: exponent of encoding, 0.45455
  bool png_srgb = false;            // the sRGB chunk
  // cICP (ITU-T H.273): primaries, transfer, matrix, full range.
  std::optional<std::array<int, 4>> cicp;
  std::optional<IccProfile> icc;
  std::optional<int> exif_colour_space;  // 1 sRGB, 2 Adobe RGB, 65535 other
  bool exif_adobe_rgb = false;           // interoperability index R03
  bool png_other_primaries = false;      // cHRM is not Rec. 709
};

// OpenEXR's attribute `envmap`.
enum class ExrEnvmap { kLatLong, kCube };

// The name of OpenEXR's text attribute by which our files say their frame.
inline constexpr char kMapFrameAttribute[] = "ibrdf:frame";

struct Photo {
  PhotoFormat format = PhotoFormat::kPng;
  // Codes as they stand in the file, 0 to 2^bits - 1, or floats; upright, row 0
  // the top, grey files with three like channels. Floats of OpenEXR have the
  // primaries of Rec. 709. NaN, infinite and negative floats are kept.
  Image image;
  int bits = 0;              // of the codes; 0: floats
  int significant_bits = 0;  // fewer than bits where PNG's sBIT says so
  bool grey = false;         // one channel in the file
  // Pixels of alpha >= 0.99. Empty where there is no alpha, where it is so
  // everywhere, or nowhere (a note says that). Colours are left as they are.
  Mask opaque;
  // Pixels that the file holds: the data window in OpenEXR's display window.
  // Empty: all. The others are 0 in `image`.
  Mask has_data;
  double pixel_aspect = 1.0;  // width of a pixel over its height
  ColourTags tags;
  CurveStatement curve;  // what the tags, or the format, say
  // The file says that its primaries are not those of Rec. 709, and the values,
  // being codes, were not converted.
  bool other_primaries = false;
  int orientation = 1;              // of EXIF, 1 to 8; it has been undone
  std::string layer;                // of OpenEXR: the one read; may be empty
  std::vector<std::string> layers;  // of OpenEXR: all that may be asked for
  // Environment maps of OpenEXR have these: the standard attribute `envmap`,
  // and the text of the attribute `ibrdf:frame`; empty where there is none.
  std::optional<ExrEnvmap> envmap;
  std::string map_frame;
  // From EXIF, where it says them.
  std::optional<double> exposure_seconds, f_number, iso;
  // What was done to the picture or left undone: sentences for the user.
  std::vector<std::string> notes;
};

// By precedence cICP, ICC, sRGB, gAMA, EXIF; `floats`: values without any such
// tag are linear.
CurveStatement StateCurve(const ColourTags& tags, bool floats);

// Undoes the EXIF orientation (1 to 8): stored pixels -> upright ones.
Image Upright(const Image& stored, int orientation);
Mask Upright(const Mask& stored, int orientation);

// alpha: [height * width] in [0, 1]. Sets `opaque` and notes what it is.
void SetAlpha(const std::vector<float>& alpha, Photo* photo);

// Notes orientation (not undone yet), colour space and exposure; a damaged
// block makes a note.
void AddExif(const ExifTags& exif, Photo* photo);

// Refuses a picture whose pixels are not as wide as high.
Status CheckSquarePixels(const std::string& path, const Photo& photo);

// Control characters become '?', so that text of a file stays one line.
std::string Printable(const std::string& text);

}  // namespace ibrdf
