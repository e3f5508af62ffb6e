// Forward-mode derivatives for slow references.
#pragma once
#include <cmath>
#include <type_traits>
#include <vector>

namespace ibrdf {

// A number with its derivatives by some variables, all of type T; no
// derivatives: a constant.
template <typename T>
struct BasicDual {
  T value = T(0);
  std::vector<T> derivatives;

  BasicDual() = default;
  template <typename V, typename = std::enable_if_t<std::is_arithmetic_v<V>>>
  BasicDual(V v)  // NOLINT: numbers convert as they do in math
      : value(static_cast<T>(v)) {}
  BasicDual(T v, int variables, int index)
      : value(v), derivatives(variables, T(0)) {
    derivatives[index] = T(1);
  }

  // f(a) with f'(a) = slope.
  static BasicDual Chain(T v, T slope, const BasicDual& a) {
    BasicDual r(v);
    r.derivatives = a.derivatives;
    for (T& d : r.derivatives) d *= slope;
    return r;
  }
  static BasicDual Chain(T v, T slope_a, const BasicDual& a, T slope_b,
                         const BasicDual& b) {
    if (b.derivatives.empty()) return Chain(v, slope_a, a);
    if (a.derivatives.empty()) return Chain(v, slope_b, b);
    BasicDual r = Chain(v, slope_a, a);
    for (size_t i = 0; i < b.derivatives.size(); ++i) {
      r.derivatives[i] += slope_b * b.derivatives[i];
    }
    return r;
  }

  BasicDual& operator+=(const BasicDual& b) {
    value += b.value;
    if (derivatives.empty()) {
      derivatives = b.derivatives;
      return *this;
    }
    for (size_t i = 0; i < b.derivatives.size(); ++i) {
      derivatives[i] += b.derivatives[i];
    }
    return *this;
  }
  BasicDual operator-() const { return Chain(-value, T(-1), *this); }
  friend BasicDual operator+(const BasicDual& a, const BasicDual& b) {
    return Chain(a.value + b.value, T(1), a, T(1), b);
  }
  friend BasicDual operator-(const BasicDual& a, const BasicDual& b) {
    return Chain(a.value - b.value, T(1), a, T(-1), b);
  }
  friend BasicDual operator*(const BasicDual& a, const BasicDual& b) {
    return Chain(a.value * b.value, b.value, a, a.value, b);
  }
  friend BasicDual operator/(const BasicDual& a, const BasicDual& b) {
    const T q = a.value / b.value;
    return Chain(q, T(1) / b.value, a, -q / b.value, b);
  }
  friend bool operator<(const BasicDual& a, const BasicDual& b) {
    return a.value < b.value;
  }
  friend bool operator>(const BasicDual& a, const BasicDual& b) {
    return b < a;
  }
  friend bool operator>=(const BasicDual& a, const BasicDual& b) {
    return !(a < b);
  }
};

using Dual = BasicDual<double>;

template <typename T>
BasicDual<T> exp(const BasicDual<T>& a) {
  const T e = std::exp(a.value);
  return BasicDual<T>::Chain(e, e, a);
}
template <typename T>
BasicDual<T> log(const BasicDual<T>& a) {
  return BasicDual<T>::Chain(std::log(a.value), T(1) / a.value, a);
}
template <typename T>
BasicDual<T> sqrt(const BasicDual<T>& a) {
  const T s = std::sqrt(a.value);
  return BasicDual<T>::Chain(s, T(0.5) / s, a);
}
template <typename T>
BasicDual<T> abs(const BasicDual<T>& a) {
  return a.value < T(0) ? -a : a;
}
template <typename T>
BasicDual<T> sin(const BasicDual<T>& a) {
  return BasicDual<T>::Chain(std::sin(a.value), std::cos(a.value), a);
}
template <typename T>
BasicDual<T> cos(const BasicDual<T>& a) {
  return BasicDual<T>::Chain(std::cos(a.value), -std::sin(a.value), a);
}
template <typename T>
BasicDual<T> atan2(const BasicDual<T>& y, const BasicDual<T>& x) {
  const T square = x.value * x.value + y.value * y.value;
  return BasicDual<T>::Chain(std::atan2(y.value, x.value), x.value / square, y,
                             -y.value / square, x);
}

}  // namespace ibrdf
