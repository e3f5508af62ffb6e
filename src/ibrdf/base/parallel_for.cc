#include "ibrdf/base/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace ibrdf {
namespace {

thread_local bool inside_parallel_for = false;

// One loop at a time; threads are made on first use and wait between loops.
class Pool {
 public:
  static Pool& Instance() {
    static Pool* pool =
        new Pool();  // never destroyed: threads may outlive main
    return *pool;
  }

  void Run(int64_t count, int num_threads,
           const std::function<void(int64_t, int)>& body) {
    const std::lock_guard<std::mutex> one_loop(loop_mutex_);
    int helpers = static_cast<int>(std::min<int64_t>(num_threads, count)) - 1;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      AddThreads(helpers);
      helpers = std::min(helpers, static_cast<int>(threads_.size()));
      body_ = &body;
      count_ = count;
      next_.store(0);
      wanted_ = helpers;
      running_ = helpers;
      ++generation_;
    }
    wake_.notify_all();
    Work(0);
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [this] { return running_ == 0; });
    body_ = nullptr;
    if (const std::exception_ptr thrown = std::exchange(thrown_, nullptr)) {
      std::rethrow_exception(thrown);
    }
  }

 private:
  // To `wanted` threads, or as many as the system grants.
  void AddThreads(int wanted) {
    try {
      while (static_cast<int>(threads_.size()) < wanted) {
        const int worker = static_cast<int>(threads_.size()) + 1;
        threads_.emplace_back([this, worker] { Wait(worker); });
        threads_.back().detach();
      }
    } catch (const std::system_error&) {  // fewer do
    } catch (const std::bad_alloc&) {
    }
  }

  void Work(int worker) {
    inside_parallel_for = true;
    try {
      for (int64_t i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) {
        (*body_)(i, worker);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (thrown_ == nullptr) thrown_ = std::current_exception();
      next_.store(count_);  // the rest is not wanted
    }
    inside_parallel_for = false;
  }

  void Wait(int worker) {
    uint64_t seen = 0;
    for (;;) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        wake_.wait(lock, [&] { return generation_ != seen; });
        seen = generation_;
        if (worker > wanted_) continue;
      }
      Work(worker);
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (--running_ == 0) done_.notify_one();
      }
    }
  }

  std::mutex loop_mutex_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<std::thread> threads_;
  const std::function<void(int64_t, int)>* body_ = nullptr;
  std::exception_ptr thrown_;  // by the first body that did
  int64_t count_ = 0;
  std::atomic<int64_t> next_{0};
  int wanted_ = 0;
  int running_ = 0;
  uint64_t generation_ = 0;
};

}  // namespace

int HardwareThreads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void ParallelFor(int64_t count, int num_threads,
                 const std::function<void(int64_t, int)>& body) {
  if (count <= 0) return;
  if (num_threads <= 0) num_threads = HardwareThreads();
  if (num_threads == 1 || count == 1 || inside_parallel_for) {
    for (int64_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  Pool::Instance().Run(count, num_threads, body);
}

}  // namespace ibrdf
