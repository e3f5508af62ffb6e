// Loops over two or more cores, with the same bits for any number of them.
#pragma once
#include <cstdint>
#include <functional>

namespace ibrdf {

// Number of hardware threads, at least 1.
int HardwareThreads();

// Calls body(index, worker) once for every index in [0, count), on up to
// `num_threads` threads (<= 0: HardwareThreads()) of a shared pool;
// worker is in [0, num_threads). Which worker takes an index is not
// deterministic, so write results to slots that belong to the index and join
// them in index order. A call from inside a body runs in that thread.
// What a body throws (no memory) ends the loop and is thrown on by the call.
void ParallelFor(int64_t count, int num_threads,
                 const std::function<void(int64_t index, int worker)>& body);

}  // namespace ibrdf
