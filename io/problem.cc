#include "ibrdf/io/problem.h"

#include <algorithm>

#include "ibrdf/io/problem_schema.h"

namespace ibrdf {

const char* SolverMethodName(SolverMethod method) {
  return WordOf("solver.method", method).c_str();
}

const char* SolverSearchName(SolverSearch search) {
  return WordOf("solver.search", search).c_str();
}

const char* QuadratureLevelName(QuadratureLevel level) {
  return WordOf("solver.quadrature", level).c_str();
}

const char* SolverGaugeName(SolverGauge gauge) {
  return WordOf("solver.gauge", gauge).c_str();
}

const char* ReflectanceVariationName(ReflectanceVariation variation) {
  return WordOf("reflectance.variation", variation).c_str();
}

const char* EffectName(Effect effect) {
  const ProblemKey& key = ProblemFileSchema().Key("effects");
  return key.list_words.at(static_cast<size_t>(effect)).word.c_str();
}

bool EffectsSpec::Lists(Effect effect) const {
  return std::find(list.begin(), list.end(), effect) != list.end();
}

}  // namespace ibrdf
