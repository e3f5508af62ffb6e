#include "ibrdf/solvers/optim/blas_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>

#include "ibrdf/solvers/optim/dense_algebra.h"

namespace ibrdf {
namespace {

// Exit status of `body` in a child whose address space may grow by `mb`; -1
// where a signal ended it, as the alarm does that ends one that waits.
int ExitUnderLimit(size_t mb, const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    long pages = 0;
    std::FILE* const file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr || std::fscanf(file, "%ld", &pages) != 1) ::_exit(99);
    std::fclose(file);
    const rlim_t bytes =
        static_cast<rlim_t>(pages) * ::sysconf(_SC_PAGESIZE) + (mb << 20);
    const rlimit limit{bytes, bytes};
    if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(99);
    ::alarm(60);
    ::_exit(body());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#if defined(__SANITIZE_ADDRESS__)
// A sanitizer's shadow does not live under such a limit.
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

TEST(BlasMemory, TooLittleIsRefusedRatherThanAwaited) {
  if (kSanitized) GTEST_SKIP() << "SKIPPED: no limits under a sanitizer";
  EXPECT_EQ(1,
            ExitUnderLimit(40, [] { return ReserveBlasMemory(2).ExitCode(); }));
}

TEST(BlasMemory, WhatIsReservedServesLater) {
  if (kSanitized) GTEST_SKIP() << "SKIPPED: no limits under a sanitizer";
  EXPECT_EQ(0, ExitUnderLimit(700, [] {
              const Status reserved = ReserveBlasMemory(2);
              if (!reserved.ok()) return reserved.ExitCode();
              // Takes the rest: what the product needs is there already.
              rlimit limit{};
              ::getrlimit(RLIMIT_AS, &limit);
              long pages = 0;
              std::FILE* const file = std::fopen("/proc/self/statm", "r");
              if (file == nullptr || std::fscanf(file, "%ld", &pages) != 1)
                return 99;
              std::fclose(file);
              limit.rlim_cur =
                  static_cast<rlim_t>(pages) * ::sysconf(_SC_PAGESIZE) +
                  (20 << 20);
              if (::setrlimit(RLIMIT_AS, &limit) != 0) return 99;
              const RowMatrix a = RowMatrix::Constant(200, 200, 1.0);
              RowMatrix c;
              Multiply(a, a, &c);
              return c(7, 9) == 200.0 ? 0 : 98;
            }));
}

TEST(BlasMemory, WithoutALimitThereIsNothingToDo) {
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  if (limit.rlim_cur != RLIM_INFINITY) {
    GTEST_SKIP() << "SKIPPED: this shell limits the address space";
  }
  EXPECT_TRUE(ReserveBlasMemory(1024).ok());
}

}  // namespace
}  // namespace ibrdf
