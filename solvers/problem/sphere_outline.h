// Where in the picture a sphere is that the problem does not place.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// Overlaps (intersection over union): the sphere stays where it touches the
// image's shorter sides from the first on; the mask is a circle from the second
// on, and not at all below the third.
inline constexpr double kFillsImage = 0.98;
inline constexpr double kIsCircle = 0.95;
inline constexpr double kLeastCircle = 0.9;

// The outline before an orthographic camera, by the mask; empty: no mask.
// Unset: the unit sphere, which touches the image's shorter sides. So it is
// where it overlaps the mask by kFillsImage, where the mask's circle is within
// a pixel of it, where the mask is no circle and the unit sphere covers it, and
// where no circle fits better. Warns where an outline is fitted. Fails where
// the mask is no circle and reaches beyond the unit sphere. path: of the mask
// or image, for messages.
StatusOr<std::optional<PixelCircle>> FindSphereOutline(
    const Mask& mask, const std::string& path,
    std::vector<std::string>* warnings);

}  // namespace ibrdf
