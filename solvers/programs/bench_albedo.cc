#include "ibrdf/solvers/programs/bench_albedo.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "ibrdf/solvers/bench/albedo_sweep.h"

namespace ibrdf {

void AddAlbedoExperiment(CLI::App* app, BenchSession* session) {
  const auto options = std::make_shared<AlbedoSweepOptions>();
  const auto run = [options, session]() -> Status {
    options->num_threads = session->common.threads;
    options->command = session->command;
    options->report = session->Report();
    options->stop = session->stop;
    return RunAlbedoSweep(*options);
  };
  CLI::App* albedo = AddExperiment(
      app, "albedo",
      "Energy: directional albedo and white-furnace figures of a model's "
      "materials and of their tables, and what importance sampling saves; two "
      "rows of DIR/results.csv per material. The same command goes on where it "
      "was stopped.",
      session, run);
  options->model = "default";
  albedo->add_option("--model", options->model, "model file, or default")
      ->capture_default_str();
  albedo->add_option("--data", options->data,
                     "folder of the MERL .binary tables of the materials");
  albedo->add_option("--out", options->out, "folder of results")->required();
  albedo
      ->add_option("--materials", options->materials,
                   "comma-separated names; default: all of the model")
      ->delimiter(',');
}

}  // namespace ibrdf
