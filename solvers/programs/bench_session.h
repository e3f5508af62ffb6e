// What the experiments of ibrdf_bench share.
#pragma once
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <functional>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/programs/common_flags.h"

namespace ibrdf {

// State of the program, set before run() of an experiment is called.
struct BenchSession {
  CommonFlags common;
  std::string command;          // as typed
  std::function<Status()> run;  // of the experiment on the command line
  const std::atomic<bool>* stop = nullptr;

  // Prints a line at once; empty with --quiet.
  std::function<void(const std::string&)> Report() const {
    if (common.quiet) return {};
    return [](const std::string& line) {
      std::printf("%s\n", line.c_str());
      std::fflush(stdout);
    };
  }
};

// A subcommand with the options that every program has; `run` is called when it
// is the one on the command line.
inline CLI::App* AddExperiment(CLI::App* app, const std::string& name,
                               const std::string& description,
                               BenchSession* session,
                               std::function<Status()> run) {
  CLI::App* experiment = app->add_subcommand(name, description);
  AddCommonFlags(experiment, &session->common);
  experiment->callback([session, run] { session->run = run; });
  return experiment;
}

// --only i/n.
struct OnlyFlag {
  std::string text = "1/1";
  int index = 1, count = 1;

  Status Parse() {
    int used = 0;
    if (std::sscanf(text.c_str(), "%d/%d%n", &index, &count, &used) != 2 ||
        used != static_cast<int>(text.size()) || index < 1 || index > count) {
      return InvalidInput("command line: --only",
                          "expected i/n with 1 <= i <= n, found " + text);
    }
    return OkStatus();
  }
};

}  // namespace ibrdf
