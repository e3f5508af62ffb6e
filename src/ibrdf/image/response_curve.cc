#include "ibrdf/image/response_curve.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ibrdf/base/format.h"

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where the two parts of the sRGB curve meet: the root near 0.0031308 of
// 12.92 x = 1.055 x^(1 / 2.4) - 0.055.
constexpr double kSrgbMeetX = 0.0031306684425006340;
constexpr double kSrgbMeetY = 12.92 * kSrgbMeetX;

CurvePoint SrgbForward(double x) {
  if (x <= kSrgbMeetX) return {12.92 * x, 12.92, 0.0};
  const double power = 1.055 * std::pow(x, 1.0 / 2.4);
  return {std::max(power - 0.055, kSrgbMeetY), power / (2.4 * x), 0.0};
}

double SrgbInverse(double y) {
  if (y <= kSrgbMeetY) return y / 12.92;
  return std::max(std::pow((y + 0.055) / 1.055, 2.4), kSrgbMeetX);
}

// Below, powers become a straight line.
constexpr double kLeastPowerCode = 0x1p-18;
constexpr double kLeastPower = 0.2, kMostPower = 5.0;

CurvePoint PowerForward(double p, double least_x, double x) {
  if (x < least_x) {
    // slope = least_y^(1 - p)
    const double slope = kLeastPowerCode / least_x;
    const double y = std::min(slope * x, kLeastPowerCode);
    return {y, slope, -y * std::log(kLeastPowerCode)};
  }
  const double y = std::max(std::pow(x, 1.0 / p), kLeastPowerCode);
  return {y, y / (p * x), -y * std::log(x) / (p * p)};
}

double PowerInverse(double p, double least_x, double y) {
  if (y < kLeastPowerCode) return std::min(y / kLeastPowerCode, 1.0) * least_x;
  return std::max(std::pow(y, p), least_x);
}

// Narkowicz 2016: f(x) = x (a x + b) / (x (c x + d) + e).
constexpr double kA = 2.51, kB = 0.03, kC = 2.43, kD = 0.59, kE = 0.14;

CurvePoint AcesForward(double gamma, double root, double x) {
  const double below = x * (kC * x + kD) + kE;
  const double y = x * (kA * x + kB) / below / root;
  // Numerator and denominator of f' without differences of large numbers.
  const double above = ((kA * kD - kB * kC) * x + 2.0 * kA * kE) * x + kB * kE;
  return {y, above / (below * below) / root, -0.2 * y / gamma};
}

// The positive root of (a - c u) x^2 - q x - e u = 0, q = d u - b, in the form
// that subtracts no like numbers.
double AcesInverse(double root, double y) {
  const double u = y * root;
  const double q = kD * u - kB;
  const double square = kA - kC * u;
  const double R = std::sqrt(std::max(q * q + 4.0 * kE * u * square, 0.0));
  return q < 0.0 ? 2.0 * kE * u / (R - q) : (q + R) / (2.0 * square);
}

CurvePoint ReinhardForward(double white, double k, double x) {
  const double below = 1.0 + x;
  // dk / dwhite = -2 k / white, 0 where white is infinite.
  return {x * (1.0 + k * x) / below,
          (1.0 + k * x * (2.0 + x)) / (below * below),
          -2.0 * k / white * (x * x) / below};
}

// The positive root of k x^2 + (1 - y) x - y = 0. Below max_code() y >= 1 only
// where k > 0.
double ReinhardInverse(double k, double y) {
  const double q = 1.0 - y;
  const double R = std::sqrt(q * q + 4.0 * k * y);
  return q > 0.0 ? 2.0 * y / (q + R) : (R - q) / (2.0 * k);
}

CurvePoint LogForward(double mu, double log_all, double x) {
  const double y = std::log1p(mu * x) / log_all;
  const double below = (1.0 + mu * x) * log_all;
  return {y, mu / below, x / below - y / ((1.0 + mu) * log_all)};
}

double LogInverse(double mu, double log_all, double y) {
  return std::expm1(y * log_all) / mu;
}

constexpr double kLeastNode = 1e-12, kMostNodeCode = 2.0;
constexpr double kLeastExponent = 1e-4, kMostExponent = 1e4;

double Exponent(const CurveNode& a, const CurveNode& b) {
  return std::log(b.y / a.y) / std::log(b.x / a.x);
}

bool IsOrigin(const CurveNode& node) { return node.x == 0.0 && node.y == 0.0; }

Status CheckTable(const std::string& where,
                  const std::vector<CurveNode>& table) {
  const size_t first = !table.empty() && IsOrigin(table[0]) ? 1 : 0;
  if (table.size() < first + 2) {
    return InvalidInput(where, "a table needs two nodes beside (0, 0)");
  }
  for (size_t i = first; i < table.size(); ++i) {
    const CurveNode& node = table[i];
    const std::string name =
        Format("node %zu (%g, %g): ", i + 1, node.x, node.y);
    if (!(node.x >= kLeastNode && node.x <= kMaxCurveRadiance)) {
      return InvalidInput(where, name + Format("radiance must be in [%g, %g]",
                                               kLeastNode, kMaxCurveRadiance));
    }
    if (!(node.y >= kLeastNode && node.y <= kMostNodeCode)) {
      return InvalidInput(where, name + Format("code value must be in [%g, %g],"
                                               " relative to the largest code",
                                               kLeastNode, kMostNodeCode));
    }
    if (i == first) continue;
    const CurveNode& before = table[i - 1];
    if (!(node.x > before.x && node.y > before.y)) {
      return InvalidInput(
          where, name +
                     "radiance and code value must both be larger than "
                     "those of the node before");
    }
    const double exponent = Exponent(before, node);
    if (!(exponent >= kLeastExponent && exponent <= kMostExponent)) {
      return InvalidInput(
          where, name + Format("log code value over log radiance must rise by "
                               "%g to %g from the node before, not %g",
                               kLeastExponent, kMostExponent, exponent));
    }
  }
  return OkStatus();
}

const std::array<std::string, 7>& Names() {
  static const std::array<std::string, 7> names = {
      "linear", "srgb", "power", "aces", "reinhard", "log", "table"};
  return names;
}

}  // namespace

const std::string& NameOf(ResponseKind kind) {
  return Names().at(static_cast<size_t>(kind));
}

StatusOr<ResponseKind> ResponseKindOf(const std::string& where,
                                      const std::string& name) {
  std::string all;
  for (size_t i = 0; i < Names().size(); ++i) {
    if (Names()[i] == name) return static_cast<ResponseKind>(i);
    all += (i == 0 ? "" : ", ") + Names()[i];
  }
  return InvalidInput(where,
                      "expected one of " + all + ", not \"" + name + "\"");
}

std::optional<ResponseParameter> ParameterOf(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::kPower:
      return ResponseParameter{"p", kLeastPower, kMostPower, 2.2};
    case ResponseKind::kAces:
      // The range and the initial value of RobIR's code.
      return ResponseParameter{"gamma", 1e-4, 1.0, 0.5};
    case ResponseKind::kReinhard:
      return ResponseParameter{"white", 1.0, kInfinity, kInfinity};
    case ResponseKind::kLog:
      return ResponseParameter{"mu", 0.01, 1e6, 5000.0};
    case ResponseKind::kLinear:
    case ResponseKind::kSrgb:
    case ResponseKind::kTable:
      break;
  }
  return std::nullopt;
}

Status ResponseDefinition::Check(const std::string& where) const {
  const std::optional<ResponseParameter> known = ParameterOf(kind);
  if (parameter.has_value() && !known.has_value()) {
    return InvalidInput(where, NameOf(kind) + " has no parameter");
  }
  if (parameter.has_value() &&
      !(*parameter >= known->least && *parameter <= known->most)) {
    const std::string range =
        std::isinf(known->most)
            ? Format("at least %g", known->least)
            : Format("in [%g, %g]", known->least, known->most);
    return InvalidInput(where, Format("%s must be %s, not %g", known->name,
                                      range.c_str(), *parameter));
  }
  if (kind == ResponseKind::kTable) return CheckTable(where, table);
  if (!table.empty()) {
    return InvalidInput(where, NameOf(kind) + " has no nodes");
  }
  return OkStatus();
}

ResponseCurve::ResponseCurve(const ResponseDefinition& definition)
    : kind_(definition.kind) {
  const Status status = definition.Check("ResponseDefinition");
  CHECK(status.ok()) << status.message();
  if (const auto known = ParameterOf(kind_)) {
    parameter_ = definition.parameter.value_or(known->usual);
  }
  switch (kind_) {
    case ResponseKind::kPower:
      derived_ = std::pow(kLeastPowerCode, parameter_);
      break;
    case ResponseKind::kAces:
      derived_ = std::pow(parameter_, 0.2);
      break;
    case ResponseKind::kReinhard:
      derived_ = 1.0 / (parameter_ * parameter_);
      break;
    case ResponseKind::kLog:
      derived_ = std::log1p(parameter_);
      break;
    case ResponseKind::kTable:
      SetTable(definition.table);
      break;
    case ResponseKind::kLinear:
    case ResponseKind::kSrgb:
      break;
  }
  if (kind_ != ResponseKind::kLinear) {
    max_code_ = Forward(kMaxCurveRadiance).value;
  }
}

void ResponseCurve::SetTable(const std::vector<CurveNode>& table) {
  nodes_.assign(table.begin() + (IsOrigin(table[0]) ? 1 : 0), table.end());
  for (size_t i = 0; i + 1 < nodes_.size(); ++i) {
    exponents_.push_back(Exponent(nodes_[i], nodes_[i + 1]));
  }
  exponents_.push_back(std::min(exponents_.back(), 1.0));
  const CurveNode first = nodes_[0];
  if (first.y > kLeastPowerCode) {
    const double exponent =
        std::clamp(exponents_[0], 1.0 / kMostPower, 1.0 / kLeastPower);
    nodes_.insert(nodes_.begin(), {first.x * std::pow(kLeastPowerCode / first.y,
                                                      1.0 / exponent),
                                   kLeastPowerCode});
    exponents_.insert(exponents_.begin(), exponent);
  }
}

CurvePoint ResponseCurve::TableForward(double x) const {
  const auto above = std::upper_bound(
      nodes_.begin(), nodes_.end(), x,
      [](double value, const CurveNode& node) { return value < node.x; });
  if (above == nodes_.begin()) {
    const double slope = nodes_[0].y / nodes_[0].x;
    return {std::min(slope * x, nodes_[0].y), slope, 0.0};
  }
  const size_t i = above - nodes_.begin() - 1;
  double y = nodes_[i].y * std::pow(x / nodes_[i].x, exponents_[i]);
  if (above != nodes_.end()) y = std::min(y, above->y);
  return {y, exponents_[i] * y / x, 0.0};
}

double ResponseCurve::TableInverse(double y) const {
  const auto above = std::upper_bound(
      nodes_.begin(), nodes_.end(), y,
      [](double value, const CurveNode& node) { return value < node.y; });
  if (above == nodes_.begin()) {
    return std::min(y / nodes_[0].y, 1.0) * nodes_[0].x;
  }
  const size_t i = above - nodes_.begin() - 1;
  const double x = nodes_[i].x * std::pow(y / nodes_[i].y, 1.0 / exponents_[i]);
  return above != nodes_.end() ? std::min(x, above->x) : x;
}

CurvePoint ResponseCurve::Forward(double x) const {
  switch (kind_) {
    case ResponseKind::kLinear:
      return {x, 1.0, 0.0};
    case ResponseKind::kSrgb:
      return SrgbForward(x);
    case ResponseKind::kPower:
      return PowerForward(parameter_, derived_, x);
    case ResponseKind::kAces:
      return AcesForward(parameter_, derived_, x);
    case ResponseKind::kReinhard:
      return ReinhardForward(parameter_, derived_, x);
    case ResponseKind::kLog:
      return LogForward(parameter_, derived_, x);
    case ResponseKind::kTable:
      return TableForward(x);
  }
  LOG(FATAL) << "unknown kind of curve";
}

double ResponseCurve::Inverse(double y) const {
  switch (kind_) {
    case ResponseKind::kLinear:
      return y;
    case ResponseKind::kSrgb:
      return SrgbInverse(y);
    case ResponseKind::kPower:
      return PowerInverse(parameter_, derived_, y);
    case ResponseKind::kAces:
      return AcesInverse(derived_, y);
    case ResponseKind::kReinhard:
      return ReinhardInverse(derived_, y);
    case ResponseKind::kLog:
      return LogInverse(parameter_, derived_, y);
    case ResponseKind::kTable:
      return TableInverse(y);
  }
  LOG(FATAL) << "unknown kind of curve";
}

CurvePoint ResponseCurve::EncodePoint(double x) const {
  if (std::isnan(x)) return {x, x, x};
  if (x < 0.0) return {};
  if (kind_ == ResponseKind::kLinear || x < kMaxCurveRadiance) {
    CurvePoint point = Forward(x);
    point.value = std::min(point.value, max_code_);
    return point;
  }
  const CurvePoint end = Forward(kMaxCurveRadiance);
  return {end.value, 0.0, end.parameter_slope};
}

CurvePoint ResponseCurve::DecodePoint(double y) const {
  if (std::isnan(y)) return {y, y, y};
  if (y < 0.0) return {};
  if (kind_ != ResponseKind::kLinear && y >= max_code_) {
    return {kMaxCurveRadiance, 0.0, 0.0};
  }
  const double x = kind_ == ResponseKind::kLinear
                       ? y
                       : std::min(Inverse(y), kMaxCurveRadiance);
  // y = Encode(x; p): dx / dy = 1 / (dy / dx), dx / dp = -(dy / dp) / (dy /
  // dx).
  const CurvePoint there = Forward(x);
  return {x, 1.0 / there.slope, -there.parameter_slope / there.slope};
}

}  // namespace ibrdf
