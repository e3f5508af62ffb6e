// Errors of derivatives against references, gathered by kind of derivative and
// kind of point.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ibrdf {
namespace derivatives {

// Scalar of the references: 64 bits of mantissa on x86.
using Real = long double;

struct ErrorRow {
  std::string derivative, points;
  int count = 0;  // of points
  // Quantiles of |derivative - reference| / |reference|, Euclidean norms of a
  // gradient or row; where the reference is 0, of |derivative|.
  double median = 0.0, p99 = 0.0, worst = 0.0;
  std::string worst_point;
  // Largest relative error of an entry that is not below a thousandth of its
  // gradient's largest one.
  double worst_entry = 0.0;
  int not_finite = 0;  // entries where the reference is finite
};

class ErrorTable {
 public:
  // One point; `where` names it. Vectors of like size.
  void Add(const std::string& derivative, const std::string& points,
           const std::string& where, const std::vector<double>& values,
           const std::vector<Real>& reference);

  // In order of first Add.
  std::vector<ErrorRow> Rows() const;
  // CHECKs that there is such a row.
  ErrorRow Row(const std::string& derivative, const std::string& points) const;

 private:
  struct Errors {
    std::vector<std::pair<double, std::string>> relative;
    double worst_entry = 0.0;
    int not_finite = 0;
  };
  using Key = std::pair<std::string, std::string>;
  std::vector<Key> order_;
  std::map<Key, Errors> errors_;
};

// <a, A x> against <A^T a, x>, relative to the former's sum of magnitudes: adds
// 1 + the error, of 1. Ax and transposed are A x and A^T a.
void AddAdjointIdentity(const std::string& derivative,
                        const std::string& points, const std::string& where,
                        const std::vector<double>& a,
                        const std::vector<double>& Ax,
                        const std::vector<float>& x,
                        const std::vector<float>& transposed,
                        ErrorTable* table);

std::vector<double> ToDoubles(const std::vector<float>& v);

// Coordinates for messages: "(0.25, 1, 3e-08)", at most `most` of them.
std::string Coordinates(const std::vector<double>& x, size_t most = 6);

// Header and rows; text with commas is quoted.
std::string ToCsv(const std::vector<ErrorRow>& rows);

}  // namespace derivatives
}  // namespace ibrdf
