// Parameters as Eigen's vectors and as the standard library's.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

inline Eigen::VectorXd ToEigen(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(),
                                           static_cast<Eigen::Index>(v.size()));
}

inline std::vector<double> ToVector(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

}  // namespace ibrdf
