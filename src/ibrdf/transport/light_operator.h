// Transport with the BRDF multiplied out: radiance as a function of the map.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/transport/linear_transport.h"

namespace ibrdf {

class Transport;
struct PaddedGrids;
struct TransportPairs;

// For one point, all pairs with the same block of texels, or with the same
// texel, become one entry. With interreflection, patches have an operator of
// their own, and a product runs through all bounces. The offset is the light of
// TransportOptions::bright, bounces included.
//
// Made by Transport::ByLight; it holds what it needs and may outlive its
// transport. Other rules as LinearTransport.
class LightOperator final : public LinearTransport {
 public:
  int num_points() const override {
    return chunks_.empty() ? 0 : chunks_.back().end;
  }
  void ApplyLinear(const float* map, double* L_o) const override;
  void ApplyTranspose(const double* adjoint, float* gradient) const override;

  bool Row(int point, float* row) const override;

  // The operator of the patches without bounces; null without interreflection.
  const LightOperator* patches() const { return patches_.get(); }
  // out [points, 3, columns] += the radiance that emitted light, [patches, 3,
  // columns], adds: for tangents of the patches' radiance.
  void AddEmitted(const double* emitted, int columns, double* out) const;

  size_t MemoryBytes() const;

 private:
  friend class Transport;
  LightOperator(const TransportPairs& pairs, const PaddedGrids& f,
                std::shared_ptr<const LightOperator> patches, int bounces);

  // The entries of consecutive points.
  struct Chunk {
    int begin = 0, end = 0;
    std::vector<size_t> entry_end;  // [end - begin]
    // A block, num_blocks_ + texel, or after those a patch.
    std::vector<uint32_t> source;
    std::vector<float> value;  // [entry * 3 + channel], one spare entry
  };
  class EntryBuilder;

  size_t num_map_sources() const {
    return num_blocks_ + static_cast<size_t>(map_height_) * map_width_;
  }
  // Blocks, then texels, then patches (0); four floats each, the last one 0.
  std::vector<float> Sources(const float* map) const;
  // Lights the patches in `sources` by all bounces; of the offset's light, too,
  // where asked for.
  void Bounce(bool with_offset, std::vector<float>* sources) const;
  // Adds an entry's value [3] to the row of its point [H, W, 3].
  void AddEntry(size_t source, const float* value, float* row) const;
  // Adds what bounces bring of the bright light to the offset.
  void AddBouncesToOffset();
  void ApplyTo(const std::vector<float>& sources, double* L_o) const;
  // sums [num_sources_, 4] += the transpose.
  void AddTranspose(const double* adjoint, std::vector<double>* sums) const;

  int map_height_ = 0, map_width_ = 0, block_ = 1, num_blocks_ = 0;
  int num_threads_ = 0;
  std::vector<Chunk> chunks_;
  size_t num_sources_ = 0;
  int bounces_ = 0;
  std::shared_ptr<const LightOperator> patches_;  // null: none
};

}  // namespace ibrdf
