#include "ibrdf/solvers/problem/circle_fit.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace ibrdf {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr size_t kFewestPoints = 12;
constexpr int kTriples = 300;
// So many points at most are tried on a circle through three.
constexpr size_t kMostTried = 2000;
// Points of a drawn circle are nearer than this, in pixels, to what was drawn;
// those of one drawn by hand, nearer than a share of its size.
constexpr double kNear = 1.5;
constexpr double kNearShare = 0.025;
constexpr int kRefinements = 10;

Points BoundaryPoints(const Mask& mask) {
  Points points;
  const auto inside = [&](int x, int y) {
    return mask.inside[static_cast<size_t>(y) * mask.width + x] != 0;
  };
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (x + 1 < mask.width && inside(x, y) != inside(x + 1, y)) {
        points.emplace_back(x + 1.0, y + 0.5);
      }
      if (y + 1 < mask.height && inside(x, y) != inside(x, y + 1)) {
        points.emplace_back(x + 0.5, y + 1.0);
      }
    }
  }
  return points;
}

double Distance(const PixelCircle& circle, const Eigen::Vector2d& p) {
  return std::abs(std::hypot(p.x() - circle.x, p.y() - circle.y) -
                  circle.radius);
}

// Kasa's fit: least squares of x^2 + y^2 = 2 c . p + q, linear in c and q.
std::optional<PixelCircle> AlgebraicFit(const Points& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixX3d a(rows, 3);
  Eigen::VectorXd b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Vector2d p = points[static_cast<size_t>(i)] - mean;
    a.row(i) << 2.0 * p.x(), 2.0 * p.y(), 1.0;
    b[i] = p.squaredNorm();
  }
  const Eigen::Vector3d s = a.colPivHouseholderQr().solve(b);
  const double squared = s.z() + s.head<2>().squaredNorm();
  if (!s.allFinite() || !(squared > 0.0)) return std::nullopt;
  return PixelCircle{mean.x() + s.x(), mean.y() + s.y(), std::sqrt(squared)};
}

// Gauss-Newton's steps on the distances.
PixelCircle LeastSquares(const Points& points, PixelCircle circle) {
  for (int step = 0; step < kRefinements; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d d(p.x() - circle.x, p.y() - circle.y);
      const double length = d.norm();
      if (!(length > 0.0)) continue;
      const Eigen::Vector3d row(d.x() / length, d.y() / length, 1.0);
      normal += row * row.transpose();
      right += row * (length - circle.radius);
    }
    const Eigen::Vector3d move = normal.colPivHouseholderQr().solve(right);
    if (!move.allFinite()) break;
    circle.x += move.x();
    circle.y += move.y();
    circle.radius += move.z();
    if (move.norm() < 1e-9) break;
  }
  return circle;
}

// The circle through three points that most of them are near to.
std::optional<PixelCircle> ThroughThree(const Points& points, double near) {
  Points tried;
  const size_t count = std::min(points.size(), kMostTried);
  for (size_t k = 0; k < count; ++k) {
    tried.push_back(points[(2 * k + 1) * points.size() / (2 * count)]);
  }
  std::mt19937 random(1);
  std::optional<PixelCircle> best;
  double least = near * static_cast<double>(tried.size());
  for (int triple = 0; triple < kTriples; ++triple) {
    Points three;
    for (int k = 0; k < 3; ++k) three.push_back(tried[random() % tried.size()]);
    const std::optional<PixelCircle> circle = AlgebraicFit(three);
    if (!circle.has_value()) continue;
    double sum = 0.0;
    for (const Eigen::Vector2d& p : tried) {
      sum += std::min(Distance(*circle, p), near);
    }
    if (sum >= least) continue;
    least = sum;
    best = circle;
  }
  return best;
}

Points NearTo(const PixelCircle& circle, const Points& points, double near) {
  Points out;
  for (const Eigen::Vector2d& p : points) {
    if (Distance(circle, p) < near) out.push_back(p);
  }
  return out;
}

}  // namespace

double CircleOverlap(const Mask& mask, const PixelCircle& circle) {
  size_t both = 0, either = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const bool in_mask =
          mask.inside[static_cast<size_t>(y) * mask.width + x] != 0;
      const bool in_circle =
          std::hypot(x + 0.5 - circle.x, y + 0.5 - circle.y) < circle.radius;
      both += in_mask && in_circle;
      either += in_mask || in_circle;
    }
  }
  return either > 0 ? static_cast<double>(both) / static_cast<double>(either)
                    : 0.0;
}

std::optional<CircleFit> FitCircle(const Mask& mask) {
  const Points points = BoundaryPoints(mask);
  if (points.size() < kFewestPoints) return std::nullopt;
  const double near = std::max(
      kNear, kNearShare * std::sqrt(static_cast<double>(mask.CountInside())));
  std::optional<PixelCircle> circle = ThroughThree(points, near);
  // Twice: the first fit brings the points of a rough circle near.
  for (int pass = 0; pass < 2 && circle.has_value(); ++pass) {
    const Points kept = NearTo(*circle, points, near);
    if (kept.size() < kFewestPoints) return std::nullopt;
    circle = AlgebraicFit(kept);
    if (circle.has_value()) circle = LeastSquares(kept, *circle);
  }
  if (!circle.has_value() || !(circle->radius > 0.0) ||
      !std::isfinite(circle->x + circle->y + circle->radius)) {
    return std::nullopt;
  }
  CircleFit fit;
  fit.circle = *circle;
  const Points kept = NearTo(*circle, points, near);
  for (const Eigen::Vector2d& p : kept) {
    fit.residual += Distance(*circle, p) * Distance(*circle, p);
  }
  fit.residual = std::sqrt(fit.residual / std::max<size_t>(kept.size(), 1));
  fit.overlap = CircleOverlap(mask, *circle);
  return fit;
}

}  // namespace ibrdf
