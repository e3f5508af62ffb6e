#include "ibrdf/light/map_frame.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// An axis of `count` texels over [0, 1]. With nodes the outer texels' centres
// are 0 and 1; a single texel then covers all.
struct Axis {
  int count;
  bool nodes;

  Axis(int texels, bool at_nodes)
      : count(texels), nodes(at_nodes && texels > 1) {}
  double first() const { return nodes ? 0.5 : 0.0; }
  double span() const { return nodes ? count - 1.0 : count; }
  double Unit(double texels) const { return (texels - first()) / span(); }
  double Texels(double unit) const { return first() + unit * span(); }
  bool Covers(double texels) const {
    return texels >= first() && texels <= first() + span();
  }
  std::vector<double> Edges() const {
    std::vector<double> edges(count + 1);
    for (int i = 0; i <= count; ++i) {
      edges[i] = std::clamp(Unit(i), 0.0, 1.0);
    }
    return edges;
  }
};

std::optional<MapGrid::LatLong> LatLongOf(MapFrame frame) {
  switch (frame) {
    case MapFrame::kCamera:
      return MapGrid::LatLong{1, -2, false};
    case MapFrame::kOpenExr:
      return MapGrid::LatLong{1, 0, true};
    case MapFrame::kMitsuba:
      return MapGrid::LatLong{1, 0, false};
    case MapFrame::kBlender:
    case MapFrame::kPolyHavenYUp:
      return MapGrid::LatLong{1, -1, false};
    case MapFrame::kIbrdf01:
      return MapGrid::LatLong{-1, 2, false};
    case MapFrame::kDebevecProbe:
    case MapFrame::kCubeCross:
      return std::nullopt;
  }
  LOG(FATAL) << "unknown frame of a map";
}

bool HasShape(MapSize size, int64_t across, int64_t down) {
  return size.width > 0 && size.height > 0 && size.width % across == 0 &&
         size.width * down == size.height * across;
}

std::optional<CubeLayout> CubeOf(MapFrame frame, MapSize size) {
  const bool cross = frame == MapFrame::kCubeCross;
  if ((cross || frame == MapFrame::kOpenExr) && HasShape(size, 1, 6)) {
    return CubeLayout::kColumn;
  }
  if (cross && HasShape(size, 3, 4)) return CubeLayout::kVerticalCross;
  if (cross && HasShape(size, 4, 3)) return CubeLayout::kHorizontalCross;
  return std::nullopt;
}

bool Accepts(MapFrame frame, MapSize size) {
  if (CubeOf(frame, size).has_value()) return true;
  if (frame == MapFrame::kDebevecProbe) return HasShape(size, 1, 1);
  return LatLongOf(frame).has_value() && HasShape(size, 2, 1);
}

const char* ShapesOf(MapFrame frame) {
  switch (frame) {
    case MapFrame::kDebevecProbe:
      return "a square image";
    case MapFrame::kCubeCross:
      return "a vertical cross (3:4), a horizontal cross (4:3) or a column of "
             "faces (1:6)";
    case MapFrame::kOpenExr:
      return "a width of twice the height (2:1, latlong) or a column of faces "
             "(1:6)";
    default:
      return "a width of twice the height (2:1)";
  }
}

// Texels of a map: their numbers fit an int32 with room for sums.
constexpr int64_t kMaxTexels = int64_t{1} << 30;

// Points per side of a texel of a probe whose solid angle is summed: of texels
// on the probe, and of those that the rim cuts.
constexpr int kProbeSamples = 4;
constexpr int kRimSamples = 16;

bool InProbe(double x, double y) { return x * x + y * y <= 1.0; }

}  // namespace

const char* MapFrameName(MapFrame frame) {
  switch (frame) {
    case MapFrame::kCamera:
      return "camera";
    case MapFrame::kOpenExr:
      return "openexr";
    case MapFrame::kMitsuba:
      return "mitsuba";
    case MapFrame::kBlender:
      return "blender";
    case MapFrame::kPolyHavenYUp:
      return "polyhaven_y_up";
    case MapFrame::kDebevecProbe:
      return "debevec_probe";
    case MapFrame::kCubeCross:
      return "cube_cross";
    case MapFrame::kIbrdf01:
      return "ibrdf_0_1";
  }
  LOG(FATAL) << "unknown frame of a map";
}

StatusOr<MapFrame> ParseMapFrame(const std::string& where,
                                 const std::string& name) {
  std::string names;
  for (const MapFrame frame : kMapFrames) {
    if (name == MapFrameName(frame)) return frame;
    names += std::string(names.empty() ? "" : ", ") + MapFrameName(frame);
  }
  return InvalidInput(where, "expected one of " + names + ", found " + name);
}

Status CheckMapSize(const std::string& where, MapFrame frame, MapSize size) {
  const int64_t texels = int64_t{size.width} * size.height;
  if (size.width > 0 && size.height > 0 && texels > kMaxTexels) {
    return InvalidInput(
        where, "expected at most " + std::to_string(kMaxTexels) +
                   " texels, found " + SizeName(size.width, size.height));
  }
  if (Accepts(frame, size)) return OkStatus();
  std::string fitting;
  for (const MapFrame other : kMapFrames) {
    if (!Accepts(other, size)) continue;
    fitting += std::string(fitting.empty() ? "" : ", ") + MapFrameName(other);
  }
  return InvalidInput(
      where, std::string("frame ") + MapFrameName(frame) + " expects " +
                 ShapesOf(frame) + ", found " +
                 SizeName(size.width, size.height) + " texels, " +
                 (fitting.empty() ? std::string("which fits no frame")
                                  : "which fits " + fitting));
}

MapSize SizeForRows(MapFrame frame, int rows) {
  CHECK_GT(rows, 0);
  switch (frame) {
    case MapFrame::kDebevecProbe:  // pi from the middle to the rim
      return {2 * rows, 2 * rows};
    case MapFrame::kCubeCross: {  // pi / 2 over a face
      const int face = (rows + 1) / 2;
      return {3 * face, 4 * face};
    }
    default:
      return {2 * rows, rows};
  }
}

int RowsForSize(MapFrame frame, MapSize size) {
  const Status status = CheckMapSize("map", frame, size);
  CHECK(status.ok()) << status.message();
  if (const std::optional<CubeLayout> cube = CubeOf(frame, size)) {
    return 2 * size.width / CellsOf(*cube).across;  // pi / 2 over a face
  }
  return frame == MapFrame::kDebevecProbe ? (size.height + 1) / 2 : size.height;
}

MapGrid::MapGrid(MapFrame frame, MapSize size) : frame_(frame), size_(size) {
  const Status status = CheckMapSize("map", frame, size);
  CHECK(status.ok()) << status.message();
  cube_ = CubeOf(frame, size);
  if (cube_.has_value()) {
    face_size_ = size.width / CellsOf(*cube_).across;
  } else {
    latlong_ = LatLongOf(frame);
  }
}

std::optional<Eigen::Vector3d> MapGrid::Direction(const MapPoint& point) const {
  if (latlong_.has_value()) return LatLongDirection(point);
  return cube_.has_value() ? CubeDirection(point) : ProbeDirection(point);
}

std::optional<Eigen::Vector3d> MapGrid::LatLongDirection(
    const MapPoint& point) const {
  const Axis across(size_.width, latlong_->nodes);
  const Axis down(size_.height, latlong_->nodes);
  if (!across.Covers(point.column) || !down.Covers(point.row)) return {};
  const double turns =
      latlong_->sign * across.Unit(point.column) + 0.25 * latlong_->quarters;
  const double phi = 2.0 * kPi * turns, theta = kPi * down.Unit(point.row);
  const double s = std::sin(theta);
  return Eigen::Vector3d(s * std::sin(phi), std::cos(theta),
                         -s * std::cos(phi));
}

std::optional<Eigen::Vector3d> MapGrid::ProbeDirection(
    const MapPoint& point) const {
  const double x = 2.0 * point.column / size_.width - 1.0;
  const double y = 1.0 - 2.0 * point.row / size_.height;
  if (!InProbe(x, y)) return {};
  const double r = std::sqrt(x * x + y * y);
  if (r == 0.0) return Eigen::Vector3d(0.0, 0.0, -1.0);
  const double s = std::sin(kPi * r) / r;
  return Eigen::Vector3d(s * x, s * y, -std::cos(kPi * r));
}

std::optional<Eigen::Vector3d> MapGrid::CubeDirection(
    const MapPoint& point) const {
  if (!(point.column >= 0.0 && point.column <= size_.width &&
        point.row >= 0.0 && point.row <= size_.height)) {
    return {};
  }
  // Borders of a face belong to it, whatever cell is beyond.
  const int texel = TexelAt(point);
  const int across = texel % size_.width / face_size_;
  const int down = texel / size_.width / face_size_;
  const CubeFace* face = FaceAtCell(*cube_, across, down);
  const Axis axis(face_size_, *cube_ == CubeLayout::kColumn);
  const double column = point.column - across * face_size_;
  const double row = point.row - down * face_size_;
  if (face == nullptr || !axis.Covers(column) || !axis.Covers(row)) return {};
  return face->At(2.0 * axis.Unit(column) - 1.0, 1.0 - 2.0 * axis.Unit(row))
      .normalized();
}

std::optional<Eigen::Vector3d> MapGrid::TexelDirection(int texel) const {
  return Direction({texel % size_.width + 0.5, texel / size_.width + 0.5});
}

MapPoint MapGrid::Position(const Eigen::Vector3d& direction) const {
  if (cube_.has_value()) return CubePosition(direction);
  const double x = direction.x(), y = direction.y(), z = direction.z();
  // atan2 keeps full precision beside the poles, where acos loses half of it.
  if (latlong_.has_value()) {
    const double theta = std::atan2(std::sqrt(x * x + z * z), y);
    const double turns = std::atan2(x, -z) / (2.0 * kPi);
    double u = latlong_->sign * (turns - 0.25 * latlong_->quarters);
    u -= std::floor(u);
    return {Axis(size_.width, latlong_->nodes).Texels(u),
            Axis(size_.height, latlong_->nodes).Texels(theta / kPi)};
  }
  const double s = std::sqrt(x * x + y * y);
  const double r = std::min(std::atan2(s, -z) / kPi, 1.0);
  // Straight backward is the whole rim; its rightmost point stands for it.
  const double across = s > 0.0 ? r * x / s : r;
  const double up = s > 0.0 ? r * y / s : 0.0;
  return {0.5 * (1.0 + across) * size_.width, 0.5 * (1.0 - up) * size_.height};
}

MapPoint MapGrid::CubePosition(const Eigen::Vector3d& direction) const {
  const CubeFace& face = FaceOfDirection(*cube_, direction);
  const double depth = direction.dot(face.forward.cast<double>());
  const double across = direction.dot(face.right.cast<double>()) / depth;
  const double up = direction.dot(face.up.cast<double>()) / depth;
  const Axis axis(face_size_, *cube_ == CubeLayout::kColumn);
  // The face's right and lower borders are the next cell's, which need not be
  // its neighbour on the cube: stay a rounding before them.
  const auto place = [&](int cell, double unit) {
    const double end = (cell + 1.0) * face_size_;
    return std::min(cell * face_size_ + axis.Texels(unit),
                    std::nextafter(end, 0.0));
  };
  return {place(face.across, 0.5 * (1.0 + across)),
          place(face.down, 0.5 * (1.0 - up))};
}

int MapGrid::TexelAt(const MapPoint& point) const {
  int column = std::clamp(static_cast<int>(point.column), 0, size_.width - 1);
  int row = std::clamp(static_cast<int>(point.row), 0, size_.height - 1);
  if (cube_.has_value()) {
    // The right and lower borders of a face may be a blank cell's left and
    // upper ones.
    if (IsBlank(column, row)) {
      if (column > 0 && !IsBlank(column - 1, row)) {
        --column;
      } else if (row > 0) {
        --row;
      }
    }
  } else if (!latlong_.has_value()) {
    // Inward along the longer coordinate until the centre is on the probe.
    const int64_t side = size_.width;
    for (int step = 0; step < 2; ++step) {
      const int64_t x = 2 * column + 1 - side, y = 2 * row + 1 - side;
      if (x * x + y * y <= side * side) break;
      if (std::abs(x) >= std::abs(y)) {
        column -= x > 0 ? 1 : -1;
      } else {
        row -= y > 0 ? 1 : -1;
      }
    }
  }
  return row * size_.width + column;
}

bool MapGrid::IsBlank(int column, int row) const {
  return FaceAtCell(*cube_, column / face_size_, row / face_size_) == nullptr;
}

MapGrid::TexelBounds MapGrid::Bounds(int column, int row) const {
  const bool nodes =
      latlong_.has_value() ? latlong_->nodes : cube_ == CubeLayout::kColumn;
  const Axis across(cube_.has_value() ? face_size_ : size_.width, nodes);
  const Axis down(cube_.has_value() ? face_size_ : size_.height, nodes);
  const int left = column % across.count, top = row % down.count;
  const int column0 = column - left, row0 = row - top;  // of the face
  return {{column0 + std::max<double>(left, across.first()),
           row0 + std::max<double>(top, down.first())},
          {column0 + std::min<double>(left + 1, across.first() + across.span()),
           row0 + std::min<double>(top + 1, down.first() + down.span())}};
}

double MapGrid::Density(const MapPoint& point) const {
  if (latlong_.has_value()) {
    const Axis across(size_.width, latlong_->nodes);
    const Axis down(size_.height, latlong_->nodes);
    return std::sin(kPi * std::clamp(down.Unit(point.row), 0.0, 1.0)) *
           (kPi / down.span()) * (2.0 * kPi / across.span());
  }
  if (!cube_.has_value()) {
    const double x = 2.0 * point.column / size_.width - 1.0;
    const double y = 1.0 - 2.0 * point.row / size_.height;
    const double r = std::min(std::sqrt(x * x + y * y), 1.0);
    // With angle a = pi r: sin a da dphi over r dr dphi.
    const double per_area = r > 0.0 ? kPi * std::sin(kPi * r) / r : kPi * kPi;
    return per_area * 4.0 / (static_cast<double>(size_.width) * size_.height);
  }
  const Axis axis(face_size_, *cube_ == CubeLayout::kColumn);
  const double x = 2.0 * axis.Unit(std::fmod(point.column, face_size_)) - 1.0;
  const double y = 2.0 * axis.Unit(std::fmod(point.row, face_size_)) - 1.0;
  const double length2 = 1.0 + x * x + y * y;
  return 4.0 / (axis.span() * axis.span() * length2 * std::sqrt(length2));
}

std::vector<double> MapGrid::ColumnEdges() const {
  CHECK(latlong_.has_value());
  return Axis(size_.width, latlong_->nodes).Edges();
}

std::vector<double> MapGrid::RowEdges() const {
  CHECK(latlong_.has_value());
  return Axis(size_.height, latlong_->nodes).Edges();
}

std::vector<double> MapGrid::SolidAngles() const {
  if (latlong_.has_value()) return LatLongSolidAngles();
  return cube_.has_value() ? CubeSolidAngles() : ProbeSolidAngles();
}

std::vector<double> MapGrid::LatLongSolidAngles() const {
  const std::vector<double> columns = ColumnEdges(), rows = RowEdges();
  std::vector<double> angles(size_.num_texels());
  for (int r = 0; r < size_.height; ++r) {
    // cos(a) - cos(b) as a product: exact for thin rows at the poles.
    const double band = 4.0 * kPi *
                        std::sin(0.5 * kPi * (rows[r] + rows[r + 1])) *
                        std::sin(0.5 * kPi * (rows[r + 1] - rows[r]));
    for (int c = 0; c < size_.width; ++c) {
      angles[static_cast<size_t>(r) * size_.width + c] =
          band * (columns[c + 1] - columns[c]);
    }
  }
  return angles;
}

std::vector<double> MapGrid::CubeSolidAngles() const {
  const int n = face_size_;
  const std::vector<double> edges =
      Axis(n, *cube_ == CubeLayout::kColumn).Edges();
  std::vector<double> corners(static_cast<size_t>(n + 1) * (n + 1));
  for (int r = 0; r <= n; ++r) {
    for (int c = 0; c <= n; ++c) {
      corners[static_cast<size_t>(r) * (n + 1) + c] =
          FaceSolidAngle(2.0 * edges[c] - 1.0, 2.0 * edges[r] - 1.0);
    }
  }
  std::vector<double> angles(size_.num_texels());
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      if (IsBlank(x, y)) continue;
      const double* corner =
          corners.data() + static_cast<size_t>(y % n) * (n + 1) + x % n;
      angles[static_cast<size_t>(y) * size_.width + x] =
          corner[n + 2] - corner[n + 1] - corner[1] + corner[0];
    }
  }
  return angles;
}

std::vector<double> MapGrid::ProbeSolidAngles() const {
  const int side = size_.width;
  std::vector<double> angles(size_.num_texels());
  double total = 0.0;
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      // The corner of the texel that is farthest from the middle.
      const double x = std::abs(2.0 * c + 1.0 - side) + 1.0;
      const double y = std::abs(2.0 * r + 1.0 - side) + 1.0;
      const bool whole = InProbe(x / side, y / side);
      const int samples = whole ? kProbeSamples : kRimSamples;
      for (int k = 0; k < samples * samples; ++k) {
        const MapPoint point = {c + (k % samples + 0.5) / samples,
                                r + (k / samples + 0.5) / samples};
        if (!ProbeDirection(point).has_value()) continue;
        const double angle = Density(point) / (samples * samples);
        angles[TexelAt(point)] += angle;
        total += angle;
      }
    }
  }
  for (double& angle : angles) angle *= 4.0 * kPi / total;
  return angles;
}

}  // namespace ibrdf
