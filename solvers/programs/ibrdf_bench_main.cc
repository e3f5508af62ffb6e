// The scripted sweeps of experiments/.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <string>
#include <vector>

#include "ibrdf/solvers/programs/bench_albedo.h"
#include "ibrdf/solvers/programs/bench_embedding.h"
#include "ibrdf/solvers/programs/bench_entropy.h"
#include "ibrdf/solvers/programs/bench_merl_fit.h"
#include "ibrdf/solvers/programs/bench_render_inputs.h"
#include "ibrdf/solvers/programs/bench_session.h"
#include "ibrdf/solvers/programs/bench_solver_sweeps.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

// The name of the experiment is checked here for a message that lists all.
Status CheckExperiment(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  std::string names;
  for (const CLI::App* known : app.get_subcommands(nullptr)) {
    names += (names.empty() ? "" : ", ") + known->get_name();
  }
  return InvalidInput("command line: experiment",
                      "expected one of: " + names +
                          (words.empty() ? "" : "; found " + words.front()));
}

int Main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  CLI::App app("Runs a sweep of cases; see ibrdf_bench EXPERIMENT --help.");
  BenchSession session;
  AddCommonFlags(&app, &session.common);
  app.require_subcommand(0, 1);
  AddSolverExperiments(&app, &session);
  AddRenderInputsExperiment(&app, &session);
  AddMerlFitExperiment(&app, &session);
  AddAlbedoExperiment(&app, &session);
  AddEmbeddingExperiment(&app, &session);
  AddEntropyExperiments(&app, &session);
  app.allow_extras();  // after the experiments, which would inherit it
  for (int i = 0; i < argc; ++i) {
    session.command += i == 0 ? "ibrdf_bench" : std::string(" ") + argv[i];
  }
  session.stop = &stop_requested;
  return RunProgram(&app, argc, argv, [&]() -> Status {
    if (!session.run) return CheckExperiment(app);
    std::signal(SIGINT, RequestStop);
    std::signal(SIGTERM, RequestStop);
    return session.run();
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
