// Response curves from their published formulas: slow, in long double, the
// inverse by bisection and slopes by differences.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ibrdf/image/response_curve.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace testing {

using Number = long double;

inline ResponseCurve Curve(ResponseKind kind, double parameter) {
  return ResponseCurve({kind, parameter, {}});
}

inline ResponseCurve Curve(ResponseKind kind) {
  return ResponseCurve({kind, {}, {}});
}

struct ReferenceCurve {
  ResponseKind kind;
  Number parameter;
  std::vector<CurveNode> table;  // without (0, 0)

  explicit ReferenceCurve(const ResponseDefinition& definition)
      : kind(definition.kind), table(definition.table) {
    const auto known = ParameterOf(kind);
    parameter = known ? definition.parameter.value_or(known->usual) : 0.0;
  }

  Number Encode(Number x) const {
    const Number p = parameter;
    switch (kind) {
      case ResponseKind::kLinear:
        return x;
      case ResponseKind::kSrgb: {
        const Number line = 12.92L * x,
                     power = 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
        return x < 0.0031306684425006340328L ? line : power;
      }
      case ResponseKind::kPower: {
        const Number toe = std::pow(2.0L, -18 * p);
        return x < toe ? x / toe / 262144 : std::pow(x, 1 / p);
      }
      case ResponseKind::kAces:
        return x * (2.51L * x + 0.03L) / (x * (2.43L * x + 0.59L) + 0.14L) *
               std::pow(p, -0.2L);
      case ResponseKind::kReinhard:
        return x * (1 + x / (p * p)) / (1 + x);
      case ResponseKind::kLog:
        return std::log1p(p * x) / std::log1p(p);
      case ResponseKind::kTable:
        return EncodeTable(x);
    }
    return 0;
  }

  static Number Exponent(const CurveNode& a, const CurveNode& b) {
    return std::log(static_cast<Number>(b.y) / a.y) /
           std::log(static_cast<Number>(b.x) / a.x);
  }

  Number EncodeTable(Number x) const {
    const CurveNode &first = table[0], &last = table.back();
    if (x < first.x) {
      const Number exponent =
          std::clamp<Number>(Exponent(first, table[1]), 0.2L, 5.0L);
      const Number least = std::pow(2.0L, -18.0L),
                   toe = first.x * std::pow(least / first.y, 1 / exponent);
      return x < toe ? x / toe * least
                     : first.y * std::pow(x / first.x, exponent);
    }
    size_t i = 0;
    while (i + 2 < table.size() && x >= table[i + 1].x) ++i;
    const Number exponent = Exponent(table[i], table[i + 1]);
    if (x <= last.x) return table[i].y * std::pow(x / table[i].x, exponent);
    return last.y * std::pow(x / last.x, std::min<Number>(exponent, 1));
  }

  // In log x, from 1e-60 to 1e20.
  Number Decode(Number y) const {
    Number low = std::log(1e-60L), high = std::log(1e20L);
    for (int i = 0; i < 80; ++i) {
      const Number middle = (low + high) / 2;
      (Encode(std::exp(middle)) < y ? low : high) = middle;
    }
    return std::exp((low + high) / 2);
  }

  ReferenceCurve With(Number other) const {
    ReferenceCurve curve = *this;
    curve.parameter = other;
    return curve;
  }
};

// Central differences of fourth order; `step` relative to `at`.
template <typename Function>
Number Slope(const Function& f, Number at, Number step) {
  const Number h = at * step;
  return (8 * (f(at + h) - f(at - h)) - (f(at + 2 * h) - f(at - 2 * h))) /
         (12 * h);
}

// Every kind at its usual, its least and its largest parameter and between.
inline std::vector<ResponseDefinition> AllCurves() {
  std::vector<ResponseDefinition> curves(2);
  curves[1].kind = ResponseKind::kSrgb;
  const auto add = [&curves](ResponseKind kind, std::vector<double> values) {
    for (const double value : values) curves.push_back({kind, value, {}});
  };
  add(ResponseKind::kPower, {0.2, 0.5, 1.0, 1.8, 2.2, 5.0});
  add(ResponseKind::kAces, {1e-4, 0.1, 0.42, 0.5, 1.0});
  add(ResponseKind::kReinhard, {1.0, 1.5, 4.0, 1e3, 1e6, kInfinity});
  add(ResponseKind::kLog, {0.01, 1.0, 100.0, 5000.0, 1e6});
  const ResponseKind table = ResponseKind::kTable;
  curves.push_back(
      {table, {}, {{0.001, 0.02}, {0.01, 0.12}, {0.2, 0.5}, {1.0, 1.0}}});
  // Steep, flat, one exponent above 1 at the end.
  curves.push_back(
      {table,
       {},
       {{1e-6, 1e-3}, {0.1, 0.3}, {0.11, 0.6}, {0.9, 0.64}, {1.0, 0.9}}});
  return curves;
}

inline std::string Describe(const ResponseDefinition& definition) {
  std::string text = NameOf(definition.kind);
  if (definition.parameter) text += " " + std::to_string(*definition.parameter);
  return text;
}

}  // namespace testing
}  // namespace ibrdf
