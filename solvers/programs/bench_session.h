// What the experiments of ibrdf_bench share.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/programs/common_flags.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

// State of the program, set before run() of an experiment is called.
struct BenchSession {
  CommonFlags common;
  std::string command;          // as typed
  std::function<Status()> run;  // of the experiment on the command line
  const std::atomic<bool>* stop = nullptr;

  // Prints a line at once; empty with --quiet.
  std::function<void(const std::string&)> Report() const;
};

// A subcommand with the options that every program has; `run` is called when it
// is the one on the command line.
CLI::App* AddExperiment(CLI::App* app, const std::string& name,
                        const std::string& description, BenchSession* session,
                        std::function<Status()> run);

// --only i/n: every n-th case from the i-th.
struct OnlyFlag {
  std::string text = "1/1";
  int index = 1, count = 1;  // set by Parse

  Status Parse();
};

}  // namespace ibrdf
