#include "ibrdf/approximation/harmonics.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/gauss_legendre.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

int Legendre2(int l, int m) { return l * (l + 1) / 2 + m; }

}  // namespace

HarmonicBasis::HarmonicBasis(int order) : order_(order) {
  CHECK_GE(order, 0);
  up_.assign(Legendre2(order + 1, 0), 0.0);
  down_ = up_;
  double diagonal = std::sqrt(0.25 / kPi);
  for (int l = 0; l <= order; ++l) {
    if (l > 0) {
      diagonal *= std::sqrt((2.0 * l + 1.0) / (2.0 * l));
      if (l == 1) diagonal *= std::sqrt(2.0);  // real harmonics of m != 0
    }
    diagonal_.push_back(diagonal);
    for (int m = 0; m < l; ++m) {
      const double a = std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m));
      up_[Legendre2(l, m)] = a;
      if (l - 1 > m) {
        const double k = l - 1;
        down_[Legendre2(l, m)] =
            a * std::sqrt((k * k - m * m) / (4.0 * k * k - 1.0));
      }
    }
  }
}

void HarmonicBasis::Legendre(double cos_theta, double* P) const {
  for (int l = 0; l <= order_; ++l) {
    P[Legendre2(l, l)] = diagonal_[l];
    for (int m = 0; m < l; ++m) {
      const int at = Legendre2(l, m);
      double p = up_[at] * cos_theta * P[Legendre2(l - 1, m)];
      if (l - 1 > m) p -= down_[at] * P[Legendre2(l - 2, m)];
      P[at] = p;
    }
  }
}

void HarmonicBasis::Evaluate(const Eigen::Vector3d& direction,
                             double* Y) const {
  const double x = direction.z(), y = direction.x(), z = direction.y();
  // Column m of the recurrence, with (sin(theta) e^(i phi))^m = c + i s.
  double c = 1.0, s = 0.0;
  for (int m = 0; m <= order_; ++m) {
    double before = 0.0, p = diagonal_[m];
    for (int l = m; l <= order_; ++l) {
      if (l > m) {
        const int at = Legendre2(l, m);
        const double next = up_[at] * z * p - down_[at] * before;
        before = p;
        p = next;
      }
      const int middle = HarmonicIndex(l, 0);
      Y[middle + m] = p * c;
      if (m > 0) Y[middle - m] = p * s;
    }
    const double turned = c * x - s * y;
    s = c * y + s * x;
    c = turned;
  }
}

HarmonicProjection::HarmonicProjection(int order, int map_height, int map_width)
    : order_(order), height_(map_height), width_(map_width) {
  CHECK(map_height > 0 && map_width > 0);
  const HarmonicBasis basis(order);
  const int legendre = Legendre2(order + 1, 0);
  // Exact to rounding: 16 nodes for less than a wave.
  std::vector<double> nodes, weights;
  GaussLegendre(16, &nodes, &weights);
  const int pieces = order / map_height + 1;
  const double width = kPi / (map_height * pieces);
  rows_.assign(static_cast<size_t>(map_height) * legendre, 0.0);
  std::vector<double> P(legendre);
  for (int r = 0; r < map_height; ++r) {
    double* const row = &rows_[static_cast<size_t>(r) * legendre];
    for (int piece = 0; piece < pieces; ++piece) {
      for (size_t k = 0; k < nodes.size(); ++k) {
        const double theta = width * (r * pieces + piece + nodes[k]);
        basis.Legendre(std::cos(theta), P.data());
        double power = width * weights[k] * std::sin(theta);
        for (int m = 0; m <= order; ++m) {
          for (int l = m; l <= order; ++l) {
            row[Legendre2(l, m)] += power * P[Legendre2(l, m)];
          }
          power *= std::sin(theta);
        }
      }
    }
  }
  for (int c = 0; c < map_width; ++c) {
    const double middle = 2.0 * kPi * (c + 0.5) / map_width;
    for (int m = -order; m <= order; ++m) {
      const double wide = 2.0 * kPi / map_width;
      const double share = m == 0 ? wide : 2.0 * std::sin(0.5 * m * wide) / m;
      columns_.push_back(
          share * (m < 0 ? std::sin(-m * middle) : std::cos(m * middle)));
    }
  }
}

HarmonicColours HarmonicProjection::Project(const float* map) const {
  const int waves = 2 * order_ + 1, legendre = Legendre2(order_ + 1, 0);
  HarmonicColours out = HarmonicColours::Zero(NumHarmonics(order_), 3);
  std::vector<Eigen::Vector3d> wave(waves);
  for (int r = 0; r < height_; ++r) {
    std::fill(wave.begin(), wave.end(), Eigen::Vector3d::Zero());
    for (int c = 0; c < width_; ++c) {
      const float* const L = map + 3 * (static_cast<size_t>(r) * width_ + c);
      const Eigen::Vector3d radiance(L[0], L[1], L[2]);
      const double* const column = &columns_[static_cast<size_t>(c) * waves];
      for (int m = 0; m < waves; ++m) wave[m] += column[m] * radiance;
    }
    const double* const row = &rows_[static_cast<size_t>(r) * legendre];
    for (int l = 0; l <= order_; ++l) {
      for (int m = -l; m <= l; ++m) {
        out.row(HarmonicIndex(l, m)) +=
            row[Legendre2(l, std::abs(m))] * wave[order_ + m].transpose();
      }
    }
  }
  return out;
}

void HarmonicProjection::Transpose(const HarmonicColours& adjoint,
                                   float* gradient) const {
  const int waves = 2 * order_ + 1, legendre = Legendre2(order_ + 1, 0);
  std::vector<Eigen::Vector3d> wave(waves);
  for (int r = 0; r < height_; ++r) {
    std::fill(wave.begin(), wave.end(), Eigen::Vector3d::Zero());
    const double* const row = &rows_[static_cast<size_t>(r) * legendre];
    for (int l = 0; l <= order_; ++l) {
      for (int m = -l; m <= l; ++m) {
        wave[order_ + m] += row[Legendre2(l, std::abs(m))] *
                            adjoint.row(HarmonicIndex(l, m)).transpose();
      }
    }
    for (int c = 0; c < width_; ++c) {
      const double* const column = &columns_[static_cast<size_t>(c) * waves];
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int m = 0; m < waves; ++m) sum += column[m] * wave[m];
      float* const out = gradient + 3 * (static_cast<size_t>(r) * width_ + c);
      for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(sum[k]);
    }
  }
}

void HarmonicProjection::Texel(int row, int column, double* integrals) const {
  const double* const r =
      &rows_[static_cast<size_t>(row) * Legendre2(order_ + 1, 0)];
  const double* const c =
      &columns_[static_cast<size_t>(column) * (2 * order_ + 1)];
  for (int l = 0; l <= order_; ++l) {
    for (int m = -l; m <= l; ++m) {
      integrals[HarmonicIndex(l, m)] =
          r[Legendre2(l, std::abs(m))] * c[order_ + m];
    }
  }
}

HarmonicRotation::HarmonicRotation(int order) : order_(order) {
  const HarmonicBasis basis(order);
  const int count = basis.count();
  for (int l = 0; l <= order; ++l) {
    permute_.push_back(Eigen::MatrixXd::Zero(2 * l + 1, 2 * l + 1));
  }
  // int Y(A u) Y(u)^T by a rule that is exact for products of the harmonics.
  std::vector<double> nodes, weights;
  GaussLegendre(order + 1, &nodes, &weights);
  const int columns = 2 * order + 2;
  Eigen::VectorXd turned(count), plain(count);
  for (size_t k = 0; k < nodes.size(); ++k) {
    const double y = 2.0 * nodes[k] - 1.0, s = std::sqrt(1.0 - y * y);
    for (int c = 0; c < columns; ++c) {
      const double phi = 2.0 * kPi * (c + 0.5) / columns;
      const Eigen::Vector3d u(s * std::sin(phi), y, s * std::cos(phi));
      basis.Evaluate(u, plain.data());
      basis.Evaluate({u.y(), u.z(), u.x()}, turned.data());
      const double weight = weights[k] * 4.0 * kPi / columns;
      for (int l = 0; l <= order; ++l) {
        // Coefficients of u -> sum L_m Y_m(A u).
        permute_[l] += weight * plain.segment(l * l, 2 * l + 1) *
                       turned.segment(l * l, 2 * l + 1).transpose();
      }
    }
  }
}

HarmonicRotation::Pole HarmonicRotation::PoleAt(const Eigen::Vector3d& pole) {
  Pole out{};
  const double s = std::hypot(pole.z(), pole.x());
  out.alpha = s > 0.0 ? std::atan2(pole.x(), pole.z()) : 0.0;
  out.beta = std::atan2(s, pole.y());
  // Where +z and +x, the directions of phi = 0 and a quarter on, are taken.
  const double ca = std::cos(out.alpha), sa = std::sin(out.alpha);
  const double cb = std::cos(out.beta), sb = std::sin(out.beta);
  out.zero = {cb * sa, -sb, cb * ca};
  out.side = {ca, 0.0, -sa};
  return out;
}

double HarmonicRotation::AngleOf(const Pole& pole,
                                 const Eigen::Vector3d& zero) {
  return std::atan2(zero.dot(pole.side), zero.dot(pole.zero));
}

void HarmonicRotation::Turn(double angle, HarmonicColours* x) const {
  const double c1 = std::cos(angle), s1 = std::sin(angle);
  double c = 1.0, s = 0.0;
  for (int m = 1; m <= order_; ++m) {
    const double next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
    for (int l = m; l <= order_; ++l) {
      const int even = HarmonicIndex(l, m), odd = HarmonicIndex(l, -m);
      const Eigen::RowVector3d a = x->row(even), b = x->row(odd);
      x->row(even) = c * a + s * b;
      x->row(odd) = c * b - s * a;
    }
  }
}

void HarmonicRotation::Permute(bool back, HarmonicColours* x) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3> block;
  for (int l = 0; l <= order_; ++l) {
    block = x->middleRows(l * l, 2 * l + 1);
    if (back) {
      x->middleRows(l * l, 2 * l + 1).noalias() =
          permute_[l].transpose() * block;
    } else {
      x->middleRows(l * l, 2 * l + 1).noalias() = permute_[l] * block;
    }
  }
}

// About +y by alpha, then about +x by beta: A R_y(beta) A^T, A taking +y to +x.
void HarmonicRotation::ToPole(const Pole& pole, HarmonicColours* x) const {
  Turn(pole.alpha, x);
  Permute(false, x);
  Turn(pole.beta, x);
  Permute(true, x);
}

void HarmonicRotation::FromPole(const Pole& pole, HarmonicColours* x) const {
  Permute(false, x);
  Turn(-pole.beta, x);
  Permute(true, x);
  Turn(-pole.alpha, x);
}

}  // namespace ibrdf
