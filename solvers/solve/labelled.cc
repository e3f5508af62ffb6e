#include "ibrdf/solvers/solve/labelled.h"

#include <glog/logging.h>

#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/labelled_search.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/problem/of_material.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {
namespace {

// The problem whose reflectances are those that were found.
InverseProblem GivenReflectances(const SolveSetup& setup,
                                 const LabelledReflectance& found) {
  InverseProblem given = *setup.problem;
  for (const ReflectanceEstimate& material : found.materials) {
    given.estimated_brdfs.push_back(setup.lobes->Grid(material.lobes.data()));
  }
  given.known_brdf = given.estimated_brdfs.front();
  return given;
}

StatusOr<Solution> SolveInUnknownLight(const SolveSetup& setup,
                                       SolveContext* context) {
  StatusOr<LabelledReflectance> found =
      EstimateLabelledReflectance(setup, context);
  const bool explained = found.ok();
  if (!explained) {
    if (found.status().code() != StatusCode::kNoImprovement) {
      return found.status();
    }
    LOG(WARNING) << found.status().message();
    found = LabelledReflectance();
    found->materials.assign(setup.problem->materials.size(),
                            MeanMaterial(setup));
  }
  const InverseProblem given = GivenReflectances(setup, *found);
  const StatusOr<SolveSetup> of_light = SetUp(given);
  if (!of_light.ok()) return of_light.status();
  ReflectanceEstimate known;
  known.light = found->light;
  StatusOr<Estimate> estimate =
      explained
          ? EstimateLight(*of_light, std::move(known), context)
          : StatusOr<Estimate>(ConstantLight(*of_light, std::move(known)));
  if (!estimate.ok()) return estimate.status();
  Solution solution = Summarise(*of_light, *std::move(estimate), context);
  for (const ReflectanceEstimate& material : found->materials) {
    solution.materials.push_back(
        SummariseReflectance(setup, material.lobes, material));
  }
  return solution;
}

// Adds what one material's solution says of the whole.
void Join(Solution of_material, Solution* all) {
  if (all->materials.empty()) {
    all->map = of_material.map;
    all->render = Image(of_material.render.width, of_material.render.height);
    all->scale = of_material.scale;
    all->epsilon = of_material.epsilon;
    all->ambient = of_material.ambient;
  }
  // Where another material is, a render is 0.
  for (size_t i = 0; i < all->render.rgb.size(); ++i) {
    all->render.rgb[i] += of_material.render.rgb[i];
  }
  const auto before = static_cast<double>(all->pixels_used);
  const auto more = static_cast<double>(of_material.pixels_used);
  all->misfit =
      (all->misfit * before + of_material.misfit * more) / (before + more);
  all->pixels_used += of_material.pixels_used;
  all->start_cost += of_material.start_cost;
  all->end_cost += of_material.end_cost;
  all->trace = std::move(of_material.trace);
  all->seconds = of_material.seconds;
  if (!of_material.status.ok()) all->status = of_material.status;
  all->materials.push_back(std::move(of_material.reflectance()));
}

// Each material has its share of the time.
StatusOr<Solution> SolveInKnownLight(const SolveSetup& setup,
                                     SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  const int count = static_cast<int>(problem.materials.size());
  const double reserved = context->reserved();
  Solution all;
  for (int m = 0; m < count; ++m) {
    context->Reserve(reserved);
    const double remaining = context->Remaining();
    context->Reserve(reserved + remaining * (count - 1 - m) / (count - m));
    const InverseProblem alone = OfMaterial(problem, m);
    const StatusOr<SolveSetup> of_material = SetUp(alone);
    if (!of_material.ok()) {
      return InvalidInput("reflectance.labels",
                          "label " + problem.materials[m].value + ": " +
                              of_material.status().message());
    }
    Join(Summarise(*of_material,
                   EstimateReflectanceGivenLight(*of_material, context),
                   context),
         &all);
  }
  return all;
}

}  // namespace

StatusOr<Solution> SolveLabelled(const SolveSetup& setup,
                                 SolveContext* context) {
  StatusOr<Solution> solution = setup.light_unknown()
                                    ? SolveInUnknownLight(setup, context)
                                    : SolveInKnownLight(setup, context);
  if (!solution.ok()) return solution;
  solution->reflectance() =
      solution->materials[MainMaterial(setup.problem->materials)];
  return solution;
}

}  // namespace ibrdf
