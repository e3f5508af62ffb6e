// The experiment `known-light` of ibrdf_bench.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>

#include "solvers/bench/known_light_sweep.h"
#include "solvers/programs/bench_sweep_flags.h"

namespace ibrdf {

inline void AddKnownLightExperiment(CLI::App* app, BenchSession* session) {
  struct Flags {
    KnownLightSweepOptions options;
    SweepFlags sweep;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session]() -> Status {
    KnownLightSweepOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->sweep.Apply(*session, &options));
    FindSolver(&options);
    if (flags->sweep.dry_run) return PrintRuns(ListKnownLightRuns(options));
    return RunKnownLightSweep(options);
  };
  CLI::App* experiment = AddExperiment(
      app, "known-light",
      "Reflectance from one image under known light (Chen et al. 2020, Fig. "
      "3): a row of DIR/results.csv as each case finishes. "
      "The same command goes on where it was stopped.",
      session, run);
  AddSweepFlags(experiment, &flags->options, &flags->sweep);
  AddSolverFlags(experiment, &flags->options);
  AddModelFlags(experiment, &flags->options, &flags->options.lobes);
}

}  // namespace ibrdf
