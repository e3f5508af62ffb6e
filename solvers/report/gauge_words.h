// What set the scale between reflectance and light, in words.
#pragma once
#include <string>

#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

std::string GaugeWords(const InverseProblem& inverse);

}  // namespace ibrdf
