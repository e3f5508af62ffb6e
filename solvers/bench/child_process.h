// A program run as a child, with what it took.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct ChildResult {
  int exit_code = 0;         // where signal is 0
  int signal = 0;            // that ended it
  double seconds = 0.0;      // wall clock
  double cpu_seconds = 0.0;  // of all its threads
  double peak_mb = 0.0;      // largest resident memory, 2^20 bytes
};

// Runs argv[0] with the arguments argv and both outputs in the file `log`, and
// waits for it. `stop` (may be null), once true, passes SIGINT on to the child.
// Fails when the child cannot be started; a program that cannot be executed
// exits with 127. On Linux the child is killed when the calling thread ends, as
// it does where this process is killed.
StatusOr<ChildResult> RunChild(const std::vector<std::string>& argv,
                               const std::string& log,
                               const std::atomic<bool>* stop);

}  // namespace ibrdf
