// Edges of paint: where colour changes sharply and the surface does not turn.
#pragma once
#include <vector>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

// Lines on the object across which log R/G and log B/G change by at least
// kSharpStep within a few pixels. Paint has them; a mirror's image of the world
// and the rim of a highlight on coloured plastic have some, too: they say that
// there may be paint, not that there is.
//
// Their length, over the object's size, the square root of its pixels: the same
// at any resolution. Slanted lines count up to a quarter more.
double SharpColourSteps(const std::vector<NormalSample>& samples,
                        int image_width, int image_height);

// A colour and another with a half more in one channel.
inline constexpr double kSharpStep = 0.4;
// From here on paint is worth a question: a line once across the object.
inline constexpr double kMayBePainted = 1.0;

}  // namespace ibrdf
