#include "ibrdf/transport/reflectance_operator.h"

#include <algorithm>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/transport/gathered_light.h"
#include "ibrdf/transport/lobe_contraction.h"
#include "ibrdf/transport/transport_pairs.h"

namespace ibrdf {

ReflectanceOperator::ReflectanceOperator(const TransportPairs& pairs,
                                         const PairSources& sources)
    : grid_(pairs.grid),
      num_points_(pairs.num_points),
      num_threads_(pairs.num_threads),
      chunks_(pairs.chunks.size()) {
  std::vector<LightGatherer> gatherers(num_threads_ > 0 ? num_threads_
                                                        : HardwareThreads());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), num_threads_,
      [&](int64_t index, int worker) {
        const PairChunk& from = pairs.chunks[index];
        Chunk& out = chunks_[index];
        out.begin = from.begin;
        out.end = from.end;
        gatherers[worker].Gather(
            pairs, sources, from,
            [&out](int, const std::vector<uint32_t>& nodes,
                   const std::vector<float>& light) {
              out.node.insert(out.node.end(), nodes.begin(), nodes.end());
              out.light.insert(out.light.end(), light.begin(), light.end());
              out.entry_end.push_back(out.node.size());
            });
        out.node.shrink_to_fit();
        out.light.shrink_to_fit();
      });
}

void ReflectanceOperator::Apply(const float* const* fields, int num_fields,
                                float* out) const {
  if (num_fields <= 0) return;
  const int stride = LobeStride(num_fields);
  const std::vector<float> by_node =
      PadFields(grid_, fields, num_fields, stride, num_threads_);
  const ContractLobesFunction contract = ContractLobes();
  ParallelFor(static_cast<int64_t>(chunks_.size()), num_threads_,
              [&](int64_t index, int) {
                const Chunk& chunk = chunks_[index];
                std::vector<float> sums(size_t{3} * stride);
                size_t begin = 0;
                for (int i = chunk.begin; i < chunk.end; ++i) {
                  const size_t end = chunk.entry_end[i - chunk.begin];
                  contract(&chunk.node[begin], static_cast<int>(end - begin),
                           &chunk.light[4 * begin], by_node.data(), stride,
                           sums.data());
                  std::copy_n(sums.data(), 3 * num_fields,
                              out + static_cast<size_t>(i) * 3 * num_fields);
                  begin = end;
                }
              });
}

size_t ReflectanceOperator::MemoryBytes() const {
  size_t bytes = 0;
  for (const Chunk& chunk : chunks_) {
    bytes += chunk.node.capacity() * sizeof(uint32_t) +
             chunk.light.capacity() * sizeof(float) +
             chunk.entry_end.capacity() * sizeof(size_t);
  }
  return bytes;
}

}  // namespace ibrdf
