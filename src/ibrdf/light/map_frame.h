// Frames of environment maps: which texel of an image stands for which
// direction, by the conventions of several programs.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/light/cube_layout.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {

// Directions go from the object towards the light, in the axes of the camera: x
// right, y up, z toward the viewer. The camera looks along -z. Below, u in [0,
// 1] runs over the image from left to right and v from top to bottom. A
// latlong frame has theta = pi v from +y.
//
// kCamera. phi = 2 pi u - pi, direction = (sin theta sin phi, cos theta, -sin
//   theta cos phi). The middle is what the camera looks at, -z, and right in
//   the map is right in the picture. This is the latitude-longitude format of
//   Debevec's high-resolution probes (vgl.ict.usc.edu/Data/HighResProbes), of
//   skylibs and of nvdiffrec.
//
// kOpenExr. ImfEnvmap.h of OpenEXR 3.1. A latlong map has longitude l = pi - 2
//   pi u and direction = (sin theta sin l, cos theta, sin theta cos l): the
//   middle is +z and the left quarter +x. By the same header a texel is a
//   point, and the centres of the first and last columns are u = 0 and u = 1,
//   those of the first and last rows v = 0 and v = 1. USD's DomeLight and most
//   writers take the axes from there, but put the EDGES of the image at 0 and
//   1; such a map has the frame kMitsuba. We follow the header, which is what
//   the file's attribute `envmap` promises and what exrenvmap computes.
//   An image of 1:6 is OpenEXR's cube (CubeLayout::kColumn).
//
// kMitsuba. The emitter `envmap` of Mitsuba 3 with to_world = identity
//   (src/emitters/envmap.cpp, uv_to_direction): phi = 2 pi u, direction = (sin
//   theta sin phi, cos theta, -sin theta cos phi). The middle is +z. Mitsuba's
//   world is ours: y up, right-handed. Its interpolation puts the centres of
//   the first and last ROWS at v = 0 and v = 1, up to half a row from where the
//   image has them; older versions put the centres of columns at u = c / W,
//   half a column off. We follow the formula, with texel centres at
//   half-integers.
//
// kBlender. The world's Environment Texture, Equirectangular, without a mapping
//   (Cycles, kernel/camera/projection.h): the map's middle is Blender's +X, its
//   left quarter +Y, and +Z is up. Blender's X, Y, Z are our x, -z, y: what
//   Blender's front view looks at, +Y, is what our camera looks at. So phi = 2
//   pi u - pi / 2, direction = (sin theta sin phi, cos theta, -sin theta cos
//   phi): the left quarter is -z, the middle +x.
//
// kPolyHavenYUp. A map of Poly Haven in a viewer whose y is up, by three.js
//   (equirectUv in its shader chunk `common`), on which web viewers build: u =
//   atan2(z, x) / (2 pi) + 1/2. Poly Haven publishes no axes of its own. Its
//   maps are made for Blender, and with the exchange of axes above the two
//   frames are the same.
//
// kDebevecProbe. The angular map of the light probe gallery
//   (pauldebevec.com/Probes), square. With U = 2 u - 1 to the right and V = 1 -
//   2 v up, r = sqrt(U^2 + V^2) <= 1 is the angle from -z over pi and
//   atan2(V, U) the angle about it from +x to +y. The middle is straight
//   forward, the rim straight backward; beyond it nothing is stored. The page
//   says three things: in words, that the middle is forward and -z is the
//   forward axis; a rotation of (0, 0, -1), which taken as right-handed mirrors
//   the image left to right; a formula, r = acos(Dz) / pi / sqrt(Dx^2 + Dy^2),
//   U = Dx r, V = Dy r, which has the middle at +z and mirrors it too. We keep
//   the words and U along Dx, V along Dy, which seen from within is not
//   mirrored. skylibs does the same.
//
// kCubeCross. The faces of a cube: a vertical cross (3:4), a horizontal one
//   (4:3) or OpenEXR's column (1:6). See CubeLayout.
//
// kIbrdf01. What this project used until version 0.1 (environment_map.h): phi =
//   2 pi u, direction = (sin theta sin phi, cos theta, sin theta cos phi). The
//   middle is -z; right in the map is LEFT in the picture.
enum class MapFrame {
  kCamera,
  kOpenExr,
  kMitsuba,
  kBlender,
  kPolyHavenYUp,
  kDebevecProbe,
  kCubeCross,
  kIbrdf01,
};

constexpr std::array<MapFrame, 8> kMapFrames = {
    MapFrame::kCamera,    MapFrame::kOpenExr,      MapFrame::kMitsuba,
    MapFrame::kBlender,   MapFrame::kPolyHavenYUp, MapFrame::kDebevecProbe,
    MapFrame::kCubeCross, MapFrame::kIbrdf01};

// The frame of all maps in memory (environment_map.h).
constexpr MapFrame kLibraryMapFrame = MapFrame::kIbrdf01;

// The word of problem files: camera, openexr, mitsuba, blender, polyhaven_y_up,
// debevec_probe, cube_cross, ibrdf_0_1.
const char* MapFrameName(MapFrame frame);

// The frame of a word. `where` is the file and field for the message, which
// lists the words.
StatusOr<MapFrame> ParseMapFrame(const std::string& where,
                                 const std::string& name);

// Whether an image of this size can be a map of this frame. The message names
// the frame, the size, what the frame takes, and the frames that take the size.
//   2:1   all frames but debevec_probe and cube_cross
//   1:1   debevec_probe
//   3:4, 4:3, with a width divisible by 3 or 4   cube_cross
//   1:6   cube_cross, openexr
Status CheckMapSize(const std::string& where, MapFrame frame, MapSize size);

// The size of a map of this frame whose texels are about as fine as those of a
// latlong map of `rows` rows. A cube is a vertical cross.
MapSize SizeForRows(MapFrame frame, int rows);

// The rows of a latlong map whose texels are about as fine as those of a map
// of this frame and size, which CheckMapSize accepts. It is >= 1.
int RowsForSize(MapFrame frame, MapSize size);

// A point of an image, in texels from its top left corner; the centre of texel
// (r, c) is (c + 1/2, r + 1/2).
struct MapPoint {
  double column = 0.0, row = 0.0;
};

// The texels of a map of one frame and size, as regions of the sphere. Each
// direction belongs to one texel. Where the centres of outer texels lie on the
// border of the sphere's image (openexr), the image's outer half texels stand
// for nothing. Immutable.
class MapGrid {
 public:
  // CHECKs what CheckMapSize accepts.
  MapGrid(MapFrame frame, MapSize size);

  MapFrame frame() const { return frame_; }
  MapSize size() const { return size_; }

  // Unit direction of a point, none where the image stands for nothing.
  std::optional<Eigen::Vector3d> Direction(const MapPoint& point) const;
  std::optional<Eigen::Vector3d> TexelDirection(int texel) const;

  // The point of a direction (any length > 0), the inverse of Direction. On
  // the seams of the map it is one of the points that stand for it.
  MapPoint Position(const Eigen::Vector3d& direction) const;

  // The texel, row * width + column, to which a point with a direction belongs.
  // Texels of a probe whose centre is beyond the rim own nothing: what the rim
  // cuts off belongs to their neighbour inward.
  int TexelAt(const MapPoint& point) const;
  int TexelOf(const Eigen::Vector3d& direction) const {
    return TexelAt(Position(direction));
  }

  // What of a texel stands for something: its square, or the half or quarter of
  // one whose centre is on a border. The rim of a probe is not regarded.
  struct TexelBounds {
    MapPoint low, high;
  };
  TexelBounds Bounds(int column, int row) const;

  // Solid angle per area of the image at a point with a direction, sr per
  // texel.
  double Density(const MapPoint& point) const;

  // Solid angle of each texel, sr; 0 where it stands for nothing. The sum is 4
  // pi. Exact, but for a probe, where it is sampled.
  std::vector<double> SolidAngles() const;

  // What a latlong frame is made of: phi = 2 pi (sign u + quarters / 4),
  // direction = (sin theta sin phi, cos theta, -sin theta cos phi). None for
  // probes and cubes.
  struct LatLong {
    int sign, quarters;
    bool nodes;  // centres of the outer texels at u, v = 0 and 1
  };
  const std::optional<LatLong>& latlong() const { return latlong_; }

  // Borders of columns in u, of rows in v: ascending from 0 to 1. Latlong only.
  std::vector<double> ColumnEdges() const;
  std::vector<double> RowEdges() const;

 private:
  std::optional<Eigen::Vector3d> LatLongDirection(const MapPoint& point) const;
  std::optional<Eigen::Vector3d> ProbeDirection(const MapPoint& point) const;
  std::optional<Eigen::Vector3d> CubeDirection(const MapPoint& point) const;
  MapPoint CubePosition(const Eigen::Vector3d& direction) const;
  bool IsBlank(int column, int row) const;  // of a cube
  std::vector<double> LatLongSolidAngles() const;
  std::vector<double> CubeSolidAngles() const;
  std::vector<double> ProbeSolidAngles() const;

  MapFrame frame_;
  MapSize size_;
  std::optional<LatLong> latlong_;
  std::optional<CubeLayout> cube_;
  int face_size_ = 0;  // of a cube, texels
};

}  // namespace ibrdf
