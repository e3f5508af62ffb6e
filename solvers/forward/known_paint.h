// Paint over a known reflectance, f = a(x) f_matte + f_gloss.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/known_brdf.h"

namespace ibrdf {

struct KnownPaint {
  Image factor;               // a at every pixel of the image, finite, >= 0
  Eigen::Array3d mean;        // of a over the object's pixels
  KnownBrdf matte;            // f_matte (MattePart)
  size_t pixels_without = 0;  // of the object: 0 in all channels of the file

  // f_gloss + mean f_matte: what the object shows itself. `brdf`: unpainted.
  BrdfGrid MeanGrid(const KnownBrdf& brdf) const;
  MerlTable MeanTable(const KnownBrdf& brdf) const;
};

// points: of the image, all samples of its pixels; mask: their pixels. The
// file's values elsewhere are not looked at. A result knows no albedo where a
// pixel's centre misses the object: such a pixel, of fewer samples than others
// and 0 in the file, takes the mean of those around it. Errors name the file
// and the field.
StatusOr<KnownPaint> LoadKnownPaint(const PaintSpec& spec,
                                    const std::vector<ShadingPoint>& points,
                                    const Mask& mask, const KnownBrdf& brdf);

// L_o = whole + (a - 1) matte, at least 0: radiance [points, 3] of the
// unpainted object in, of the painted one out.
void AddPaint(const KnownPaint& paint, const std::vector<ShadingPoint>& points,
              const std::vector<double>& matte, double* whole);

}  // namespace ibrdf
