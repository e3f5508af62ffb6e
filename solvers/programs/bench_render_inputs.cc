#include "ibrdf/solvers/programs/bench_render_inputs.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "ibrdf/solvers/bench/sweep_inputs.h"
#include "ibrdf/solvers/programs/bench_sweep_flags.h"

namespace ibrdf {

void AddRenderInputsExperiment(CLI::App* app, BenchSession* session) {
  struct Flags {
    SweepOptions options;
    SweepFlags sweep;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session]() -> Status {
    const SweepOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->sweep.Apply(*session, &flags->options));
    if (!flags->sweep.dry_run) return RunRenderInputs(options);
    const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
    if (!cases.ok()) return cases.status();
    for (const SweepCase& c : *cases) {
      std::printf("%s\t%s\t%s\t%s\n", c.name.c_str(), c.brdf_path.c_str(),
                  c.map_path.c_str(),
                  HasInput(options, c) ? "present" : "missing");
    }
    return OkStatus();
  };
  CLI::App* experiment = AddExperiment(
      app, "render-inputs",
      "The images that joint, known-light and known-brdf with the same DIR "
      "start from, many at a time: DIR/cases/NAME/input.exr, mask.png, "
      "input.json. The same command goes on where it was stopped.",
      session, run);
  AddSweepFlags(experiment, &flags->options, &flags->sweep);
}

}  // namespace ibrdf
