// Transport with the map multiplied in: radiance of lobes as a function of
// their fields on the BRDF grid.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

class PairSources;
class Transport;
struct TransportPairs;

// The light that each point gathers at every node of the grid, some 40 kB per
// point: for few points. It is linear in the reflectance, where LinearTransport
// is linear in the map.
//
// Made by Transport::ByReflectance; it holds what it needs and may outlive its
// transport. One thread at a time may call it.
class ReflectanceOperator {
 public:
  int num_points() const { return num_points_; }
  // out [points, num_fields, 3] from fields[k] = [nodes], as
  // Transport::RenderLobes, with the same bits.
  void Apply(const float* const* fields, int num_fields, float* out) const;

  size_t MemoryBytes() const;

 private:
  friend class Transport;
  ReflectanceOperator(const TransportPairs& pairs, const PairSources& sources);

  // Consecutive points: the nodes that each sees and their light.
  struct Chunk {
    int begin = 0, end = 0;
    std::vector<size_t> entry_end;  // [end - begin]
    std::vector<uint32_t> node;     // of the padded grid
    std::vector<float> light;       // [entry, 4]
  };

  BrdfGridShape grid_;
  int num_points_ = 0;
  int num_threads_ = 0;
  std::vector<Chunk> chunks_;
};

}  // namespace ibrdf
