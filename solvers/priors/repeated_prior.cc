#include "ibrdf/solvers/priors/repeated_prior.h"

namespace ibrdf {

MaterialPrior RepeatPrior(const MaterialPrior& one, int count) {
  const Eigen::Index n = one.mean.size();
  MaterialPrior prior;
  prior.code_size = one.code_size;
  prior.wall = one.wall;
  prior.num_materials = count;
  prior.mean = one.mean.replicate(count, 1);
  prior.factor = Eigen::MatrixXd::Zero(count * n, count * n);
  for (Eigen::Index m = 0; m < count; ++m) {
    prior.factor.block(m * n, m * n, n, n) = one.factor;
  }
  return prior;
}

}  // namespace ibrdf
