// One interface for what renders points: the reference renderer, an
// approximation, or a scene with all its effects.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

// A renderer of a fixed map and reflectance; each call chooses the points.
class RadianceRenderer {
 public:
  // A renderer calls it with the share of the call's points that are done, in
  // [0, 1], from the calling thread; false stops the call. It may be empty.
  using Progress = std::function<bool(double share)>;

  virtual ~RadianceRenderer() = default;

  // L_o [points, 3] is the radiance that the points send along wo, W/(m^2 sr),
  // >= 0, for points in any number and order. The result is false where
  // `progress` stopped the call; L_o is then incomplete. One thread at a time
  // may call it (it is parallel inside).
  virtual bool Render(const std::vector<ShadingPoint>& points,
                      const Progress& progress, double* L_o) const = 0;
};

}  // namespace ibrdf
