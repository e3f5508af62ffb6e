#include <cstdint>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/render/transport.h"
#include "ibrdf/render/transport_taps.h"

namespace ibrdf {

using namespace taps;  // NOLINT

LightOperator Transport::ByLight(const BrdfGrid& grid) const {
  const std::vector<float> f = PadGrid(grid);
  const Corners corners(options_.grid);
  LightOperator op(this);
  op.far_.resize(chunks_.size());
  op.near_.resize(chunks_.size());
  const auto fill = [&](const auto& pairs, std::vector<float>* values) {
    values->assign(3 * pairs.size() + 1, 0.0f);
    float* out = values->data();
    for (const auto& pair : pairs) {
      const Float4 v = pair.weight * Interpolate(pair, corners, f.data());
      for (int c = 0; c < 3; ++c) *out++ = v[c];
    }
  };
  ParallelFor(static_cast<int64_t>(chunks_.size()), options_.num_threads,
              [&](int64_t index, int) {
                fill(chunks_[index].far, &op.far_[index]);
                fill(chunks_[index].near, &op.near_[index]);
              });
  return op;
}

size_t LightOperator::MemoryBytes() const {
  size_t floats = 0;
  for (size_t i = 0; i < far_.size(); ++i) {
    floats += far_[i].capacity() + near_[i].capacity();
  }
  return floats * sizeof(float);
}

void LightOperator::Apply(const float* map, double* E) const {
  const Transport& t = *transport_;
  const std::vector<float> texels = t.PadMap(map), blocks = t.SumBlocks(map);
  const int row = t.map_width_ + 1;
  ParallelFor(static_cast<int64_t>(t.chunks_.size()), t.options_.num_threads,
              [&](int64_t index, int) {
                const Transport::Chunk& chunk = t.chunks_[index];
                const float* far_value = far_[index].data();
                const float* near_value = near_[index].data();
                size_t far = 0, near = 0;
                for (int i = 0; i < chunk.end - chunk.begin; ++i) {
                  // Lane 3 of a value belongs to the next pair; the map's is 0.
                  Double4 sum = {};
                  for (; far < chunk.far_end[i]; ++far, far_value += 3) {
                    sum +=
                        Widen(Load4(far_value) *
                              Load4(&blocks[size_t{4} * chunk.far[far].block]));
                  }
                  for (; near < chunk.near_end[i]; ++near, near_value += 3) {
                    sum += Widen(Load4(near_value) *
                                 LookUp(chunk.near[near], row, texels.data()));
                  }
                  for (int c = 0; c < 3; ++c) {
                    E[3 * static_cast<size_t>(chunk.begin + i) + c] = sum[c];
                  }
                }
              });
}

void LightOperator::ApplyTranspose(const double* adjoint,
                                   float* gradient) const {
  const Transport& t = *transport_;
  const int row = t.map_width_ + 1;
  const size_t num_texels = size_t{4} * row * (t.map_height_ + 2);
  const size_t num_blocks = size_t{4} * t.num_blocks_;
  struct Partial {
    std::vector<float> texels, blocks;
  };
  std::vector<Partial> partial(t.chunks_.size());
  ParallelFor(
      static_cast<int64_t>(t.chunks_.size()), t.options_.num_threads,
      [&](int64_t index, int) {
        const Transport::Chunk& chunk = t.chunks_[index];
        Partial& g = partial[index];
        g.texels.assign(num_texels, 0.0f);
        g.blocks.assign(num_blocks, 0.0f);
        const float* far_value = far_[index].data();
        const float* near_value = near_[index].data();
        size_t far = 0, near = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          const double* a = adjoint + 3 * static_cast<size_t>(chunk.begin + i);
          const Float4 a4 = {static_cast<float>(a[0]), static_cast<float>(a[1]),
                             static_cast<float>(a[2]), 0.0f};
          for (; far < chunk.far_end[i]; ++far, far_value += 3) {
            Add4(&g.blocks[size_t{4} * chunk.far[far].block],
                 a4 * Load4(far_value));
          }
          for (; near < chunk.near_end[i]; ++near, near_value += 3) {
            const Transport::NearPair& pair = chunk.near[near];
            float weight[4];
            BilinearWeights(pair, weight);
            const Float4 v = a4 * Load4(near_value);
            float* base = &g.texels[size_t{4} * pair.texel];
            Add4(base, weight[0] * v);
            Add4(base + 4, weight[1] * v);
            Add4(base + 4 * row, weight[2] * v);
            Add4(base + 4 * row + 4, weight[3] * v);
          }
        }
      });
  std::vector<double> texels(num_texels, 0.0), blocks(num_blocks, 0.0);
  for (const Partial& g : partial) {
    for (size_t i = 0; i < num_texels; ++i) texels[i] += g.texels[i];
    for (size_t i = 0; i < num_blocks; ++i) blocks[i] += g.blocks[i];
  }
  t.UnpadMapGradient(texels, blocks, gradient);
}

}  // namespace ibrdf
