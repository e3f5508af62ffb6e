#include "ibrdf/visibility/visibility.h"

#include <glog/logging.h>

#include <algorithm>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {
namespace {
constexpr int64_t kAbsent = -2;
constexpr int64_t kClear = -1;
// Points that one worker takes at a time.
constexpr int64_t kPointsPerChunk = 64;
}  // namespace

Visibility::Visibility(const Scene& scene,
                       const std::vector<ShadingPoint>& points,
                       const VisibilityOptions& options)
    : grid_(scene, options.rows), num_threads_(options.num_threads) {
  Add(points);
}

void Visibility::Add(const std::vector<ShadingPoint>& points) {
  const auto count = static_cast<int64_t>(points.size());
  const int64_t chunks = (count + kPointsPerChunk - 1) / kPointsPerChunk;
  struct Chunk {
    std::vector<int64_t> shadowed;  // points
    std::vector<uint64_t> bits;
    int64_t rays = 0;
  };
  std::vector<Chunk> found(chunks);
  std::vector<VisibilityGrid::Scratch> scratch(
      num_threads_ > 0 ? num_threads_ : HardwareThreads());
  ParallelFor(chunks, num_threads_, [&](int64_t index, int worker) {
    Chunk& chunk = found[index];
    VisibilityGrid::Bits bits;
    const int64_t end = std::min((index + 1) * kPointsPerChunk, count);
    for (int64_t i = index * kPointsPerChunk; i < end; ++i) {
      if (!grid_.Trace(points[i], &scratch[worker], &bits, &chunk.rays)) {
        continue;
      }
      chunk.shadowed.push_back(i);
      chunk.bits.insert(chunk.bits.end(), bits.begin(), bits.end());
    }
  });
  for (const ShadingPoint& point : points) {
    CHECK_GE(point.index, 0);
    if (begin_.size() <= static_cast<size_t>(point.index)) {
      begin_.resize(point.index + size_t{1}, kAbsent);
    }
    CHECK_EQ(begin_[point.index], kAbsent) << "two points of one index";
    begin_[point.index] = kClear;
  }
  for (const Chunk& chunk : found) {
    auto begin = static_cast<int64_t>(bits_.size());
    bits_.insert(bits_.end(), chunk.bits.begin(), chunk.bits.end());
    for (const int64_t i : chunk.shadowed) {
      begin_[points[i].index] = begin;
      begin += static_cast<int64_t>(grid_.words());
    }
    num_rays_ += chunk.rays;
  }
}

const uint64_t* Visibility::Hidden(const ShadingPoint& point) const {
  CHECK(point.index >= 0 && static_cast<size_t>(point.index) < begin_.size());
  const int64_t begin = begin_[point.index];
  CHECK_NE(begin, kAbsent) << "a point of another image";
  return begin == kClear ? nullptr : &bits_[begin];
}

size_t Visibility::MemoryBytes() const {
  return bits_.capacity() * sizeof(uint64_t) +
         begin_.capacity() * sizeof(int64_t);
}

}  // namespace ibrdf
