#include "ibrdf/solvers/programs/bench_sweep_flags.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

namespace ibrdf {

Status SweepFlags::Apply(const BenchSession& session, SweepOptions* options) {
  IBRDF_RETURN_IF_ERROR(only.Parse());
  options->only_index = only.index;
  options->only_count = only.count;
  options->seed = session.common.seed;
  options->num_threads = session.common.threads;
  options->command = session.command;
  options->report = session.Report();
  options->stop = session.stop;
  return OkStatus();
}

void AddSweepFlags(CLI::App* app, SweepOptions* options, SweepFlags* flags) {
  app->add_option("--data", options->data, "folder of MERL .binary tables")
      ->required();
  app->add_option("--maps", options->maps,
                  "folder of .hdr or .exr maps, read in the frame ibrdf_0_1 "
                  "whatever they say, as by all versions")
      ->required();
  app->add_option("--out", options->out, "folder of results")->required();
  app->add_option("--materials", options->materials,
                  "comma-separated tables, without extension; default: all")
      ->delimiter(',');
  app->add_option("--map-names", options->map_names,
                  "comma-separated maps, without extension; default: all")
      ->delimiter(',');
  app->add_option("--geometry", options->geometry, "sphere, or a mesh file")
      ->capture_default_str();
  app->add_option("--size", options->size, "width and height of images, pixels")
      ->check(CLI::Range(8, 4096))
      ->capture_default_str();
  app->add_option("--noise", options->noise,
                  "standard deviation of log-normal noise of the images")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app->add_option("--batch", options->batch,
                  "materials whose images are rendered together; 18 MB each")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app->add_option("--only", flags->only.text,
                  "i/n: every n-th case from the i-th")
      ->capture_default_str();
  app->add_flag("--dry-run", flags->dry_run, "print the cases and stop");
}

void AddSolverFlags(CLI::App* app, SolverSweepOptions* options) {
  app->add_option("--method", options->method, "of the solver")
      ->check(CLI::IsMember({"auto", "alternating", "gauss_newton", "lbfgs",
                             "adam", "trust_region"}))
      ->capture_default_str();
  app->add_option("--solver-seconds", options->solver_seconds,
                  "budget of the solver in each case, seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--solver-program", options->solver_program,
                  "default: ibrdf_solve beside this program");
}

void AddModelFlags(CLI::App* app, ModelOptions* options, int* lobes) {
  app->add_option("--lobes", *lobes, "lobes of the estimate")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  app->add_option("--model", options->model, "default, or a model file")
      ->capture_default_str();
  app->add_option("--models", options->models,
                  "in place of --model: folder of models trained without some "
                  "materials; each material is solved with one that has not "
                  "seen it");
}

void FindSolver(SolverSweepOptions* options) {
  if (!options->solver_program.empty()) return;
  options->solver_program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() /
       "ibrdf_solve")
          .string();
}

Status PrintRuns(const std::vector<SolverRun>& runs) {
  for (const SolverRun& run : runs) {
    std::printf("%s\t%s\t%s\t%s\n", run.of.name.c_str(),
                run.of.brdf_path.c_str(), run.of.map_path.c_str(),
                run.estimate.c_str());
  }
  return OkStatus();
}

}  // namespace ibrdf
