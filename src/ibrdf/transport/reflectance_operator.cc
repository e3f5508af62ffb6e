#include <algorithm>
#include <cstdint>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/transport/lobe_contraction.h"
#include "ibrdf/transport/transport.h"
#include "ibrdf/transport/transport_taps.h"

namespace ibrdf {

using namespace taps;  // NOLINT

namespace {

int LobeStride(int num_fields) {
  return (num_fields + kLobeStride - 1) / kLobeStride * kLobeStride;
}

// Fields side by side at every node of the padded grid:
// [nodes][LobeStride(num_fields)].
std::vector<float> FieldsByNode(const BrdfGridShape& s,
                                const float* const* fields, int num_fields,
                                int num_threads) {
  const int stride = LobeStride(num_fields);
  const int row = s.p + 1;
  std::vector<float> by_node(static_cast<size_t>(s.h) * s.d * row * stride,
                             0.0f);
  ParallelFor(s.h, num_threads, [&](int64_t ih, int) {
    for (int hd = static_cast<int>(ih) * s.d; hd < (ih + 1) * s.d; ++hd) {
      for (int p = 0; p <= s.p; ++p) {
        float* to = &by_node[(static_cast<size_t>(hd) * row + p) * stride];
        for (int k = 0; k < num_fields; ++k) {
          to[k] = fields[k][hd * s.p + p % s.p];
        }
      }
    }
  });
  return by_node;
}

}  // namespace

template <typename Use>
void Transport::GatherLight(const Chunk& chunk,
                            const std::vector<float>& texels,
                            const std::vector<float>& blocks,
                            GatheredLight* scratch, const Use& use) const {
  const Corners corners(options_.grid);
  const int row = map_width_ + 1;
  GatheredLight& w = *scratch;
  w.by_node.resize(size_t{4} * PaddedNodes(), 0.0f);
  w.touched.resize(PaddedNodes(), 0);
  const auto scatter = [&](const auto& pair, Float4 light) {
    float weight[8];
    TrilinearWeights(pair, weight);
    for (int k = 0; k < 8; ++k) {
      const uint32_t node = pair.node + corners.offset[k];
      if (w.touched[node] == 0) {
        w.touched[node] = 1;
        w.nodes.push_back(node);
      }
      Add4(&w.by_node[size_t{4} * node], weight[k] * light);
    }
  };
  std::vector<float> light;
  size_t far = 0, near = 0;
  for (int i = 0; i < chunk.end - chunk.begin; ++i) {
    w.nodes.clear();
    for (; far < chunk.far_end[i]; ++far) {
      const FarPair& pair = chunk.far[far];
      scatter(pair, pair.weight * Load4(&blocks[size_t{4} * pair.block]));
    }
    for (; near < chunk.near_end[i]; ++near) {
      const NearPair& pair = chunk.near[near];
      scatter(pair, pair.weight * LookUp(pair, row, texels.data()));
    }
    light.resize(4 * w.nodes.size());
    for (size_t k = 0; k < w.nodes.size(); ++k) {
      float* const at = &w.by_node[size_t{4} * w.nodes[k]];
      std::copy_n(at, 4, &light[4 * k]);
      std::fill_n(at, 4, 0.0f);
      w.touched[w.nodes[k]] = 0;
    }
    use(chunk.begin + i, w.nodes, light);
  }
}

void Transport::RenderLobes(const float* const* fields, int num_fields,
                            const float* map, float* out,
                            const double* emitted) const {
  if (num_fields <= 0) return;
  const std::vector<float> by_node =
      FieldsByNode(options_.grid, fields, num_fields, options_.num_threads);
  const int stride = LobeStride(num_fields);
  const std::vector<float> texels = PadMap(map),
                           blocks = FarSources(map, emitted);
  const ContractLobesFunction contract = ContractLobes();
  std::vector<GatheredLight> scratch(
      options_.num_threads > 0 ? options_.num_threads : HardwareThreads());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int worker) {
        std::vector<float> sums(size_t{3} * stride);
        GatherLight(
            chunks_[index], texels, blocks, &scratch[worker],
            [&](int point, const std::vector<uint32_t>& nodes,
                const std::vector<float>& light) {
              contract(nodes.data(), static_cast<int>(nodes.size()),
                       light.data(), by_node.data(), stride, sums.data());
              std::copy_n(sums.data(), 3 * num_fields,
                          out + static_cast<size_t>(point) * 3 * num_fields);
            });
      });
}

ReflectanceOperator Transport::ByReflectance(const float* map) const {
  const std::vector<float> texels = PadMap(map),
                           blocks = FarSources(map, nullptr);
  ReflectanceOperator op;
  op.grid_ = options_.grid;
  op.num_points_ = num_points_;
  op.num_threads_ = options_.num_threads;
  op.chunks_.resize(chunks_.size());
  std::vector<GatheredLight> scratch(
      options_.num_threads > 0 ? options_.num_threads : HardwareThreads());
  ParallelFor(static_cast<int64_t>(chunks_.size()), options_.num_threads,
              [&](int64_t index, int worker) {
                ReflectanceOperator::Chunk& out = op.chunks_[index];
                out.begin = chunks_[index].begin;
                out.end = chunks_[index].end;
                GatherLight(chunks_[index], texels, blocks, &scratch[worker],
                            [&out](int, const std::vector<uint32_t>& nodes,
                                   const std::vector<float>& light) {
                              out.node.insert(out.node.end(), nodes.begin(),
                                              nodes.end());
                              out.light.insert(out.light.end(), light.begin(),
                                               light.end());
                              out.entry_end.push_back(out.node.size());
                            });
                out.node.shrink_to_fit();
                out.light.shrink_to_fit();
              });
  return op;
}

void ReflectanceOperator::Apply(const float* const* fields, int num_fields,
                                float* out) const {
  if (num_fields <= 0) return;
  const std::vector<float> by_node =
      FieldsByNode(grid_, fields, num_fields, num_threads_);
  const int stride = LobeStride(num_fields);
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
