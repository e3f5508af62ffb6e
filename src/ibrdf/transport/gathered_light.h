// The light that a point gathers at the nodes of the BRDF grid: what lobes are
// multiplied with. Internal.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "ibrdf/transport/transport_pairs.h"

namespace ibrdf {

// One per worker: its sums are all zero between points.
class LightGatherer {
 public:
  // Calls use(point, nodes, light) for every point of a chunk in order: nodes
  // [count] of the padded grid, in order of first touch, and the light [count,
  // 4] that they reflect per unit of BRDF.
  template <typename Use>
  void Gather(const TransportPairs& pairs, const PairSources& sources,
              const PairChunk& chunk, const Use& use) {
    const taps::Corners corners(pairs.grid);
    by_node_.resize(size_t{4} * pairs.num_padded_nodes(), 0.0f);
    touched_.resize(pairs.num_padded_nodes(), 0);
    ForPoints(chunk, [&](int point, const auto& far, const auto& near) {
      nodes_.clear();
      for (const FarPair& pair : far) {
        Scatter(pair, corners, pair.weight * sources.Light(pair));
      }
      for (const NearPair& pair : near) {
        Scatter(pair, corners, pair.weight * sources.Light(pair));
      }
      TakeLight();
      use(point, nodes_, light_);
    });
  }

 private:
  template <typename Pair>
  void Scatter(const Pair& pair, const taps::Corners& corners,
               taps::Float4 light) {
    float weight[8];
    taps::TrilinearWeights(pair, weight);
    for (int k = 0; k < 8; ++k) {
      const uint32_t node = pair.node + corners.offset[k];
      if (touched_[node] == 0) {
        touched_[node] = 1;
        nodes_.push_back(node);
      }
      taps::Add4(&by_node_[size_t{4} * node], weight[k] * light);
    }
  }

  // Moves the sums of the nodes to light_ and leaves zeros.
  void TakeLight() {
    light_.resize(4 * nodes_.size());
    for (size_t k = 0; k < nodes_.size(); ++k) {
      float* const at = &by_node_[size_t{4} * nodes_[k]];
      std::copy_n(at, 4, &light_[4 * k]);
      std::fill_n(at, 4, 0.0f);
      touched_[nodes_[k]] = 0;
    }
  }

  std::vector<float> by_node_;  // [padded node][4]
  std::vector<uint8_t> touched_;
  std::vector<uint32_t> nodes_;
  std::vector<float> light_;
};

}  // namespace ibrdf
