// The observed image: a file's values as radiance.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/io/photo.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/unknown_curve.h"

namespace ibrdf {

struct Photograph {
  // Linear radiance; of codes, that of a code's middle, or the one end that it
  // has: codes of white are clipped, and black has no lower end. NaN where
  // nothing is known.
  Image radiance;
  // The interval of each value, where the file holds codes (code_interval.h).
  std::optional<RadianceBounds> bounds;
  // Where the curve is to be found; `radiance` and `bounds` are then of the
  // first family's curve at its mean.
  std::optional<UnknownCurve> unknown_curve;
  Mask mask;           // of the object; empty: all pixels
  bool codes = false;  // the file holds whole numbers
  std::string curve;   // the response curve and who says so, in words
  // Pixels of the mask's file that the image lacks or hides.
  size_t missing = 0;
  // What was taken for granted or left out: sentences for the user.
  std::vector<std::string> warnings;
};

// Reads the image and its mask (ImageSpec). Pixels that the file lacks or that
// are transparent are outside the mask.
//
// Codes become radiance by the response curve (response_curve.h): the spec's,
// else the one that the file states, else sRGB for 8 bits. Floats are radiance
// unless the spec has a curve. Errors name file and field: a curve that nobody
// states, pixels that are not square, a mask of another size.
StatusOr<Photograph> LoadPhotograph(const ImageSpec& spec);

// Radiance that is known from both sides; NaN where codes are clipped, 0 where
// they are black.
Image KnownRadiance(const Photograph& observed);

// Warns of what the object's values say of the file: many of one greatest value
// (saturated), all multiples of 1/255 (codes in a file of floats).
std::vector<std::string> DoubtfulValues(const Image& radiance,
                                        const Mask& mask);

}  // namespace ibrdf
