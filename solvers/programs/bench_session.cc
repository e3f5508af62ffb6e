#include "ibrdf/solvers/programs/bench_session.h"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace ibrdf {

std::function<void(const std::string&)> BenchSession::Report() const {
  if (common.quiet) return {};
  return [](const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  };
}

CLI::App* AddExperiment(CLI::App* app, const std::string& name,
                        const std::string& description, BenchSession* session,
                        std::function<Status()> run) {
  CLI::App* experiment = app->add_subcommand(name, description);
  AddCommonFlags(experiment, &session->common);
  experiment->callback([session, run] { session->run = run; });
  return experiment;
}

Status OnlyFlag::Parse() {
  int used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &index, &count, &used) != 2 ||
      used != static_cast<int>(text.size()) || index < 1 || index > count) {
    return InvalidInput("command line: --only",
                        "expected i/n with 1 <= i <= n, found " + text);
  }
  return OkStatus();
}

}  // namespace ibrdf
