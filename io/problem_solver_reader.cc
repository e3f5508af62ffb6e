// The readers of the sections `likelihood`, `effects` and `solver`.
#include <algorithm>
#include <string>
#include <vector>

#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;
using Strings = std::vector<std::string>;

// Adds the effect that `item` names, which is in the list or stands in its
// place.
void AddEffect(const ConfigNode& item, ProblemReader* root,
               EffectsSpec* effects) {
  const ProblemKey& key = root->Key("effects");
  const Strings names = key.ListWords();
  const auto name = std::find(names.begin(), names.end(), item.scalar);
  if (item.kind != Kind::kScalar || name == names.end()) {
    Strings expected = key.Words();
    expected.push_back("a list of " + JoinWords(names));
    root->Fail(
        "effects",
        "expected " + JoinWords(expected) + ", found " + Describe(item) +
            (item.kind == Kind::kScalar ? "; the nearest known one is " +
                                              NearestWord(item.scalar, names)
                                        : ""));
    return;
  }
  const auto effect = static_cast<Effect>(name - names.begin());
  if (effects->Lists(effect)) {
    root->Fail("effects", *name + " is listed twice");
  } else {
    effects->list.push_back(effect);
  }
}

void CheckEffects(const EffectsSpec& effects, ProblemReader* root) {
  for (const Effect approximation : {Effect::kHarmonics, Effect::kGaussians}) {
    for (const Effect shadow :
         {Effect::kVisibility, Effect::kInterreflection}) {
      if (!effects.Lists(approximation) || !effects.Lists(shadow)) continue;
      root->Fail("effects",
                 std::string("expected ") + EffectName(approximation) + " or " +
                     EffectName(shadow) + ", found both: " +
                     EffectName(approximation) + " knows no shadows");
      return;
    }
  }
}

}  // namespace

void ReadLikelihood(ProblemReader reader, LikelihoodSpec* likelihood) {
  reader.Read("scale", &likelihood->scale);
  reader.Read("epsilon", &likelihood->epsilon);
}

void ReadEffects(ProblemReader* root, EffectsSpec* effects) {
  const ConfigNode* node = root->Find("effects");
  if (node == nullptr) return;
  if (node->kind == Kind::kList) {
    effects->mode = EffectsMode::kList;
    for (const ConfigNode& item : node->items) AddEffect(item, root, effects);
    CheckEffects(*effects, root);
    return;
  }
  const Strings modes = root->Key("effects").Words();
  const auto mode = std::find(modes.begin(), modes.end(), node->scalar);
  if (node->kind == Kind::kScalar && mode != modes.end()) {
    effects->mode = static_cast<EffectsMode>(mode - modes.begin());
    return;
  }
  effects->mode = EffectsMode::kList;
  AddEffect(*node, root, effects);
}

void ReadSolver(ProblemReader reader, ProblemKind kind, SolverSpec* solver) {
  reader.Read("estimator", &solver->estimator);
  reader.Read("search", &solver->search);
  reader.CheckNeeds("search", kind == ProblemKind::kJoint);
  reader.Read("turns", &solver->turns);
  reader.CheckNeeds("turns", kind == ProblemKind::kJoint);
  reader.Read("method", &solver->method);
  reader.Read("quadrature", &solver->quadrature);
  reader.Read("gauge", &solver->gauge);
  reader.CheckNeeds("gauge", kind == ProblemKind::kJoint);
  reader.Read("seconds", &solver->seconds);
  reader.Read("tolerance", &solver->tolerance);
  reader.Read("max_iterations", &solver->max_iterations);
  reader.Read("seed", &solver->seed);
}

}  // namespace ibrdf
