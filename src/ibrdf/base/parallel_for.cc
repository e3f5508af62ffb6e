#include "ibrdf/base/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
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
    const int helpers =
        static_cast<int>(std::min<int64_t>(num_threads, count)) - 1;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      while (static_cast<int>(threads_.size()) < helpers) {
        const int worker = static_cast<int>(threads_.size()) + 1;
        threads_.emplace_back([this, worker] { Wait(worker); });
        threads_.back().detach();
      }
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
  }

 private:
  void Work(int worker) {
    inside_parallel_for = true;
    for (int64_t i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) {
      (*body_)(i, worker);
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
