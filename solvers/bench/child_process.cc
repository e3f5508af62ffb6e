#include "ibrdf/solvers/bench/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include "ibrdf/base/stopwatch.h"

namespace ibrdf {
namespace {

constexpr std::chrono::milliseconds kPoll(20);

// Largest resident memory of a running process so far, KiB; 0 where the system
// does not tell.
long ResidentPeak(pid_t child) {
  std::ifstream status("/proc/" + std::to_string(child) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) {
      return std::strtol(line.c_str() + std::strlen("VmHWM:"), nullptr, 10);
    }
  }
  return 0;
}

// In the child: ends with its parent, also where that one is killed. One that
// goes on would share folder and machine with the child of the next try.
void DieWithParent(pid_t parent) {
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // gone before the call
#else
  (void)parent;
#endif
}

// Starts argv with stdout and stderr in the file `output`. Negative where there
// is no process for it.
pid_t StartChild(const std::vector<std::string>& argv, int output) {
  std::vector<char*> arguments;
  for (const std::string& a : argv) {
    arguments.push_back(const_cast<char*>(a.c_str()));
  }
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child != 0) return child;
  DieWithParent(parent);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

struct EndOfChild {
  int status = 0;  // of wait4
  rusage usage{};
  long sampled = 0;  // ResidentPeak while it ran
};

// Waits for the child, which SIGINT asks to end once `stop` is set. False where
// it cannot wait.
bool WaitForChild(pid_t child, const std::atomic<bool>* stop, EndOfChild* end) {
  bool stopped = false;
  for (;;) {
    const pid_t ended = ::wait4(child, &end->status, WNOHANG, &end->usage);
    if (ended == child) return true;
    if (ended < 0 && errno != EINTR) return false;
    end->sampled = std::max(end->sampled, ResidentPeak(child));
    if (stop != nullptr && *stop && !stopped) {
      ::kill(child, SIGINT);
      stopped = true;
    }
    std::this_thread::sleep_for(kPoll);
  }
}

// KiB. ru_maxrss counts the copy of this process before exec too, and is the
// child's own peak only above our size.
long PeakOf(const EndOfChild& end, const rusage& own) {
  return end.sampled == 0 || end.usage.ru_maxrss > own.ru_maxrss
             ? end.usage.ru_maxrss
             : end.sampled;
}

double ProcessorSeconds(const rusage& usage) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

StatusOr<ChildResult> RunChild(const std::vector<std::string>& argv,
                               const std::string& log,
                               const std::atomic<bool>* stop) {
  const int output =
      ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) return InvalidInput(log, std::strerror(errno));
  rusage own{};
  ::getrusage(RUSAGE_SELF, &own);
  const Stopwatch watch;
  const pid_t child = StartChild(argv, output);
  ::close(output);
  if (child < 0) {
    return Status(StatusCode::kInternal,
                  argv[0] + ": fork: " + std::strerror(errno));
  }
  EndOfChild end;
  if (!WaitForChild(child, stop, &end)) {
    return Status(StatusCode::kInternal,
                  argv[0] + ": wait4: " + std::strerror(errno));
  }
  ChildResult result;
  result.seconds = watch.Seconds();
  result.cpu_seconds = ProcessorSeconds(end.usage);
  result.peak_mb = static_cast<double>(PeakOf(end, own)) / 1024.0;
  if (WIFSIGNALED(end.status)) {
    result.signal = WTERMSIG(end.status);
  } else {
    result.exit_code = WEXITSTATUS(end.status);
  }
  return result;
}

}  // namespace ibrdf
