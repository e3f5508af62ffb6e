#include <algorithm>
#include <cstdint>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"
#include "ibrdf/transport/transport.h"
#include "ibrdf/transport/transport_taps.h"

namespace ibrdf {

using namespace taps;  // NOLINT

LightOperator Transport::ByLight(const BrdfGrid& grid) const {
  const std::vector<float> f = PadGrid(grid);
  const Corners corners(options_.grid);
  const std::vector<int> texel = PaddedTexels(map_height_, map_width_);
  const int row = map_width_ + 1;
  LightOperator op;
  op.map_height_ = map_height_;
  op.map_width_ = map_width_;
  op.block_ = block_;
  op.num_blocks_ = num_blocks_;
  op.num_threads_ = options_.num_threads;
  if (patches_ != nullptr) {
    op.bounces_ = bounces();
    op.patches_ =
        std::make_shared<const LightOperator>(patches_->ByLight(grid));
  }
  const size_t num_texels = static_cast<size_t>(map_height_) * map_width_;
  const size_t num_sources =
      num_blocks_ + num_texels + static_cast<size_t>(num_patches());
  op.num_sources_ = num_sources;
  op.chunks_.resize(chunks_.size());
  // Per worker: a point's sums by source, all zero between points, and which
  // sources it has touched, in order of first touch.
  struct Scratch {
    std::vector<float> sums;
    std::vector<uint8_t> touched;
    std::vector<uint32_t> sources;
  };
  std::vector<Scratch> scratch(options_.num_threads > 0 ? options_.num_threads
                                                        : HardwareThreads());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int worker) {
        Scratch& w = scratch[worker];
        w.sums.resize(4 * num_sources, 0.0f);
        w.touched.resize(num_sources, 0);
        const auto add = [&](size_t source, Float4 v) {
          if (w.touched[source] == 0) {
            w.touched[source] = 1;
            w.sources.push_back(static_cast<uint32_t>(source));
          }
          Add4(&w.sums[4 * source], v);
        };
        const Chunk& chunk = chunks_[index];
        LightOperator::Chunk& out = op.chunks_[index];
        out.begin = chunk.begin;
        out.end = chunk.end;
        size_t far = 0, near = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          w.sources.clear();
          for (; far < chunk.far_end[i]; ++far) {
            const FarPair& pair = chunk.far[far];
            if (pair.block >= num_blocks_ + num_patches()) continue;
            const size_t patches = pair.block < num_blocks_ ? 0 : num_texels;
            add(patches + pair.block,
                pair.weight * Interpolate(pair, corners, f.data()));
          }
          for (; near < chunk.near_end[i]; ++near) {
            const NearPair& pair = chunk.near[near];
            const Float4 v = pair.weight * Interpolate(pair, corners, f.data());
            float weight[4];
            BilinearWeights(pair, weight);
            const int* const to = &texel[pair.texel];
            add(num_blocks_ + to[0], weight[0] * v);
            add(num_blocks_ + to[1], weight[1] * v);
            add(num_blocks_ + to[row], weight[2] * v);
            add(num_blocks_ + to[row + 1], weight[3] * v);
          }
          for (const uint32_t source : w.sources) {
            const float* const sum = &w.sums[size_t{4} * source];
            out.source.push_back(source);
            out.value.insert(out.value.end(), sum, sum + 3);
            std::fill_n(&w.sums[size_t{4} * source], 4, 0.0f);
            w.touched[source] = 0;
          }
          out.entry_end.push_back(out.source.size());
        }
        out.value.push_back(0.0f);
        out.source.shrink_to_fit();
        out.value.shrink_to_fit();
      });
  return op;
}

size_t LightOperator::MemoryBytes() const {
  size_t bytes = patches_ != nullptr ? patches_->MemoryBytes() : 0;
  for (const Chunk& chunk : chunks_) {
    bytes += chunk.source.capacity() * sizeof(uint32_t) +
             chunk.value.capacity() * sizeof(float) +
             chunk.entry_end.capacity() * sizeof(size_t);
  }
  return bytes;
}

std::vector<float> LightOperator::Sources(const float* map) const {
  std::vector<float> sources = SumBlocks(map, map_height_, map_width_, block_);
  sources.resize(4 * num_sources_, 0.0f);
  float* out = &sources[size_t{4} * num_blocks_];
  const size_t texels = static_cast<size_t>(map_height_) * map_width_;
  for (size_t t = 0; t < texels; ++t) std::copy_n(map + 3 * t, 3, out + 4 * t);
  return sources;
}

void LightOperator::ApplyTo(const std::vector<float>& sources,
                            double* L_o) const {
  ParallelFor(static_cast<int64_t>(chunks_.size()), num_threads_,
              [&](int64_t index, int) {
                const Chunk& chunk = chunks_[index];
                size_t entry = 0;
                for (int i = 0; i < chunk.end - chunk.begin; ++i) {
                  // Lane 3 of a value belongs to the next entry; the map's is
                  // 0.
                  Double4 sum = {};
                  for (; entry < chunk.entry_end[i]; ++entry) {
                    sum +=
                        Widen(Load4(&chunk.value[3 * entry]) *
                              Load4(&sources[size_t{4} * chunk.source[entry]]));
                  }
                  for (int c = 0; c < 3; ++c) {
                    L_o[3 * static_cast<size_t>(chunk.begin + i) + c] = sum[c];
                  }
                }
              });
}

void LightOperator::Apply(const float* map, double* L_o) const {
  std::vector<float> sources = Sources(map);
  if (patches_ != nullptr) {
    std::vector<double> emitted(size_t{3} * patches_->num_points());
    for (int b = 0; b < bounces_; ++b) {
      patches_->ApplyTo(sources, emitted.data());
      for (size_t k = 0; k < emitted.size(); ++k) {
        sources[4 * (num_map_sources() + k / 3) + k % 3] =
            static_cast<float>(emitted[k]);
      }
    }
  }
  ApplyTo(sources, L_o);
}

void LightOperator::AddTranspose(const double* adjoint,
                                 std::vector<double>* sums) const {
  std::vector<std::vector<float>> partial(chunks_.size());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), num_threads_,
      [&](int64_t index, int) {
        const Chunk& chunk = chunks_[index];
        std::vector<float>& g = partial[index];
        g.assign(sums->size(), 0.0f);
        size_t entry = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          const double* a = adjoint + 3 * static_cast<size_t>(chunk.begin + i);
          const Float4 a4 = {static_cast<float>(a[0]), static_cast<float>(a[1]),
                             static_cast<float>(a[2]), 0.0f};
          for (; entry < chunk.entry_end[i]; ++entry) {
            Add4(&g[size_t{4} * chunk.source[entry]],
                 a4 * Load4(&chunk.value[3 * entry]));
          }
        }
      });
  for (const std::vector<float>& g : partial) {
    for (size_t i = 0; i < sums->size(); ++i) (*sums)[i] += g[i];
  }
}

void LightOperator::ApplyTranspose(const double* adjoint,
                                   float* gradient) const {
  std::vector<double> sums(4 * num_sources_, 0.0);
  AddTranspose(adjoint, &sums);
  // Of R_b, b falling: what is left for R_0 = 0 is dropped.
  for (int b = 0; b < bounces_; ++b) {
    std::vector<double> by_emitted(size_t{3} * patches_->num_points());
    for (size_t k = 0; k < by_emitted.size(); ++k) {
      double& sum = sums[4 * (num_map_sources() + k / 3) + k % 3];
      by_emitted[k] = sum;
      sum = 0.0;
    }
    patches_->AddTranspose(by_emitted.data(), &sums);
  }
  const int columns = map_width_ / block_;
  for (int y = 0; y < map_height_; ++y) {
    const double solid_angle = TexelSolidAngle(y, map_height_, map_width_);
    for (int x = 0; x < map_width_; ++x) {
      const size_t to = static_cast<size_t>(y) * map_width_ + x;
      const size_t block =
          static_cast<size_t>(y / block_) * columns + x / block_;
      for (int c = 0; c < 3; ++c) {
        gradient[3 * to + c] =
            static_cast<float>(sums[4 * (num_blocks_ + to) + c] +
                               solid_angle * sums[4 * block + c]);
      }
    }
  }
}

void LightOperator::AddEmitted(const double* emitted, int columns,
                               double* out) const {
  const size_t first = num_map_sources();
  ParallelFor(static_cast<int64_t>(chunks_.size()), num_threads_,
              [&](int64_t index, int) {
                const Chunk& chunk = chunks_[index];
                size_t entry = 0;
                for (int i = chunk.begin; i < chunk.end; ++i) {
                  for (; entry < chunk.entry_end[i - chunk.begin]; ++entry) {
                    if (chunk.source[entry] < first) continue;
                    const size_t patch = chunk.source[entry] - first;
                    for (size_t c = 0; c < 3; ++c) {
                      const double value = chunk.value[3 * entry + c];
                      const double* from = emitted + (3 * patch + c) * columns;
                      double* to =
                          out + (3 * static_cast<size_t>(i) + c) * columns;
                      for (int k = 0; k < columns; ++k)
                        to[k] += value * from[k];
                    }
                  }
                }
              });
}

}  // namespace ibrdf
