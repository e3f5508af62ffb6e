// The experiment `joint` of ibrdf_bench.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>

#include "solvers/bench/joint_sweep.h"
#include "solvers/programs/bench_sweep_flags.h"

namespace ibrdf {

inline void AddJointExperiment(CLI::App* app, BenchSession* session) {
  struct Flags {
    JointSweepOptions options;
    SweepFlags sweep;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session]() -> Status {
    JointSweepOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->sweep.Apply(*session, &options));
    FindSolver(&options);
    if (flags->sweep.dry_run) return PrintRuns(ListJointRuns(options));
    return RunJointSweep(options);
  };
  CLI::App* experiment = AddExperiment(
      app, "joint",
      "Reflectance and illumination from one image: makes images, estimates, "
      "baselines, and a row of DIR/results.csv as each case finishes. "
      "The same command goes on where it was stopped.",
      session, run);
  AddSweepFlags(experiment, &flags->options, &flags->sweep);
  AddSolverFlags(experiment, &flags->options);
  AddModelFlags(experiment, &flags->options, &flags->options.lobes);
}

}  // namespace ibrdf
