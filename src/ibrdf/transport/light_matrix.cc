// Dense forms of the transport, for maps of few texels.
#include <glog/logging.h>

#include <cstdint>
#include <vector>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"
#include "ibrdf/transport/transport.h"
#include "ibrdf/transport/transport_taps.h"

namespace ibrdf {

using namespace taps;  // NOLINT

namespace {

std::vector<float> SolidAngles(int height, int width) {
  std::vector<float> solid_angle;
  for (int r = 0; r < height; ++r) {
    solid_angle.insert(solid_angle.end(), width,
                       static_cast<float>(TexelSolidAngle(r, height, width)));
  }
  return solid_angle;
}

}  // namespace

void Transport::LightMatrix(const float* field, float* matrix) const {
  CHECK_EQ(block_, 1) << "a dense matrix is for small maps";
  CHECK(options_.patches == nullptr && options_.bright.empty());
  const BrdfGridShape& s = options_.grid;
  std::vector<float> nodes(PaddedNodes());
  for (int hd = 0; hd < s.h * s.d; ++hd) {
    for (int p = 0; p <= s.p; ++p) {
      nodes[static_cast<size_t>(hd) * (s.p + 1) + p] =
          field[hd * s.p + p % s.p];
    }
  }
  const Corners corners(s);
  const std::vector<int> texel = PaddedTexels(map_height_, map_width_);
  const std::vector<float> solid_angle = SolidAngles(map_height_, map_width_);
  const int row = map_width_ + 1;
  const size_t texels = static_cast<size_t>(map_height_) * map_width_;
  const auto value = [&](const auto& pair) {
    float weight[8], sum = 0.0f;
    TrilinearWeights(pair, weight);
    for (int k = 0; k < 8; ++k) {
      sum += weight[k] * nodes[pair.node + corners.offset[k]];
    }
    return sum * pair.weight;
  };
  ParallelFor(static_cast<int64_t>(chunks_.size()), options_.num_threads,
              [&](int64_t index, int) {
                const Chunk& chunk = chunks_[index];
                size_t far = 0, near = 0;
                for (int i = 0; i < chunk.end - chunk.begin; ++i) {
                  float* const out = matrix + texels * (chunk.begin + i);
                  std::fill(out, out + texels, 0.0f);
                  for (; far < chunk.far_end[i]; ++far) {
                    const FarPair& pair = chunk.far[far];
                    out[pair.block] += value(pair) * solid_angle[pair.block];
                  }
                  for (; near < chunk.near_end[i]; ++near) {
                    const NearPair& pair = chunk.near[near];
                    const float v = value(pair);
                    float weight[4];
                    BilinearWeights(pair, weight);
                    const int* const to = &texel[pair.texel];
                    out[to[0]] += weight[0] * v;
                    out[to[1]] += weight[1] * v;
                    out[to[row]] += weight[2] * v;
                    out[to[row + 1]] += weight[3] * v;
                  }
                }
              });
}

void Transport::LightMatrixGradient(const float* adjoint,
                                    float* gradient) const {
  CHECK_EQ(block_, 1) << "a dense matrix is for small maps";
  CHECK(options_.patches == nullptr && options_.bright.empty());
  const BrdfGridShape& s = options_.grid;
  const Corners corners(s);
  const std::vector<int> texel = PaddedTexels(map_height_, map_width_);
  const std::vector<float> solid_angle = SolidAngles(map_height_, map_width_);
  const int row = map_width_ + 1;
  const size_t texels = static_cast<size_t>(map_height_) * map_width_;
  std::vector<std::vector<float>> partial(chunks_.size());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int) {
        const Chunk& chunk = chunks_[index];
        std::vector<float>& sums = partial[index];
        sums.assign(PaddedNodes(), 0.0f);
        const auto scatter = [&](const auto& pair, float light) {
          float weight[8];
          TrilinearWeights(pair, weight);
          for (int k = 0; k < 8; ++k) {
            sums[pair.node + corners.offset[k]] += weight[k] * light;
          }
        };
        size_t far = 0, near = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          const float* const in = adjoint + texels * (chunk.begin + i);
          for (; far < chunk.far_end[i]; ++far) {
            const FarPair& pair = chunk.far[far];
            scatter(pair,
                    pair.weight * in[pair.block] * solid_angle[pair.block]);
          }
          for (; near < chunk.near_end[i]; ++near) {
            const NearPair& pair = chunk.near[near];
            float weight[4];
            BilinearWeights(pair, weight);
            const int* const from = &texel[pair.texel];
            scatter(pair, pair.weight * (weight[0] * in[from[0]] +
                                         weight[1] * in[from[1]] +
                                         weight[2] * in[from[row]] +
                                         weight[3] * in[from[row + 1]]));
          }
        }
      });
  for (int hd = 0; hd < s.h * s.d; ++hd) {
    for (int p = 0; p < s.p; ++p) {
      double sum = 0.0;
      for (const std::vector<float>& sums : partial) {
        const size_t first = static_cast<size_t>(hd) * (s.p + 1);
        sum += sums[first + p];
        // The plane at p = n is the one at 0, half a turn on.
        if (p == 0) sum += sums[first + s.p];
      }
      gradient[hd * s.p + p] = static_cast<float>(sum);
    }
  }
}

}  // namespace ibrdf
