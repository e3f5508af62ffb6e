// The scripted sweeps of experiments/.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>

#include "solvers/bench/joint_sweep.h"
#include "solvers/programs/common_flags.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

Status ParseOnly(const std::string& text, JointSweepOptions* options) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &options->only_index,
                  &options->only_count, &used) != 2 ||
      used != static_cast<int>(text.size()) || options->only_index < 1 ||
      options->only_index > options->only_count) {
    return InvalidInput("command line: --only",
                        "expected i/n with 1 <= i <= n, found " + text);
  }
  return OkStatus();
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Runs a sweep of cases: makes images, estimates, baselines, and a row of "
      "DIR/results.csv as each case finishes. The same command goes on where "
      "it was stopped.");
  CommonFlags common;
  JointSweepOptions options;
  std::string experiment, only = "1/1";
  bool dry_run = false;
  AddCommonFlags(&app, &common);
  app.add_option("experiment", experiment, "experiment; known: joint")
      ->required();
  app.add_option("--data", options.data, "folder of MERL .binary tables")
      ->required();
  app.add_option("--maps", options.maps, "folder of .hdr or .exr maps")
      ->required();
  app.add_option("--out", options.out, "folder of results")->required();
  app.add_option("--materials", options.materials,
                 "comma-separated tables, without extension; default: all")
      ->delimiter(',');
  app.add_option("--map-names", options.map_names,
                 "comma-separated maps, without extension; default: all")
      ->delimiter(',');
  app.add_option("--geometry", options.geometry, "sphere, or a mesh file")
      ->capture_default_str();
  app.add_option("--size", options.size, "width and height of images, pixels")
      ->check(CLI::Range(8, 4096))
      ->capture_default_str();
  app.add_option("--lobes", options.lobes, "lobes of the estimate")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  app.add_option("--method", options.method, "of the solver")
      ->check(CLI::IsMember({"auto", "gauss_newton", "lbfgs", "adam"}))
      ->capture_default_str();
  app.add_option("--solver-seconds", options.solver_seconds,
                 "budget of the solver in each case, seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--noise", options.noise,
                 "standard deviation of log-normal noise of the images")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--only", only, "i/n: every n-th case from the i-th")
      ->capture_default_str();
  app.add_option("--solver-program", options.solver_program,
                 "default: ibrdf_solve beside this program");
  app.add_flag("--dry-run", dry_run, "print the cases and stop");
  return RunProgram(&app, argc, argv, [&]() -> Status {
    if (experiment != "joint") {
      return InvalidInput("command line: experiment",
                          "expected one of: joint; found " + experiment);
    }
    IBRDF_RETURN_IF_ERROR(ParseOnly(only, &options));
    options.seed = common.seed;
    options.num_threads = common.threads;
    if (options.solver_program.empty()) {
      options.solver_program =
          (std::filesystem::read_symlink("/proc/self/exe").parent_path() /
           "ibrdf_solve")
              .string();
    }
    options.command = "ibrdf_bench";
    for (int i = 1; i < argc; ++i)
      options.command += std::string(" ") + argv[i];
    if (dry_run) {
      const StatusOr<std::vector<JointCase>> cases = ListJointCases(options);
      if (!cases.ok()) return cases.status();
      for (const JointCase& c : *cases) {
        std::printf("%s\t%s\t%s\n", c.name.c_str(), c.brdf_path.c_str(),
                    c.map_path.c_str());
      }
      return OkStatus();
    }
    if (!common.quiet) {
      options.report = [](const std::string& line) {
        std::printf("%s\n", line.c_str());
        std::fflush(stdout);
      };
    }
    options.stop = &stop_requested;
    std::signal(SIGINT, RequestStop);
    std::signal(SIGTERM, RequestStop);
    return RunJointSweep(options);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
