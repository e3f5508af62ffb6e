#include "ibrdf/base/freed_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <vector>

namespace ibrdf {
namespace {

long PageFaults() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

void TouchEightMegabytes() {
  std::vector<double> values(size_t{1} << 20, 1.0);
  EXPECT_EQ(1.0, values[values.size() / 2]);
}

TEST(FreedMemory, IsUsedAgain) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "another allocator than glibc's";
#endif
  KeepFreedMemory();
  TouchEightMegabytes();
  const long before = PageFaults();
  for (int i = 0; i < 20; ++i) TouchEightMegabytes();
  // 2048 pages each time, were they given back.
  EXPECT_LT(PageFaults() - before, 2048);
}

}  // namespace
}  // namespace ibrdf
