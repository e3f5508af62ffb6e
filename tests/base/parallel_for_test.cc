#include "ibrdf/base/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <numeric>
#include <thread>
#include <vector>

namespace ibrdf {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceForAnyThreadCount) {
  for (const int threads : {1, 2, 8}) {
    std::vector<int> visits(1000, 0);
    std::atomic<bool> worker_in_range{true};
    for (int repeat = 0; repeat < 20; ++repeat) {
      ParallelFor(1000, threads, [&](int64_t i, int worker) {
        ++visits[i];
        if (worker < 0 || worker >= threads) worker_in_range = false;
      });
    }
    EXPECT_EQ(std::vector<int>(1000, 20), visits);
    EXPECT_TRUE(worker_in_range);
  }
}

TEST(ParallelFor, NestedCallRunsInItsOwnThread) {
  std::vector<int> sums(8, 0);
  ParallelFor(8, 2, [&](int64_t i, int) {
    ParallelFor(10, 2, [&](int64_t j, int worker) {
      EXPECT_EQ(0, worker);
      sums[i] += static_cast<int>(j);
    });
  });
  EXPECT_EQ(std::vector<int>(8, 45), sums);
}

TEST(ParallelFor, ThrowsOnWhatABodyThrewWhenAllThreadsAreDone) {
  for (const int threads : {1, 2, 8}) {
    for (const int64_t bad : {0, 1, 500, 999}) {
      std::atomic<int> inside{0};
      const auto body = [&](int64_t i, int) {
        ++inside;
        std::this_thread::yield();
        --inside;
        if (i == bad) throw std::bad_alloc();
      };
      EXPECT_THROW(ParallelFor(1000, threads, body), std::bad_alloc);
      EXPECT_EQ(0, inside);
    }
    // The pool goes on.
    std::atomic<int> visits{0};
    ParallelFor(1000, threads, [&](int64_t, int) { ++visits; });
    EXPECT_EQ(1000, visits);
  }
}

}  // namespace
}  // namespace ibrdf
