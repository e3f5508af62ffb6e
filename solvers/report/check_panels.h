// The images of the look before a solve, each as linear display colours in
// [0, 1] of the photograph's size.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/photograph_check/photograph_check.h"
#include "ibrdf/solvers/problem/load_object.h"

namespace ibrdf {

// The photograph, its object's 99th percentile white; pixels that are no number
// are white.
Image ExposedPhotograph(const Image& radiance, const Mask& mask);

// Normals as (n + 1) / 2 in sRGB over the darkened photograph.
Image NormalColours(const std::vector<ShadingPoint>& points,
                    const Image& photograph);

// A matte white object under a lamp at the upper left, on a dark ground.
Image LampLit(const std::vector<ShadingPoint>& points, int width, int height);

// The same of a normal map; black where normals face away from the camera.
Image LampLit(const Image& normals, const Mask& mask);

// White: mask and object; red: the mask alone; blue: the object alone.
Image MaskAndShape(const Mask& mask, const Mask& silhouette);

// Colours of MarkedPixels.
enum class Mark { kClipped, kZero, kNegative, kNotFinite, kUnseen };
inline constexpr int kNumMarks = 5;
const char* NameOf(Mark mark);
void ColourOf(Mark mark, float rgb[3]);

// The photograph in dark grey, and what takes no part in colour.
Image MarkedPixels(const ObjectLook& look,
                   const std::vector<ShadingPoint>& points,
                   const Image& photograph);

// Deviations of colour among like normals, white 0 to dark red 0.3 and more.
Image ColourDeviations(const LikeNormalsSpread& spread,
                       const std::vector<ShadingPoint>& points, int width,
                       int height);

}  // namespace ibrdf
