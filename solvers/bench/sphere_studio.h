// Many materials on the sphere of report/brdf_sphere.h, under one sky.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// The geometry is prepared once; a material then costs one sum over it.
class SphereStudio {
 public:
  // Images of size x size pixels; 0 outside the sphere.
  SphereStudio(int size, const BrdfGridShape& grid, int num_threads);

  Image Render(const BrdfGrid& brdf) const;
  // Factor that shows a Lambertian sphere of albedo 0.5 just below white.
  double exposure() const { return exposure_; }
  int size() const { return size_; }

 private:
  int size_;
  double exposure_ = 1.0;
  Image sky_;
  std::vector<ShadingPoint> points_;
  std::unique_ptr<Transport> transport_;
};

}  // namespace ibrdf
