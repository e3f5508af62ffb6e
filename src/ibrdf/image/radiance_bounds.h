// An image whose radiance is known between bounds alone.
#pragma once
#include "ibrdf/image/image.h"

namespace ibrdf {

// Ends of RadianceInterval per pixel and channel, images of one size: low 0 and
// high infinite where there is none.
struct RadianceBounds {
  Image low, high;
};

}  // namespace ibrdf
