// How well one number predicts another.
#pragma once
#include <vector>

namespace ibrdf {

// The mean of one value or more.
double Mean(const std::vector<double>& x);

double Pearson(const std::vector<double>& x, const std::vector<double>& y);
// Pearson of ranks; equals have the mean of theirs.
double Spearman(const std::vector<double>& x, const std::vector<double>& y);
// Correlation of x and y that is left when both are regressed on z.
double PartialCorrelation(const std::vector<double>& x,
                          const std::vector<double>& y,
                          const std::vector<double>& z);
// Area under the curve of telling the fifth with the largest y by x.
double AreaForTopFifth(const std::vector<double>& x,
                       const std::vector<double>& y);
// Two-sided p of a paired t test, and its t.
struct TTest {
  double t, p;
};
TTest PairedTTest(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace ibrdf
