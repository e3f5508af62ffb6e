// Real spherical harmonics on the directions of maps, and their rotations.
//
// Orthonormal over the sphere; index l (l + 1) + m, m > 0 with cos(m phi),
// m < 0 with sin(|m| phi). theta from +y and phi from +z towards +x, as in
// light/environment_map.h. `order`: the largest l.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

inline int NumHarmonics(int order) { return (order + 1) * (order + 1); }
inline int HarmonicIndex(int l, int m) { return l * (l + 1) + m; }

// Coefficients of red, green and blue; one row a harmonic.
using HarmonicColours = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Immutable; safe to share between threads.
class HarmonicBasis {
 public:
  explicit HarmonicBasis(int order);

  int order() const { return order_; }
  int count() const { return NumHarmonics(order_); }

  // Y [count()] at a unit direction.
  void Evaluate(const Eigen::Vector3d& direction, double* Y) const;

  // Constants of the recurrence over degrees, for kernels
  // (harmonic_recurrence.h): P_ll at [l], up and down at [l (l + 1) / 2 + m].
  const std::vector<double>& diagonal() const { return diagonal_; }
  const std::vector<double>& up() const { return up_; }
  const std::vector<double>& down() const { return down_; }

 private:
  friend class HarmonicProjection;
  // Legendre functions over sin^m(theta), with the norms of Y: [l, m] at
  // l (l + 1) / 2 + m.
  void Legendre(double cos_theta, double* P) const;

  int order_;
  std::vector<double> diagonal_;   // [l]: P_ll
  std::vector<double> up_, down_;  // recurrences in l, as P
};

// Coefficients of piecewise constant maps, by exact integrals over the texels:
// a constant map has one coefficient. Immutable; safe to share between threads.
class HarmonicProjection {
 public:
  HarmonicProjection(int order, int map_height, int map_width);

  // map [H, W, 3]: coefficients int L Y.
  HarmonicColours Project(const float* map) const;
  // gradient [H, W, 3] of sum adjoint.coefficients.
  void Transpose(const HarmonicColours& adjoint, float* gradient) const;

  // int Y [count] over one texel.
  void Texel(int row, int column, double* integrals) const;

 private:
  int order_, height_, width_;
  // int P sin^m sin dtheta over a row, [row][l, m as Legendre]; int cos or sin
  // (m phi) dphi over a column, [column][order + m].
  std::vector<double> rows_, columns_;
};

// Turns of a frame: the coefficients of u -> L(F u) from those of L, where F
// has the frame's axes, as directions of the map, for columns: its polar axis
// `pole` and `zero`, where its phi is 0 (unit, at right angles).
// Immutable; safe to share between threads.
class HarmonicRotation {
 public:
  explicit HarmonicRotation(int order);

  // A turn in two steps: the first brings the pole, and depends on nothing
  // else; the second is about it, by an angle.
  struct Pole {
    double alpha, beta;
    Eigen::Vector3d zero;  // the frame's axis when the angle is 0
    Eigen::Vector3d side;  // and a quarter of a turn on
  };
  static Pole PoleAt(const Eigen::Vector3d& pole);
  void ToPole(const Pole& pole, HarmonicColours* coefficients) const;
  static double AngleOf(const Pole& pole, const Eigen::Vector3d& zero);
  void Turn(double angle, HarmonicColours* coefficients) const;

  // The transposes, which are the inverses.
  void FromPole(const Pole& pole, HarmonicColours* coefficients) const;
  void TurnBack(double angle, HarmonicColours* coefficients) const {
    Turn(-angle, coefficients);
  }

 private:
  void Permute(bool back, HarmonicColours* coefficients) const;

  int order_;
  // By l: coefficients of u -> L(A u), A the turn that takes +y to +x, +x to
  // +z and +z to +y.
  std::vector<Eigen::MatrixXd> permute_;
};

}  // namespace ibrdf
