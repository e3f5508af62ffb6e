// The experiment `joint` of ibrdf_bench.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "solvers/bench/joint_sweep.h"
#include "solvers/programs/bench_session.h"

namespace ibrdf {

inline void AddJointExperiment(CLI::App* app, BenchSession* session) {
  struct Flags {
    JointSweepOptions options;
    OnlyFlag only;
    bool dry_run = false;
  };
  const auto flags = std::make_shared<Flags>();
  const auto run = [flags, session]() -> Status {
    JointSweepOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->only.Parse());
    options.only_index = flags->only.index;
    options.only_count = flags->only.count;
    options.seed = session->common.seed;
    options.num_threads = session->common.threads;
    options.command = session->command;
    if (options.solver_program.empty()) {
      options.solver_program =
          (std::filesystem::read_symlink("/proc/self/exe").parent_path() /
           "ibrdf_solve")
              .string();
    }
    if (flags->dry_run) {
      const StatusOr<std::vector<JointCase>> cases = ListJointCases(options);
      if (!cases.ok()) return cases.status();
      for (const JointCase& c : *cases) {
        std::printf("%s\t%s\t%s\n", c.name.c_str(), c.brdf_path.c_str(),
                    c.map_path.c_str());
      }
      return OkStatus();
    }
    options.report = session->Report();
    options.stop = session->stop;
    return RunJointSweep(options);
  };
  CLI::App* joint = AddExperiment(
      app, "joint",
      "Reflectance and illumination from one image: makes images, estimates, "
      "baselines, and a row of DIR/results.csv as each case finishes. The same "
      "command goes on where it was stopped.",
      session, run);
  JointSweepOptions& options = flags->options;
  joint->add_option("--data", options.data, "folder of MERL .binary tables")
      ->required();
  joint->add_option("--maps", options.maps, "folder of .hdr or .exr maps")
      ->required();
  joint->add_option("--out", options.out, "folder of results")->required();
  joint
      ->add_option("--materials", options.materials,
                   "comma-separated tables, without extension; default: all")
      ->delimiter(',');
  joint
      ->add_option("--map-names", options.map_names,
                   "comma-separated maps, without extension; default: all")
      ->delimiter(',');
  joint->add_option("--geometry", options.geometry, "sphere, or a mesh file")
      ->capture_default_str();
  joint
      ->add_option("--size", options.size, "width and height of images, pixels")
      ->check(CLI::Range(8, 4096))
      ->capture_default_str();
  joint->add_option("--lobes", options.lobes, "lobes of the estimate")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  joint->add_option("--method", options.method, "of the solver")
      ->check(CLI::IsMember({"auto", "alternating", "gauss_newton", "lbfgs",
                             "adam", "trust_region"}))
      ->capture_default_str();
  joint
      ->add_option("--solver-seconds", options.solver_seconds,
                   "budget of the solver in each case, seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  joint
      ->add_option("--noise", options.noise,
                   "standard deviation of log-normal noise of the images")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  joint
      ->add_option("--only", flags->only.text,
                   "i/n: every n-th case from the i-th")
      ->capture_default_str();
  joint->add_option("--solver-program", options.solver_program,
                    "default: ibrdf_solve beside this program");
  joint->add_flag("--dry-run", flags->dry_run, "print the cases and stop");
}

}  // namespace ibrdf
