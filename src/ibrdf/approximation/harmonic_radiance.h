// Any points under a map in spherical harmonics.
#pragma once
#include <vector>

#include "ibrdf/approximation/harmonic_transport.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

class HarmonicRadiance final : public RadianceRenderer {
 public:
  // map and grid must outlive this; options.grid is the grid's shape.
  HarmonicRadiance(const Image& map, const BrdfGrid& grid,
                   const HarmonicOptions& options)
      : map_(map), grid_(grid), options_(options) {}

  // Unshadowed points; what rings below 0 is taken as 0. `progress` may stop it
  // before the first point alone.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override;

 private:
  const Image& map_;
  const BrdfGrid& grid_;
  const HarmonicOptions options_;
};

}  // namespace ibrdf
