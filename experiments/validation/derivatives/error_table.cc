#include "experiments/validation/derivatives/error_table.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

namespace ibrdf {
namespace derivatives {
namespace {

constexpr Real kSmallEntry = 1e-3L;  // of the largest, see worst_entry

std::string Short(double v) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", v);
  return text;
}

}  // namespace

void ErrorTable::Add(const std::string& derivative, const std::string& points,
                     const std::string& where,
                     const std::vector<double>& values,
                     const std::vector<Real>& reference) {
  CHECK_EQ(values.size(), reference.size()) << derivative;
  const Key key(derivative, points);
  if (errors_.count(key) == 0) order_.push_back(key);
  Errors& e = errors_[key];
  Real square = 0, difference = 0, largest = 0;
  for (const Real r : reference) {
    CHECK(std::isfinite(r)) << derivative << ": reference at " << where;
    square += r * r;
    largest = std::max(largest, std::abs(r));
  }
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      ++e.not_finite;
      difference = std::numeric_limits<Real>::infinity();
      continue;
    }
    const Real d = std::abs(values[i] - reference[i]);
    difference += d * d;
    const Real size = std::abs(reference[i]);
    if (size > 0 && size >= kSmallEntry * largest) {
      e.worst_entry = std::max(e.worst_entry, static_cast<double>(d / size));
    }
  }
  const Real norm = square > 0 ? std::sqrt(square) : Real(1);
  e.relative.emplace_back(static_cast<double>(std::sqrt(difference) / norm),
                          where);
}

std::vector<ErrorRow> ErrorTable::Rows() const {
  std::vector<ErrorRow> rows;
  for (const Key& key : order_) rows.push_back(Row(key.first, key.second));
  return rows;
}

ErrorRow ErrorTable::Row(const std::string& derivative,
                         const std::string& points) const {
  const auto found = errors_.find({derivative, points});
  CHECK(found != errors_.end()) << derivative << ", " << points;
  auto sorted = found->second.relative;
  std::stable_sort(
      sorted.begin(), sorted.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto quantile = [&sorted](double q) {
    const double at = q * static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<size_t>(std::ceil(at))].first;
  };
  ErrorRow row;
  row.derivative = derivative;
  row.points = points;
  row.count = static_cast<int>(sorted.size());
  row.median = quantile(0.5);
  row.p99 = quantile(0.99);
  row.worst = sorted.back().first;
  row.worst_point = sorted.back().second;
  row.worst_entry = found->second.worst_entry;
  row.not_finite = found->second.not_finite;
  return row;
}

void AddAdjointIdentity(const std::string& derivative,
                        const std::string& points, const std::string& where,
                        const std::vector<double>& a,
                        const std::vector<double>& Ax,
                        const std::vector<float>& x,
                        const std::vector<float>& transposed,
                        ErrorTable* table) {
  Real left = 0, right = 0, size = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    left += Real(a[i]) * Ax[i];
    size += std::abs(Real(a[i]) * Ax[i]);
  }
  for (size_t k = 0; k < x.size(); ++k) right += Real(transposed[k]) * x[k];
  table->Add(derivative, points, where,
             {static_cast<double>(1 + (left - right) / size)}, {1});
}

std::vector<double> ToDoubles(const std::vector<float>& v) {
  return {v.begin(), v.end()};
}

std::string Coordinates(const std::vector<double>& x, size_t most) {
  std::string out = "(";
  for (size_t i = 0; i < std::min(x.size(), most); ++i) {
    out += (i == 0 ? "" : ", ") + Short(x[i]);
  }
  return out + (x.size() > most ? ", ...)" : ")");
}

std::string ToCsv(const std::vector<ErrorRow>& rows) {
  const auto quoted = [](const std::string& s) {
    return s.find(',') == std::string::npos ? s : "\"" + s + "\"";
  };
  std::ostringstream out;
  out << "derivative,points,count,median,p99,worst,worst_entry,not_finite,"
         "worst_point\n";
  for (const ErrorRow& r : rows) {
    out << quoted(r.derivative) << ',' << quoted(r.points) << ',' << r.count
        << ',' << Short(r.median) << ',' << Short(r.p99) << ','
        << Short(r.worst) << ',' << Short(r.worst_entry) << ',' << r.not_finite
        << ',' << quoted(r.worst_point) << '\n';
  }
  return out.str();
}

}  // namespace derivatives
}  // namespace ibrdf
