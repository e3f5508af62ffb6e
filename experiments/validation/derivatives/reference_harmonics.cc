#include "experiments/validation/derivatives/reference_harmonics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace derivatives {
namespace {

using Vector = Eigen::Matrix<Real, 3, 1>;

const Real kPi = std::acos(Real(-1));
// Nodes of Gauss-Legendre along each side of a texel: for degrees up to 5 and
// texels of a sixteenth of a turn it errs by some 1e-14.
constexpr int kNodes = 8;

struct Rule {
  std::array<Real, kNodes> node, weight;  // on [0, 1]
};

// Newton's method from Tricomi's guesses.
Rule GaussLegendre() {
  Rule rule;
  for (int i = 0; i < kNodes; ++i) {
    Real x = std::cos(kPi * (i + Real(0.75)) / (kNodes + Real(0.5)));
    Real slope = 0;
    for (int step = 0; step < 20; ++step) {
      const Real p = std::legendre(kNodes, x);
      slope = kNodes * (x * p - std::legendre(kNodes - 1, x)) / (x * x - 1);
      x -= p / slope;
    }
    rule.node[i] = (1 - x) / 2;
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

// Adds weight Y(u), u: unit.
void AddHarmonics(int order, const Vector& u, Real weight,
                  std::vector<Real>* sum) {
  const Real theta = std::atan2(std::hypot(u.x(), u.z()), u.y());
  const Real phi = std::atan2(u.x(), u.z());
  for (int l = 0; l <= order; ++l) {
    for (int m = 0; m <= l; ++m) {
      const Real P = weight * std::sph_legendre(l, m, theta);
      if (m == 0) {
        (*sum)[HarmonicIndex(l, 0)] += P;
        continue;
      }
      const Real sign = m % 2 == 0 ? 1 : -1;  // Condon and Shortley's
      (*sum)[HarmonicIndex(l, m)] +=
          sign * std::sqrt(Real(2)) * P * std::cos(m * phi);
      (*sum)[HarmonicIndex(l, -m)] +=
          sign * std::sqrt(Real(2)) * P * std::sin(m * phi);
    }
  }
}

// Integral of Y over a texel, in a frame whose axes are the rows of `frame`.
std::vector<Real> TexelIntegral(int order, int row, int column, int height,
                                int width,
                                const Eigen::Matrix<Real, 3, 3>& frame) {
  static const Rule rule = GaussLegendre();
  std::vector<Real> sum(NumHarmonics(order), 0);
  for (int i = 0; i < kNodes; ++i) {
    const Real theta = kPi * (row + rule.node[i]) / height;
    for (int j = 0; j < kNodes; ++j) {
      const Real phi = 2 * kPi * (column + rule.node[j]) / width;
      const Vector u(std::sin(theta) * std::sin(phi), std::cos(theta),
                     std::sin(theta) * std::cos(phi));
      const Real area = 2 * kPi * kPi / (Real(height) * width);
      AddHarmonics(order, frame * u,
                   rule.weight[i] * rule.weight[j] * area * std::sin(theta),
                   &sum);
    }
  }
  return sum;
}

Real Dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  Real sum = 0;
  for (size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

void AddTo(const std::vector<Real>& a, Real factor, std::vector<Real>* sum) {
  for (size_t k = 0; k < a.size(); ++k) (*sum)[k] += factor * a[k];
}

}  // namespace

ReferenceHarmonics::ReferenceHarmonics(const std::vector<ShadingPoint>& points,
                                       int map_height, int map_width,
                                       const HarmonicOptions& options)
    : order_(options.order), num_nodes_(options.grid.num_nodes()) {
  const Real most = std::acos(Real(kMinViewCosine));
  const Real step = most / (options.view_angles - 1);
  for (const ShadingPoint& p : points) {
    const Eigen::Vector3d n = p.normal.cast<double>().normalized();
    const Eigen::Vector3d wo = p.wo.cast<double>().normalized();
    Eigen::Vector3d t, b;
    ViewFrame(n, wo, &t, &b);
    const Vector polar = p.wo.cast<Real>().normalized();
    const Vector normal = p.normal.cast<Real>().normalized();
    const Real cosine = normal.dot(polar), sine = polar.dot(t.cast<Real>());
    Vector zero = sine * normal - cosine * t.cast<Real>();
    zero = (zero - zero.dot(polar) * polar).normalized();
    Eigen::Matrix<Real, 3, 3> frame;
    frame.row(0) = polar.cross(zero);
    frame.row(1) = polar;
    frame.row(2) = zero;
    Point point;
    for (int row = 0; row < map_height; ++row) {
      for (int column = 0; column < map_width; ++column) {
        point.texels.push_back(
            TexelIntegral(order_, row, column, map_height, map_width, frame));
      }
    }
    const Real at = std::min(std::atan2(sine, cosine), most) / step;
    point.first =
        std::clamp(static_cast<int>(at) - 1, 0, options.view_angles - 4);
    for (int j = 0; j < 4; ++j) {
      point.weight[j] = 1;
      for (int k = 0; k < 4; ++k) {
        if (k != j) point.weight[j] *= (at - point.first - k) / Real(j - k);
      }
      const int angle = point.first + j;
      if (pairs_.count(angle) == 0) pairs_[angle] = PairsAt(angle, options);
    }
    points_.push_back(std::move(point));
  }
}

std::vector<ReferenceHarmonics::Pair> ReferenceHarmonics::PairsAt(
    int angle, const HarmonicOptions& options) {
  const int columns = options.quadrature.far_width, rows = columns / 2;
  const PointQuadrature quadrature(MapCells(rows, columns, 1),
                                   options.quadrature);
  const double theta =
      angle * std::acos(double{kMinViewCosine}) / (options.view_angles - 1);
  PointSamples samples;
  quadrature.Sample({0.0, std::cos(theta), std::sin(theta)},
                    Eigen::Vector3d::UnitY(), &samples);
  std::vector<Pair> pairs;
  const auto add = [&](const auto& sample, const Harmonics& Y) {
    const BrdfGridTaps taps = GridTaps(
        options.grid, ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d));
    Pair pair{{}, {}, Harmonics(Y.size(), 0)};
    std::copy(taps.node, taps.node + 8, pair.node.begin());
    std::copy(taps.weight, taps.weight + 8, pair.weight.begin());
    AddTo(Y, sample.weight, &pair.Y);
    pairs.push_back(std::move(pair));
  };
  for (const NearSample& s : samples.near) {
    Harmonics Y(NumHarmonics(order_), 0);
    AddHarmonics(order_, s.wi.cast<Real>().normalized(), 1, &Y);
    add(s, Y);
  }
  const Eigen::Matrix<Real, 3, 3> identity =
      Eigen::Matrix<Real, 3, 3>::Identity();
  for (const FarSample& s : samples.far) {
    Harmonics& Y = cells_[s.cell];
    if (Y.empty()) {
      Y = TexelIntegral(order_, s.cell / columns, s.cell % columns, rows,
                        columns, identity);
    }
    add(s, Y);
  }
  return pairs;
}

std::vector<Real> ReferenceHarmonics::MapRow(
    int point, const std::vector<Real>& field) const {
  const Point& p = points_[point];
  Harmonics S(NumHarmonics(order_), 0);
  for (int j = 0; j < 4; ++j) {
    for (const Pair& pair : pairs_.at(p.first + j)) {
      Real f = 0;
      for (int k = 0; k < 8; ++k) f += pair.weight[k] * field[pair.node[k]];
      AddTo(pair.Y, p.weight[j] * f, &S);
    }
  }
  std::vector<Real> row;
  for (const Harmonics& texel : p.texels) row.push_back(Dot(S, texel));
  return row;
}

std::vector<Real> ReferenceHarmonics::GridRow(
    int point, const std::vector<Real>& map) const {
  const Point& p = points_[point];
  Harmonics L(NumHarmonics(order_), 0);
  for (size_t t = 0; t < map.size(); ++t) AddTo(p.texels[t], map[t], &L);
  std::vector<Real> row(num_nodes_, 0);
  for (int j = 0; j < 4; ++j) {
    for (const Pair& pair : pairs_.at(p.first + j)) {
      const Real value = p.weight[j] * Dot(pair.Y, L);
      for (int k = 0; k < 8; ++k) row[pair.node[k]] += pair.weight[k] * value;
    }
  }
  return row;
}

}  // namespace derivatives
}  // namespace ibrdf
