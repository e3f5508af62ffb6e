#include "ibrdf/solvers/programs/common_flags.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "ibrdf/base/freed_memory.h"
#include "ibrdf/base/version.h"

namespace ibrdf {
namespace {

// Prints the one line "error: <file>: <field>: <what>" on stderr unless ok.
// Returns the exit status of the program.
int FinishProgram(const Status& status) {
  if (!status.ok()) {
    std::string line = status.message();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fprintf(stderr, "error: %s\n", line.c_str());
  }
  return status.ExitCode();
}

// Ends the process without the libraries' farewell: OpenBLAS joins its threads
// there, and one that a limit denies its memory asks for it forever. Sanitizers
// look for leaks at an orderly exit, so they get it.
int LeaveProgram(int code) {
  std::fflush(nullptr);
#if !defined(__SANITIZE_ADDRESS__)
  std::_Exit(code);
#endif
  return code;
}

}  // namespace

void AddCommonFlags(CLI::App* app, CommonFlags* flags) {
  app->add_option("--threads", flags->threads,
                  "number of threads; 0: all of the machine")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_option("--seed", flags->seed,
                  "seed of random numbers; the same seed gives the same bits")
      ->capture_default_str();
  app->add_flag("--quiet", flags->quiet, "print no progress");
  app->set_version_flag("--version", std::string("ibrdf ") + kVersion);
}

int RunProgram(CLI::App* app, int argc, char** argv,
               const std::function<Status()>& run) {
  KeepFreedMemory();
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& e) {
    return LeaveProgram(app->exit(e));  // prints the help or the version
  } catch (const CLI::ParseError& e) {
    return LeaveProgram(FinishProgram(InvalidInput("command line", e.what())));
  }
  Status status;
  try {
    status = run();
  } catch (const std::bad_alloc&) {
    status = Status(StatusCode::kInternal, "out of memory");
  } catch (const std::exception& e) {
    status = Status(StatusCode::kInternal, e.what());
  }
  return LeaveProgram(FinishProgram(status));
}

void PrintWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
}

}  // namespace ibrdf
