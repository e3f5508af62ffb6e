// Pictures that show which directions the texels of a map stand for.
#pragma once
#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// `map`: radiance in `frame`, of a size that CheckMapSize accepts. The map's
// 97th percentile is shown as white.

// The map as its file has it, max_side pixels or fewer on its longer side, with
// a dot and a name at six directions: up, down, left, right, ahead (what the
// camera looks at, -z) and behind (what is behind it). Arrows at `ahead` point
// towards the right (red) and up (blue). Texels that stand for nothing are
// grey.
Rgb8Image DrawMapAxes(const Image& map, MapFrame frame, int max_side = 512);

// A mirror ball in the map's light, from edge to edge, as the orthographic
// camera sees it. Where the normal is n = (x, y, n_z), x and y the place in the
// ball, it shows the direction 2 n_z n - (0, 0, 1): the middle shows what is
// behind the camera.
Rgb8Image DrawMirrorBall(const Image& map, MapFrame frame, int diameter = 256);

// Both beside each other, with the frame's name.
Rgb8Image DrawMapFrame(const Image& map, MapFrame frame);

}  // namespace ibrdf
