#include "ibrdf/solvers/optim/blas_memory.h"

#include <sys/mman.h>
#include <sys/resource.h>

#include <string>
#include <vector>

#include "ibrdf/base/parallel_for.h"

// OpenBLAS's own; weak: other libraries have none, and no need of it.
extern "C" {
[[gnu::weak]] void* blas_memory_alloc(int where);
[[gnu::weak]] void blas_memory_free(void* buffer);
}

namespace ibrdf {
namespace {

constexpr size_t kBufferMb = 136;  // 128 and a page, and what it aligns to

bool Fits(size_t mb) {
  void* const at = ::mmap(nullptr, mb << 20, PROT_NONE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) return false;
  ::munmap(at, mb << 20);
  return true;
}

}  // namespace

Status ReserveBlasMemory(int num_threads) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
      blas_memory_alloc == nullptr || blas_memory_free == nullptr) {
    return OkStatus();
  }
  if (num_threads <= 0) num_threads = HardwareThreads();
  // One more for a thread of OpenBLAS that still waits for its own.
  const size_t mb = kBufferMb * (static_cast<size_t>(num_threads) + 1);
  if (!Fits(mb)) {
    return Status(StatusCode::kInternal,
                  "out of memory: the address space is limited to " +
                      std::to_string(limit.rlim_cur >> 20) + " MB and has no " +
                      std::to_string(mb) +
                      " MB left for the linear algebra of " +
                      std::to_string(num_threads) + " threads");
  }
  std::vector<void*> buffers;
  for (int i = 0; i < num_threads; ++i) buffers.push_back(blas_memory_alloc(0));
  for (void* const buffer : buffers) blas_memory_free(buffer);
  return OkStatus();
}

}  // namespace ibrdf
