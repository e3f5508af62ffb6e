#include "ibrdf/light/cube_layout.h"

#include <glog/logging.h>

#include <array>
#include <cmath>

namespace ibrdf {
namespace {

using Faces = std::array<CubeFace, 6>;
using Axis = Eigen::Vector3i;

// In the order of FaceOfDirection: +x, -x, +y, -y, +z, -z.
Faces MakeVerticalCross() {
  return {{{2, 1, Axis(1, 0, 0), Axis(0, 0, 1), Axis(0, 1, 0)},
           {0, 1, Axis(-1, 0, 0), Axis(0, 0, -1), Axis(0, 1, 0)},
           {1, 0, Axis(0, 1, 0), Axis(1, 0, 0), Axis(0, 0, 1)},
           {1, 2, Axis(0, -1, 0), Axis(1, 0, 0), Axis(0, 0, -1)},
           {1, 3, Axis(0, 0, 1), Axis(1, 0, 0), Axis(0, -1, 0)},
           {1, 1, Axis(0, 0, -1), Axis(1, 0, 0), Axis(0, 1, 0)}}};
}

// The same but for the face +z, which follows +x and so is upright.
Faces MakeHorizontalCross() {
  Faces faces = MakeVerticalCross();
  faces[4] = {3, 1, Axis(0, 0, 1), Axis(-1, 0, 0), Axis(0, 1, 0)};
  return faces;
}

Faces MakeColumn() {
  Faces faces = MakeHorizontalCross();
  for (int i = 0; i < 6; ++i) {
    faces[i].across = 0;
    faces[i].down = i;
  }
  return faces;
}

const Faces& FacesOf(CubeLayout layout) {
  static const Faces vertical = MakeVerticalCross();
  static const Faces horizontal = MakeHorizontalCross();
  static const Faces column = MakeColumn();
  switch (layout) {
    case CubeLayout::kVerticalCross:
      return vertical;
    case CubeLayout::kHorizontalCross:
      return horizontal;
    case CubeLayout::kColumn:
      return column;
  }
  LOG(FATAL) << "unknown layout of a cube";
}

}  // namespace

CubeCells CellsOf(CubeLayout layout) {
  switch (layout) {
    case CubeLayout::kVerticalCross:
      return {3, 4};
    case CubeLayout::kHorizontalCross:
      return {4, 3};
    case CubeLayout::kColumn:
      return {1, 6};
  }
  LOG(FATAL) << "unknown layout of a cube";
}

const CubeFace* FaceAtCell(CubeLayout layout, int across, int down) {
  for (const CubeFace& face : FacesOf(layout)) {
    if (face.across == across && face.down == down) return &face;
  }
  return nullptr;
}

const CubeFace& FaceOfDirection(CubeLayout layout,
                                const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return FacesOf(layout)[2 * axis + (direction[axis] < 0.0 ? 1 : 0)];
}

double FaceSolidAngle(double x, double y) {
  return std::atan2(x * y, std::sqrt(1.0 + x * x + y * y));
}

}  // namespace ibrdf
