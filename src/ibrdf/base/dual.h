// Forward-mode derivatives for slow references.
#pragma once
#include <cmath>
#include <vector>

namespace ibrdf {

// A number with its derivatives by some variables; no derivatives: a constant.
struct Dual {
  double value = 0.0;
  std::vector<double> derivatives;

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT: numbers convert as they do in math
  Dual(double v, int variables, int index)
      : value(v), derivatives(variables, 0.0) {
    derivatives[index] = 1.0;
  }

  // f(a) with f'(a) = slope.
  static Dual Chain(double v, double slope, const Dual& a) {
    Dual r(v);
    r.derivatives = a.derivatives;
    for (double& d : r.derivatives) d *= slope;
    return r;
  }
  static Dual Chain(double v, double slope_a, const Dual& a, double slope_b,
                    const Dual& b) {
    if (b.derivatives.empty()) return Chain(v, slope_a, a);
    if (a.derivatives.empty()) return Chain(v, slope_b, b);
    Dual r = Chain(v, slope_a, a);
    for (size_t i = 0; i < b.derivatives.size(); ++i) {
      r.derivatives[i] += slope_b * b.derivatives[i];
    }
    return r;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual operator-() const { return Chain(-value, -1.0, *this); }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return Chain(a.value + b.value, 1.0, a, 1.0, b);
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return Chain(a.value - b.value, 1.0, a, -1.0, b);
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return Chain(a.value * b.value, b.value, a, a.value, b);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.value / b.value;
    return Chain(q, 1.0 / b.value, a, -q / b.value, b);
  }
  friend bool operator<(const Dual& a, const Dual& b) {
    return a.value < b.value;
  }
  friend bool operator>(const Dual& a, const Dual& b) { return b < a; }
  friend bool operator>=(const Dual& a, const Dual& b) { return !(a < b); }
};

inline Dual exp(const Dual& a) {
  const double e = std::exp(a.value);
  return Dual::Chain(e, e, a);
}
inline Dual log(const Dual& a) {
  return Dual::Chain(std::log(a.value), 1.0 / a.value, a);
}
inline Dual sqrt(const Dual& a) {
  const double s = std::sqrt(a.value);
  return Dual::Chain(s, 0.5 / s, a);
}
inline Dual abs(const Dual& a) { return a.value < 0.0 ? -a : a; }

}  // namespace ibrdf
