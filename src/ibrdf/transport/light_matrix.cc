// Transport::LightMatrix: the transport as a dense matrix, for maps of few
// texels.
#include <glog/logging.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/transport.h"
#include "ibrdf/transport/transport_pairs.h"

namespace ibrdf {

using namespace taps;  // NOLINT

namespace {

constexpr size_t kFieldsAtOnce = 4;  // a vector of Float4

// What a pair of one point reads, as shares of the map's texels, which are the
// far rule's blocks. Light is a row of the matrix, or its adjoint.
class TexelTaps {
 public:
  explicit TexelTaps(const TransportPairs& pairs)
      : texel_(pairs.padded_texels), row_(pairs.padded_row()) {
    for (int r = 0; r < pairs.map_height; ++r) {
      solid_angle_.insert(solid_angle_.end(), pairs.map_width,
                          static_cast<float>(TexelSolidAngle(
                              r, pairs.map_height, pairs.map_width)));
    }
  }

  // light: [texel][4].
  void Add(const FarPair& pair, Float4 value, float* light) const {
    Add4(light + size_t{4} * pair.source, value * solid_angle_[pair.source]);
  }
  void Add(const NearPair& pair, Float4 value, float* light) const {
    float weight[4];
    BilinearWeights(pair, weight);
    const int* const to = &texel_[pair.texel];
    Add4(light + size_t{4} * to[0], weight[0] * value);
    Add4(light + size_t{4} * to[1], weight[1] * value);
    Add4(light + size_t{4} * to[row_], weight[2] * value);
    Add4(light + size_t{4} * to[row_ + 1], weight[3] * value);
  }

  float WeightedLight(const FarPair& pair, const float* light) const {
    return pair.weight * light[pair.source] * solid_angle_[pair.source];
  }
  float WeightedLight(const NearPair& pair, const float* light) const {
    float weight[4];
    BilinearWeights(pair, weight);
    const int* const from = &texel_[pair.texel];
    return pair.weight *
           (weight[0] * light[from[0]] + weight[1] * light[from[1]] +
            weight[2] * light[from[row_]] + weight[3] * light[from[row_ + 1]]);
  }

 private:
  const std::vector<int>& texel_;
  const int row_;
  std::vector<float> solid_angle_;  // [texel]
};

void CheckIsForMatrix(const TransportPairs& pairs,
                      const TransportOptions& options) {
  CHECK_EQ(pairs.block, 1) << "a dense matrix is for small maps";
  CHECK(options.patches == nullptr) << "a dense matrix has no bounces";
  CHECK(options.bright.empty()) << "a dense matrix has no bright light";
}

// Sums over the chunks, gradient [nodes] from sums over the padded grid.
void JoinNodes(const BrdfGridShape& s,
               const std::vector<std::vector<float>>& partial,
               float* gradient) {
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

}  // namespace

void Transport::LightMatrices(const std::vector<const float*>& fields,
                              const std::vector<float*>& matrices) const {
  CHECK_EQ(fields.size(), matrices.size());
  CheckIsForMatrix(*pairs_, options_);
  for (size_t begin = 0; begin < fields.size(); begin += kFieldsAtOnce) {
    const size_t count = std::min(kFieldsAtOnce, fields.size() - begin);
    FewLightMatrices(&fields[begin], &matrices[begin], count);
  }
}

// At most kFieldsAtOnce, a lane each.
void Transport::FewLightMatrices(const float* const* fields,
                                 float* const* matrices, size_t count) const {
  const std::vector<float> nodes =
      PadFields(options_.grid, fields, static_cast<int>(count), kFieldsAtOnce,
                options_.num_threads);
  const Corners corners(options_.grid);
  const TexelTaps texels(*pairs_);
  const size_t num_texels = pairs_->num_texels();
  const auto value = [&](const auto& pair) {
    return Interpolate(pair, corners, nodes.data()) * pair.weight;
  };
  ParallelFor(static_cast<int64_t>(pairs_->chunks.size()), options_.num_threads,
              [&](int64_t index, int) {
                std::vector<float> sums(kFieldsAtOnce * num_texels);
                ForPoints(pairs_->chunks[index], [&](int point, const auto& far,
                                                     const auto& near) {
                  std::fill(sums.begin(), sums.end(), 0.0f);
                  for (const FarPair& pair : far) {
                    texels.Add(pair, value(pair), sums.data());
                  }
                  for (const NearPair& pair : near) {
                    texels.Add(pair, value(pair), sums.data());
                  }
                  for (size_t k = 0; k < count; ++k) {
                    float* const out = matrices[k] + num_texels * point;
                    for (size_t t = 0; t < num_texels; ++t) {
                      out[t] = sums[kFieldsAtOnce * t + k];
                    }
                  }
                });
              });
}

void Transport::LightMatrixGradient(const float* adjoint,
                                    float* gradient) const {
  CheckIsForMatrix(*pairs_, options_);
  const Corners corners(options_.grid);
  const TexelTaps texels(*pairs_);
  std::vector<std::vector<float>> partial(pairs_->chunks.size());
  ParallelFor(static_cast<int64_t>(partial.size()), options_.num_threads,
              [&](int64_t index, int) {
                std::vector<float>& sums = partial[index];
                sums.assign(pairs_->num_padded_nodes(), 0.0f);
                const auto scatter = [&](const auto& pair, float light) {
                  float weight[8];
                  TrilinearWeights(pair, weight);
                  for (int k = 0; k < 8; ++k) {
                    sums[pair.node + corners.offset[k]] += weight[k] * light;
                  }
                };
                ForPoints(pairs_->chunks[index],
                          [&](int point, const auto& far, const auto& near) {
                            const float* const in =
                                adjoint + pairs_->num_texels() * point;
                            for (const FarPair& pair : far) {
                              scatter(pair, texels.WeightedLight(pair, in));
                            }
                            for (const NearPair& pair : near) {
                              scatter(pair, texels.WeightedLight(pair, in));
                            }
                          });
              });
  JoinNodes(options_.grid, partial, gradient);
}

}  // namespace ibrdf
