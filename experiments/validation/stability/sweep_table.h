// Errors by sweep, place on its axis, quantity and implementation.
#pragma once
#include <string>
#include <vector>

namespace ibrdf {
namespace stability {

using Real = long double;  // of the references: 64 bits of mantissa on x86

inline constexpr char kOurs[] = "library";
inline constexpr char kNaive[] = "naive";

class SweepTable {
 public:
  // One error for each value of the quantity; not finite where the value is.
  void Add(const std::string& sweep, double x, const std::string& quantity,
           const std::string& implementation,
           const std::vector<double>& errors);

  // Header and rows: the median of all errors, infinite ones among them, and
  // the largest finite one.
  std::string Csv() const;

 private:
  std::vector<std::string> lines_;
};

// |value - reference| / |reference|, or |value| where that is 0; not finite
// where the value is not.
double RelativeError(double value, Real reference);

}  // namespace stability
}  // namespace ibrdf
