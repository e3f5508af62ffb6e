// The keys of the sections `likelihood`, `effects` and `solver`.
#include <cstdint>
#include <limits>

#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

constexpr double kMaxSeconds = 1e7;
constexpr int64_t kMaxIterations = 100000000;

Row SolverMethodKey() {
  return Row("solver.method",
             "Optimiser of the map, or of both unknowns with `estimator: "
             "maximum`. Before a network, the Gaussian process is always "
             "optimised by `gauss_newton`.")
      .Choice(
          "auto",
          {{"auto",
            "`gauss_newton` for a map, `alternating` for both unknowns."},
           {"alternating",
            "`gauss_newton` for the map and Ceres' trust region for the lobes, "
            "in turns."},
           {"gauss_newton",
            "Gauss-Newton by conjugate gradients, without a matrix."},
           {"lbfgs", "L-BFGS of Ceres."},
           {"adam", "The published schedule, as a reference."},
           {"trust_region",
            "Trust region of Ceres with dense matrices, for small maps only."}})
      .UsedBy(kUnknownLight);
}

Row SearchKey() {
  return Row("solver.search",
             "How far the reflectance is searched for. It serves objects of "
             "one material; paint and labels are searched for once.")
      .Choice("auto",
              {{"auto",
                "`standard`, and `thorough` where that leaves the reflectance "
                "wide open."},
               {"standard", "One search. Some images lead it astray."},
               {"thorough",
                "A second search begins with more tolerance of materials "
                "unlike the object's, and reflectances of other kinds that a "
                "search gave up are compared at a finer map."}})
      .Needs("problem: joint")
      .UsedBy(kUsedByJoint);
}

Row TurnsKey() {
  return Row("solver.turns",
             "At most so many turns of reflectance and light at the map's full "
             "size, where more than noise is left of the image.")
      .Integer(0, kMostSolverTurns, "2")
      .Needs("problem: joint")
      .UsedBy(kUsedByJoint);
}

Row QuadratureKey() {
  return Row("solver.quadrature",
             "How finely the integral over light directions is taken.")
      .Choice("standard",
              {{"coarse",
                "Half as many half-vectors about the highlight as `standard`, "
                "and blocks of the map twice as wide."},
               {"standard",
                "The map is summed in blocks, at most 64 along its width."},
               {"fine",
                "Twice as many half-vectors as `standard`, and blocks half as "
                "wide."}})
      .UsedBy(kUsedBySolve);
}

Row GaugeKey() {
  return Row("solver.gauge",
             "What sets the scale between reflectance and light, which no "
             "image tells ([conventions](conventions.md#scale)).")
      .Choice("grey_light",
              {{"prior",
                "The priors: the level is that of the training materials, the "
                "hue the most probable one."},
               {"grey_light",
                "The light's mean over the sphere is grey, as photographers "
                "balance it. Its level is that of `prior`."},
               {"unit_light",
                "The light's mean over the sphere is 1 in every channel."}})
      .Needs("problem: joint")
      .UsedBy(kUsedByJoint);
}

}  // namespace

Keys LikelihoodKeys() {
  return {Row("likelihood",
              "How far the render may differ from the image: log(render + "
              "epsilon) - log(image + epsilon) has a Laplacian distribution.")
              .Notes({"With `solver.estimator: marginal`, the search for the "
                      "reflectance estimates its own noise. `scale` then "
                      "serves the map."})
              .UsedBy(kUsedBySolve),
          Row("likelihood.scale",
              "Scale b of the Laplacian. `auto` lets it fall to the misfit, "
              "one outer iteration after another.")
              .AutoOrNumber(kPositive)
              .Unit("natural log")
              .UsedBy(kUsedBySolve),
          Row("likelihood.epsilon",
              "Radiance that is added before the logarithm. `auto` is 1e-5 of "
              "the object's mean radiance.")
              .AutoOrNumber(kNotNegative)
              .Unit("that of the image")
              .UsedBy(kUsedBySolve)};
}

Keys EffectsKeys() {
  return {
      Row("effects",
          "What is simulated beyond distant light without shadows: a word, or "
          "a list of effects.")
          .WordOrList("auto",
                      {{"auto",
                        "Predicts by how much leaving out shadows or bounces "
                        "would change the image, and simulates what matters."},
                       {"all", "Shadows, and light of up to four bounces."},
                       {"none", "None of the effects below."}},
                      {{"visibility", "Shadows that a mesh casts on itself."},
                       {"interreflection",
                        "Light that a mesh throws on itself, up to four "
                        "bounces. It implies `visibility`."},
                       {"reflectance_map",
                        "Some normals are rendered, and the rest interpolated. "
                        "It needs an orthographic camera and no shadows.",
                        kUsedByRender},
                       {"harmonics",
                        "The map in spherical harmonics. It is fast where the "
                        "reflectance is not mirror-like.",
                        kUsedByRender},
                       {"gaussians",
                        "The map as a mixture of spherical Gaussians. It is "
                        "fast where the reflectance is not mirror-like.",
                        kUsedByRender}})
          .UsedBy(kSolveOrRender)
          .Notes({"Effects that are listed are simulated whether or not they "
                  "matter. A single one needs no brackets.",
                  "`harmonics` and `gaussians` know no shadows: neither goes "
                  "with `visibility` or `interreflection`.",
                  "A normal map has no positions, so it takes neither "
                  "`visibility` nor `interreflection`.",
                  "[Settings](settings.md#shadows-and-bounces) says when "
                  "`auto` simulates what."})};
}

Keys SolverKeys() {
  return {Row("solver",
              "How the estimate is computed. [Settings](settings.md) says what "
              "each setting costs."),
          Row("solver.estimator", "What the reflectance maximises.")
              .Choice("marginal",
                      {{"marginal",
                        "Its posterior with the light integrated out. The map "
                        "is then the MAP estimate given it."},
                       {"maximum",
                        "The posterior of both at once, as published (Chen et "
                        "al. 2020, Eq. 8). It is there for comparison."}})
              .UsedBy(kUsedByJoint),
          SearchKey(),
          TurnsKey(),
          SolverMethodKey(),
          QuadratureKey(),
          GaugeKey(),
          Row("solver.seconds",
              "Time limit of the whole program, from reading files to writing "
              "results. It may end earlier.")
              .Number({0.0, kMaxSeconds, false, true}, "120")
              .Unit("s")
              .UsedBy(kUsedBySolve),
          Row("solver.tolerance",
              "An optimiser stops when a step lowers the cost by a smaller "
              "share than this.")
              .Number({0.0, 1.0, true, false}, "1e-4")
              .UsedBy(kUsedBySolve),
          Row("solver.max_iterations",
              "Limit of outer iterations, beside the time. 0 keeps the initial "
              "guess.")
              .Integer(0, kMaxIterations, "1000")
              .UsedBy(kUsedBySolve),
          Row("solver.seed",
              "Seed of a render's noise; in a solve, of the samples behind the "
              "expected error and of the network's first weights alone. Equal "
              "results are no sign of robustness.")
              .Integer(0, std::numeric_limits<int64_t>::max(), "")
              .Without("that of `--seed`")
              .UsedBy(kSolveOrRender)};
}

}  // namespace problem_keys
}  // namespace ibrdf
