// A photograph of codes whose response curve is to be found.
#pragma once
#include <optional>
#include <vector>

#include "ibrdf/image/code_interval.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/image/response_curve.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// A kind of curve. Its parameter, where it has one to be found, has a normal
// log a priori, cut to the range of ParameterOf.
struct CurveFamily {
  ResponseKind kind = ResponseKind::kSrgb;
  bool has_parameter = false;
  double log_mean = 0.0, log_std = 1.0;
};

// The families of a choice from kUnknown on:
//   power  log p: mean log 2.2, deviation 0.2: from 1.5 to 3.3 at two
//          deviations, which holds the gammas of cameras, films and displays;
//   aces   log gamma: mean log 0.5, RobIR's initial value, deviation 0.7;
//   srgb   nothing to be found.
std::vector<CurveFamily> FamiliesOf(ResponseChoice choice);

struct UnknownCurve {
  Image codes;  // whole numbers
  CodeLevels levels;
  std::vector<CurveFamily> families;
};

struct DecodedCodes {
  // The radiance of a code's middle, or the one end that it has; NaN where
  // nothing is known.
  Image radiance;
  RadianceBounds bounds;
};

// Codes by a curve (code_interval.h).
DecodedCodes DecodeCodes(const ResponseCurve& curve, const CodeLevels& levels,
                         const Image& codes);

}  // namespace ibrdf
