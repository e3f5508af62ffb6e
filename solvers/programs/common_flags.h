// Options and exit statuses that every program shares.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

struct CommonFlags {
  int threads = 0;     // 0: all hardware threads
  uint64_t seed = 1;   // of every random number
  bool quiet = false;  // no progress
};

// Adds --threads, --seed, --quiet and --version.
void AddCommonFlags(CLI::App* app, CommonFlags* flags);

// Parses the command line, calls run() and leaves the process with the exit
// status, which it also returns: 0 after --help or --version, 2 for a bad
// option, else that of run()'s status; 1 for an exception. A failure is one
// line on stderr, "error: <file>: <field>: <what>".
int RunProgram(CLI::App* app, int argc, char** argv,
               const std::function<Status()>& run);

// A line on stderr for each, "warning: ...", with --quiet too.
void PrintWarnings(const std::vector<std::string>& warnings);

}  // namespace ibrdf
