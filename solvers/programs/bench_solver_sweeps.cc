#include "ibrdf/solvers/programs/bench_solver_sweeps.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <type_traits>

#include "ibrdf/solvers/bench/joint_sweep.h"
#include "ibrdf/solvers/bench/known_brdf_sweep.h"
#include "ibrdf/solvers/bench/known_light_sweep.h"
#include "ibrdf/solvers/bench/pareto_sweep.h"
#include "ibrdf/solvers/bench/photograph_sweep.h"
#include "ibrdf/solvers/programs/bench_sweep_flags.h"

namespace ibrdf {
namespace {

// An experiment whose options are `Options` and whose sweep `make` lists; its
// flags are those of every such sweep and, where it has them, of a model.
// Returns the options, for flags of its own, which `experiment` receives.
template <typename Options>
Options* AddSolverExperiment(CLI::App* app, BenchSession* session,
                             const std::string& name,
                             const std::string& description,
                             StatusOr<SolverSweep> (*make)(const Options&),
                             CLI::App** experiment) {
  struct Flags {
    Options options;
    SweepFlags sweep;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session, make]() -> Status {
    Options& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->sweep.Apply(*session, &options));
    FindSolver(&options);
    const StatusOr<SolverSweep> sweep = make(options);
    if (!sweep.ok()) return sweep.status();
    return flags->sweep.dry_run ? PrintRuns(sweep->runs)
                                : RunSolverSweep(options, *sweep);
  };
  *experiment = AddExperiment(
      app, name,
      description +
          " A row of DIR/results.csv as each run finishes. The same command "
          "goes on where it was stopped.",
      session, run);
  AddSweepFlags(*experiment, &flags->options, &flags->sweep);
  AddSolverFlags(*experiment, &flags->options);
  if constexpr (std::is_base_of_v<ModelSweepOptions, Options>) {
    AddModelFlags(*experiment, &flags->options, &flags->options.lobes);
  }
  return &flags->options;
}

void AddPriorsFlag(CLI::App* experiment, std::vector<std::string>* priors) {
  experiment
      ->add_option("--priors", *priors,
                   "priors of the light, comma-separated, of unet, process and "
                   "none; a run of each case with each")
      ->delimiter(',')
      ->check(CLI::IsMember({"unet", "process", "none"}))
      ->capture_default_str();
}

}  // namespace

void AddSolverExperiments(CLI::App* app, BenchSession* session) {
  CLI::App* experiment = nullptr;
  JointSweepOptions* joint =
      AddSolverExperiment(app, session, "joint",
                          "Reflectance and illumination from one image: makes "
                          "images, estimates, baselines.",
                          JointSweep, &experiment);
  AddPriorsFlag(experiment, &joint->priors);
  AddSolverExperiment(app, session, "known-light",
                      "Reflectance from one image under known light (Chen et "
                      "al. 2020, Fig. 3).",
                      KnownLightSweep, &experiment);
  KnownBrdfSweepOptions* known_brdf = AddSolverExperiment(
      app, session, "known-brdf",
      "Illumination from one image of a known material, with the prior and "
      "without (Chen et al. 2020, Fig. 4).",
      KnownBrdfSweep, &experiment);
  AddPriorsFlag(experiment, &known_brdf->priors);
  PhotographSweepOptions* photographs = AddSolverExperiment(
      app, session, "photographs",
      "Joint estimates from files as cameras write them: bits, JPEG, clipped "
      "highlights, response curves.",
      PhotographSweep, &experiment);
  experiment
      ->add_option(
          "--settings", photographs->settings,
          "comma-separated, of: " + PhotographSettingNames() + "; default: all")
      ->delimiter(',');
  ParetoSweepOptions* pareto = AddSolverExperiment(
      app, session, "pareto",
      "What accuracy costs in time: joint estimates with one setting of the "
      "solver changed at a time.",
      ParetoSweep, &experiment);
  experiment
      ->add_option(
          "--settings", pareto->settings,
          "comma-separated, of: " + ParetoSettingNames() + "; default: all")
      ->delimiter(',');
}

}  // namespace ibrdf
