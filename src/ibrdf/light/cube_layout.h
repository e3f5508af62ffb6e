// Images that hold the six faces of a cube: crosses and OpenEXR's column.
#pragma once
#include <Eigen/Core>
#include <optional>

namespace ibrdf {

// Every face is drawn as it looks from within the cube. The axes are those of
// the camera: x right, y up, z toward the viewer, so that the face -z is what
// the camera looks at.
//
//   kVerticalCross, 3N x 4N      kHorizontalCross, 4N x 3N      kColumn, N x 6N
//
//       +-----+                      +-----+                        +x
//       | +y  |                      | +y  |                        -x
//   +-----+-----+-----+          +-----+-----+-----+-----+          +y
//   | -x  | -z  | +x  |          | -x  | -z  | +x  | +z  |          -y
//   +-----+-----+-----+          +-----+-----+-----+-----+          +z
//         | -y  |                      | -y  |                      -z
//         +-----+                      +-----+
//         | +z  |
//         +-----+
//
// The vertical cross is that of HDR Shop and of Debevec's gallery of light
// probes (Reinhard et al., High Dynamic Range Imaging, section 9.4.4): its last
// face, +z, stands on its head, as the folded paper has it. The book prints the
// mapping twice, and the half "world to image" turns the faces -y and +z by 180
// degrees against the half "image to world". We follow "image to world", which
// alone is continuous across the edges; skylibs (soravux/skylibs,
// envmap/projections.py) does the same.
//
// The horizontal cross is the other way to unfold the same cube, as in the
// Haskell package bitmap-opengl: left, front, right, back, all upright.
//
// The column is OpenEXR's (ImfEnvmap.h, "Cube Map"). Its faces +x, -x, +z, -z
// are upright; +z is at the top of the face +y and at the bottom of -y. Unlike
// in the crosses the centres of a face's outer texels lie ON the edges of the
// cube, so that neighbouring faces repeat them.
enum class CubeLayout { kVerticalCross, kHorizontalCross, kColumn };

// Faces of an image side by side and above one another.
struct CubeCells {
  int across = 0, down = 0;
};
CubeCells CellsOf(CubeLayout layout);

// One face: its place in the image, in faces from the top left, and its axes
// as seen from within: a point at x, y in [-1, 1] of the face (x to the right,
// y up) is the direction forward + x right + y up, not normalised.
struct CubeFace {
  int across, down;
  Eigen::Vector3i forward, right, up;

  Eigen::Vector3d At(double x, double y) const {
    return forward.cast<double>() + x * right.cast<double>() +
           y * up.cast<double>();
  }
};

// The face at a place of the image, none in the blank corners of a cross.
// Static storage.
const CubeFace* FaceAtCell(CubeLayout layout, int across, int down);

// The face that a direction (any length > 0) meets.
const CubeFace& FaceOfDirection(CubeLayout layout,
                                const Eigen::Vector3d& direction);

// Solid angle between the middle of a face and its point x, y, with the sign of
// x y: the rectangle [x0, x1] x [y0, y1] has F(x1, y1) - F(x0, y1) - F(x1, y0)
// + F(x0, y0), sr.
double FaceSolidAngle(double x, double y);

}  // namespace ibrdf
