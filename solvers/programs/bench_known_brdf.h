// The experiment `known-brdf` of ibrdf_bench.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>

#include "solvers/bench/known_brdf_sweep.h"
#include "solvers/programs/bench_sweep_flags.h"

namespace ibrdf {

inline void AddKnownBrdfExperiment(CLI::App* app, BenchSession* session) {
  struct Flags {
    KnownBrdfSweepOptions options;
    SweepFlags sweep;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session]() -> Status {
    KnownBrdfSweepOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->sweep.Apply(*session, &options));
    FindSolver(&options);
    if (flags->sweep.dry_run) return PrintRuns(ListKnownBrdfRuns(options));
    return RunKnownBrdfSweep(options);
  };
  CLI::App* experiment =
      AddExperiment(app, "known-brdf",
                    "Illumination from one image of a known material, with the "
                    "prior and without (Chen et al. 2020, Fig. 4): a row of "
                    "DIR/results.csv as each run finishes. "
                    "The same command goes on where it was stopped.",
                    session, run);
  AddSweepFlags(experiment, &flags->options, &flags->sweep);
  AddSolverFlags(experiment, &flags->options);
  experiment
      ->add_option("--priors", flags->options.priors,
                   "comma-separated, of unet and none")
      ->delimiter(',')
      ->check(CLI::IsMember({"unet", "none"}))
      ->capture_default_str();
}

}  // namespace ibrdf
