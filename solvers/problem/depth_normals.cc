#include "ibrdf/solvers/problem/depth_normals.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

namespace ibrdf {
namespace {

// Depth jumps where it differs from one neighbour by more than this many
// pixels' sides, and by this factor more than from the one opposite: a smooth
// surface bends less from pixel to pixel.
constexpr double kJump = 2.0;
constexpr double kJumpFactor = 3.0;

class Surface {
 public:
  Surface(const DepthMap& map, const Camera& camera)
      : map_(map),
        perspective_(camera.type == CameraType::kPerspective),
        grid_(PixelGridOf(camera, map.width, map.height)) {
    // An orthographic camera's depth is in pixels.
    if (!perspective_) grid_.side.setOnes();
  }

  bool Has(int x, int y) const {
    return x >= 0 && x < map_.width && y >= 0 && y < map_.height &&
           std::isfinite(Depth(x, y));
  }

  double Depth(int x, int y) const {
    return map_.depth[static_cast<size_t>(y) * map_.width + x];
  }

  // In the camera's frame; only differences count before an orthographic one.
  Eigen::Vector3d Position(int x, int y) const {
    const double depth = Depth(x, y);
    const double scale = perspective_ ? depth : 1.0;
    return {(x + 0.5 - grid_.centre.x()) * (grid_.side.x() * scale),
            (grid_.centre.y() - y - 0.5) * (grid_.side.y() * scale), -depth};
  }

  // Along x (dx = 1, dy = 0) or along y; unset: no neighbour.
  std::optional<Eigen::Vector3d> Tangent(int x, int y, int dx, int dy) const {
    bool before = Has(x - dx, y - dy), after = Has(x + dx, y + dy);
    if (!before && !after) return std::nullopt;
    if (before && after) {
      const double here = Depth(x, y);
      const double side = (dx != 0 ? grid_.side.x() : grid_.side.y()) *
                          (perspective_ ? here : 1.0);
      const double from = std::abs(here - Depth(x - dx, y - dy)) / side;
      const double to = std::abs(Depth(x + dx, y + dy) - here) / side;
      if (to > kJump && to > kJumpFactor * from) after = false;
      if (from > kJump && from > kJumpFactor * to) before = false;
    }
    return Position(x + (after ? dx : 0), y + (after ? dy : 0)) -
           Position(x - (before ? dx : 0), y - (before ? dy : 0));
  }

 private:
  const DepthMap& map_;
  bool perspective_;
  PixelGrid grid_;
};

}  // namespace

DepthNormals NormalsOfDepth(const DepthMap& map, const Camera& camera) {
  const Surface surface(map, camera);
  DepthNormals out;
  out.normals = Image(map.width, map.height);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!surface.Has(x, y)) continue;
      ++out.known;
      const auto right = surface.Tangent(x, y, 1, 0);
      const auto down = surface.Tangent(x, y, 0, 1);
      const Eigen::Vector3d normal =
          right.has_value() && down.has_value()
              ? Eigen::Vector3d(down->cross(*right).stableNormalized())
              : Eigen::Vector3d::Zero();
      if (!normal.allFinite() || normal.isZero()) {
        ++out.isolated;
        continue;
      }
      Eigen::Map<Eigen::Vector3f>(out.normals.At(x, y)) = normal.cast<float>();
    }
  }
  return out;
}

}  // namespace ibrdf
