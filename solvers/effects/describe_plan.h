// A plan of effects in words.
#pragma once
#include <string>

#include "ibrdf/solvers/effects/effects_plan.h"

namespace ibrdf {

// One line for the user: what is simulated, and the predictions that it
// follows from. Holds seconds, which vary from run to run.
std::string Describe(const EffectsPlan& plan);

}  // namespace ibrdf
