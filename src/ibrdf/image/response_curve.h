// Response curves: how a camera or a renderer makes code values of radiance.
//
// A curve is y = Encode(x). x is linear radiance times exposure. y is the code
// value: 0 for black, 1 for the largest code of a file. Decode is the inverse.
// Neither clips at y = 1: that is done by the file (code_interval.h).
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Each curve but kAces and kReinhard has Encode(1) = 1, a table where it says
// so. All have Encode(0) = 0 and are strictly increasing.
enum class ResponseKind {
  // y = x.
  kLinear,
  // IEC 61966-2-1. The standard's rounded threshold, 0.0031308, leaves a step
  // down of 2.9e-8; the two parts are joined where they meet, at 0.0031306684.
  kSrgb,
  // y = x^(1/p). Below y = 2^-18, which is half of half a code of 16 bits, a
  // straight line through the origin, so that slopes are finite.
  kPower,
  // y = gamma^(-1/5) f(x), f(x) = x (2.51 x + 0.03) / (x (2.43 x + 0.59) +
  // 0.14): Narkowicz's fit of the ACES curve (2016), scaled as by RobIR (Yang
  // et al. 2024, supplement, Fig. 9; the factor is in their code). f(1) =
  // 0.8038, f(7.2417) = 1, and f stays below 2.51 / 2.43 = 1.0329. RobIR raises
  // 8-bit values to the power 2.2 before it compares them with this curve; here
  // y is what the curve says, without a power.
  kAces,
  // y = x (1 + x / white^2) / (1 + x), Reinhard et al. 2002, Eq. 4; Eq. 3 where
  // white is infinite. Encode(white) = 1.
  kReinhard,
  // y = log(1 + mu x) / log(1 + mu): the range compressor of Kalantari and
  // Ramamoorthi 2017, who take mu = 5000.
  kLog,
  // Nodes (x, y), log y linear in log x between them. So powers are exact, the
  // inverse is a formula too, and at 256 codes of the other curves the mean
  // error of log x is at most half of that of lines in x. Below the first node
  // the first exponent holds on, within [0.2, 5], to y = 2^-18 as of kPower;
  // above the last node the last exponent, or 1 if that is less.
  kTable,
};

// The kind's name in files: linear, srgb, power, aces, reinhard, log, table.
const std::string& NameOf(ResponseKind kind);
// The kind of that name. The error lists the names; `where`: file and field.
StatusOr<ResponseKind> ResponseKindOf(const std::string& where,
                                      const std::string& name);

// The one number of a curve.
struct ResponseParameter {
  const char* name;
  double least, most;  // both allowed; `most` may be infinite
  double usual;
};

// p of kPower, gamma of kAces, white of kReinhard, mu of kLog.
std::optional<ResponseParameter> ParameterOf(ResponseKind kind);

struct CurveNode {
  double x, y;
};

// What defines a curve.
struct ResponseDefinition {
  ResponseKind kind = ResponseKind::kLinear;
  std::optional<double> parameter;  // absent: the usual one
  // kTable has two nodes or more, both numbers increasing; x in [1e-12, 1e8],
  // y in [1e-12, 2], and a node (0, 0) before them or not.
  std::vector<CurveNode> table;

  // kInvalidInput says what is wrong; `where`: file and field.
  Status Check(const std::string& where) const;
};

struct CurvePoint {
  double value = 0.0;
  double slope = 0.0;            // in the argument
  double parameter_slope = 0.0;  // in the parameter, the argument held
};

// x above this, where a curve has come to its end, is taken as this; y above
// Encode(this) is decoded as this. Slopes are 0 there. kLinear has no end.
inline constexpr double kMaxCurveRadiance = 1e8;

// Immutable, so thread-safe. Any argument gives finite numbers, but for NaN,
// which gives NaN, and an infinite one of kLinear. Arguments below 0 are taken
// as 0, with slope 0; at 0 the slope is that to the right.
class ResponseCurve {
 public:
  ResponseCurve() : ResponseCurve(ResponseDefinition()) {}
  // The definition passes Check().
  explicit ResponseCurve(const ResponseDefinition& definition);

  ResponseKind kind() const { return kind_; }
  // 0 where the kind has none.
  double parameter() const { return parameter_; }
  // No x has a code value above this; infinite of kLinear. It is above 1 but
  // for tables that end lower and kReinhard with a white of kMaxCurveRadiance
  // or more, whose codes tend to 1.
  double max_code() const { return max_code_; }

  double Encode(double x) const { return EncodePoint(x).value; }
  double Decode(double y) const { return DecodePoint(y).value; }
  CurvePoint EncodePoint(double x) const;
  CurvePoint DecodePoint(double y) const;

 private:
  CurvePoint Forward(double x) const;  // x in [0, kMaxCurveRadiance]
  double Inverse(double y) const;      // y in [0, max_code_)

  void SetTable(const std::vector<CurveNode>& table);
  CurvePoint TableForward(double x) const;
  double TableInverse(double y) const;

  ResponseKind kind_ = ResponseKind::kLinear;
  double parameter_ = 0.0;
  // What follows from the parameter: the x of kPower's lowest power,
  // gamma^(1/5) of kAces, white^-2 of kReinhard, log(1 + mu) of kLog.
  double derived_ = 0.0;
  double max_code_ = std::numeric_limits<double>::infinity();
  std::vector<CurveNode> nodes_;  // without (0, 0)
  // d log y / d log x from each node on.
  std::vector<double> exponents_;
};

}  // namespace ibrdf
