#include "ibrdf/transport/light_operator.h"

#include <algorithm>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"
#include "ibrdf/transport/transport_pairs.h"

namespace ibrdf {

using namespace taps;  // NOLINT

namespace {

// The sum over entries [begin, end) of value [entry][3] times source. Four
// sums, so that no addition waits for the one before it.
Double4 SumOf(const float* value, const uint32_t* source, const float* sources,
              size_t begin, size_t end) {
  // Lane 3 of a value belongs to the next entry; the map's is 0.
  const auto product = [&](size_t entry) {
    return Widen(Load4(value + 3 * entry) *
                 Load4(sources + size_t{4} * source[entry]));
  };
  Double4 sums[4] = {};
  for (; begin + 4 <= end; begin += 4) {
    for (int k = 0; k < 4; ++k) sums[k] += product(begin + k);
  }
  for (; begin < end; ++begin) sums[0] += product(begin);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace

// Joins pairs by source, one point after another. One per worker: its sums are
// all zero between points.
class LightOperator::EntryBuilder {
 public:
  EntryBuilder(const TransportPairs& pairs, const PaddedGrids& grids,
               LightOperator* op)
      : pairs_(pairs), corners_(pairs.grid), grids_(grids), op_(*op) {}

  // The entries of a chunk, and the bright light of its points.
  void Join(const PairChunk& from, Chunk* to) {
    sums_.resize(4 * op_.num_sources_, 0.0f);
    touched_.resize(op_.num_sources_, 0);
    to->begin = from.begin;
    to->end = from.end;
    ForPoints(from, [&](int point, const auto& far, const auto& near) {
      f_ = grids_.Of(pairs_, point);
      for (const FarPair& pair : far) Add(pair, point);
      for (const NearPair& pair : near) Add(pair);
      Close(to);
    });
    to->value.push_back(0.0f);
    to->source.shrink_to_fit();
    to->value.shrink_to_fit();
  }

 private:
  void Add(const FarPair& pair, int point) {
    const Float4 v = pair.weight * Interpolate(pair, corners_, f_);
    if (pair.source >= pairs_.first_bright()) {
      const auto& power =
          pairs_.bright[pair.source - pairs_.first_bright()].power;
      for (int c = 0; c < 3; ++c) {
        op_.offset_[size_t{3} * point + c] += v[c] * power[c];
      }
      return;
    }
    const bool is_patch = pair.source >= pairs_.num_blocks;
    AddTo(pair.source + (is_patch ? pairs_.num_texels() : 0), v);
  }

  void Add(const NearPair& pair) {
    const Float4 v = pair.weight * Interpolate(pair, corners_, f_);
    float weight[4];
    BilinearWeights(pair, weight);
    const int* const texel = &pairs_.padded_texels[pair.texel];
    const int row = pairs_.padded_row();
    AddTo(pairs_.num_blocks + texel[0], weight[0] * v);
    AddTo(pairs_.num_blocks + texel[1], weight[1] * v);
    AddTo(pairs_.num_blocks + texel[row], weight[2] * v);
    AddTo(pairs_.num_blocks + texel[row + 1], weight[3] * v);
  }

  void AddTo(size_t source, Float4 value) {
    if (touched_[source] == 0) {
      touched_[source] = 1;
      order_.push_back(static_cast<uint32_t>(source));
    }
    Add4(&sums_[4 * source], value);
  }

  // Ends a point: its entries, in order of first touch, go to the chunk.
  void Close(Chunk* chunk) {
    for (const uint32_t source : order_) {
      float* const sum = &sums_[size_t{4} * source];
      chunk->source.push_back(source);
      chunk->value.insert(chunk->value.end(), sum, sum + 3);
      std::fill_n(sum, 4, 0.0f);
      touched_[source] = 0;
    }
    chunk->entry_end.push_back(chunk->source.size());
    order_.clear();
  }

  const TransportPairs& pairs_;
  const Corners corners_;
  const PaddedGrids& grids_;
  const float* f_ = nullptr;  // of the point's material
  LightOperator& op_;
  std::vector<float> sums_;  // [source][4]
  std::vector<uint8_t> touched_;
  std::vector<uint32_t> order_;
};

LightOperator::LightOperator(const TransportPairs& pairs, const PaddedGrids& f,
                             std::shared_ptr<const LightOperator> patches,
                             int bounces)
    : map_height_(pairs.map_height),
      map_width_(pairs.map_width),
      block_(pairs.block),
      num_blocks_(pairs.num_blocks),
      num_threads_(pairs.num_threads),
      chunks_(pairs.chunks.size()),
      num_sources_(num_map_sources() + pairs.num_patches),
      bounces_(bounces),
      patches_(std::move(patches)) {
  if (!pairs.bright.empty()) offset_.resize(size_t{3} * pairs.num_points, 0.0);
  std::vector<EntryBuilder> builders(
      num_threads_ > 0 ? num_threads_ : HardwareThreads(),
      EntryBuilder(pairs, f, this));
  ParallelFor(static_cast<int64_t>(chunks_.size()), num_threads_,
              [&](int64_t index, int worker) {
                builders[worker].Join(pairs.chunks[index], &chunks_[index]);
              });
  AddBouncesToOffset();
}

void LightOperator::AddBouncesToOffset() {
  if (offset_.empty() || patches_ == nullptr) return;
  std::vector<float> sources(4 * num_sources_, 0.0f);
  Bounce(true, &sources);
  std::vector<double> bounced(offset_.size());
  ApplyTo(sources, bounced.data());
  for (size_t k = 0; k < offset_.size(); ++k) offset_[k] += bounced[k];
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
                  const Double4 sum =
                      SumOf(chunk.value.data(), chunk.source.data(),
                            sources.data(), entry, chunk.entry_end[i]);
                  entry = chunk.entry_end[i];
                  for (int c = 0; c < 3; ++c) {
                    L_o[3 * static_cast<size_t>(chunk.begin + i) + c] = sum[c];
                  }
                }
              });
}

void LightOperator::Bounce(bool with_offset,
                           std::vector<float>* sources) const {
  if (patches_ == nullptr) return;
  std::vector<double> emitted(size_t{3} * patches_->num_points());
  for (int b = 0; b < bounces_; ++b) {
    patches_->ApplyTo(*sources, emitted.data());
    for (size_t k = 0; k < emitted.size(); ++k) {
      if (with_offset) emitted[k] += patches_->offset_[k];
      (*sources)[4 * (num_map_sources() + k / 3) + k % 3] =
          static_cast<float>(emitted[k]);
    }
  }
}

void LightOperator::ApplyLinear(const float* map, double* L_o) const {
  std::vector<float> sources = Sources(map);
  Bounce(false, &sources);
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
  // The adjoint of R_b, b falling: what is left for R_0 = 0 is dropped.
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

bool LightOperator::Row(int point, float* row) const {
  const auto chunk =
      std::find_if(chunks_.begin(), chunks_.end(),
                   [point](const Chunk& c) { return point < c.end; });
  const int i = point - chunk->begin;
  std::fill_n(row, size_t{3} * map_height_ * map_width_, 0.0f);
  for (size_t entry = i == 0 ? 0 : chunk->entry_end[i - 1];
       entry < chunk->entry_end[i]; ++entry) {
    AddEntry(chunk->source[entry], &chunk->value[3 * entry], row);
  }
  return true;
}

void LightOperator::AddEntry(size_t source, const float* value,
                             float* row) const {
  if (source >= num_map_sources()) return;  // a patch
  const auto blocks = static_cast<size_t>(num_blocks_);
  if (source >= blocks) {
    for (int c = 0; c < 3; ++c) row[3 * (source - blocks) + c] += value[c];
    return;
  }
  const int columns = map_width_ / block_;
  const int top = static_cast<int>(source) / columns * block_;
  const int left = static_cast<int>(source) % columns * block_;
  for (int y = top; y < top + block_; ++y) {
    const auto solid_angle =
        static_cast<float>(TexelSolidAngle(y, map_height_, map_width_));
    float* const texels =
        row + 3 * (static_cast<size_t>(y) * map_width_ + left);
    for (int k = 0; k < 3 * block_; ++k) {
      texels[k] += solid_angle * value[k % 3];
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
