#include "ibrdf/io/chromaticities.h"

#include <Eigen/LU>

namespace ibrdf {
namespace {

constexpr double kSameCoordinate = 1e-3;
// Primaries whose triangle is smaller than this, relative to XYZ's, span none.
constexpr double kMinDeterminant = 1e-9;
// Largest entry of a matrix between colour spaces that are meant.
constexpr double kMaxEntry = 1e6;

Eigen::Vector3d Xyz(const Eigen::Vector2d& xy) {
  return {xy.x(), xy.y(), 1.0 - xy.x() - xy.y()};
}

}  // namespace

bool AreSamePrimaries(const PrimaryColours& a, const PrimaryColours& b) {
  const auto near = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return (p - q).cwiseAbs().maxCoeff() <= kSameCoordinate;
  };
  return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) &&
         near(a.white, b.white);
}

std::optional<Eigen::Matrix3d> RgbToXyz(const PrimaryColours& primaries) {
  Eigen::Matrix3d columns;
  columns << Xyz(primaries.red), Xyz(primaries.green), Xyz(primaries.blue);
  if (!columns.allFinite() || !primaries.white.allFinite()) return std::nullopt;
  const double white_y = primaries.white.y();
  if (!(std::fabs(columns.determinant()) > kMinDeterminant) ||
      !(white_y > kMinDeterminant)) {
    return std::nullopt;
  }
  const Eigen::Vector3d white = Xyz(primaries.white) / white_y;
  const Eigen::Vector3d scales = columns.inverse() * white;
  const Eigen::Matrix3d matrix = columns * scales.asDiagonal();
  if (!matrix.allFinite() || matrix.cwiseAbs().maxCoeff() > kMaxEntry ||
      !(std::fabs(matrix.determinant()) > kMinDeterminant)) {
    return std::nullopt;
  }
  return matrix;
}

std::optional<Eigen::Matrix3d> RgbToRec709(const PrimaryColours& primaries) {
  const std::optional<Eigen::Matrix3d> to_xyz = RgbToXyz(primaries);
  if (!to_xyz) return std::nullopt;
  const Eigen::Matrix3d rec709 = *RgbToXyz(PrimaryColours());
  return rec709.inverse() * *to_xyz;
}

}  // namespace ibrdf
