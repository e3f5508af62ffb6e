#include "ibrdf/transport/transport.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/transport/gathered_light.h"
#include "ibrdf/transport/lobe_contraction.h"
#include "ibrdf/transport/transport_pairs.h"

namespace ibrdf {

using namespace taps;  // NOLINT

MaterialGrids ByMaterial(const std::vector<BrdfGrid>& grids) {
  MaterialGrids out;
  for (const BrdfGrid& grid : grids) out.push_back(&grid);
  return out;
}

Transport::Transport(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const TransportOptions& options)
    : Transport(options,
                std::make_shared<const TransportPairs>(
                    points, map_height, map_width, options, PairsOf::kPoints)) {
  if (options.patches == nullptr || options.patches->count() == 0) {
    options_.patches = nullptr;
    return;
  }
  TransportOptions own = options;
  own.visibility = options.patches->visibility();
  patches_ = std::shared_ptr<const Transport>(new Transport(
      own, std::make_shared<const TransportPairs>(options.patches->points(),
                                                  map_height, map_width, own,
                                                  PairsOf::kPatches)));
}

Transport::Transport(const TransportOptions& options,
                     std::shared_ptr<const TransportPairs> pairs)
    : options_(options), pairs_(std::move(pairs)) {}

int Transport::num_points() const { return pairs_->num_points; }
int Transport::map_height() const { return pairs_->map_height; }
int Transport::map_width() const { return pairs_->map_width; }

size_t Transport::MemoryBytes() const {
  return pairs_->MemoryBytes() +
         (patches_ != nullptr ? patches_->MemoryBytes() : 0);
}

std::vector<float> Transport::PadGrid(const BrdfGrid& grid) const {
  CHECK(grid.shape == options_.grid);
  const float* const channels[] = {grid.Channel(0), grid.Channel(1),
                                   grid.Channel(2)};
  return PadFields(grid.shape, channels, 3, 4, options_.num_threads);
}

PaddedGrids Transport::PadGrids(const MaterialGrids& grids) const {
  CHECK(!grids.empty());
  PaddedGrids padded;
  for (const BrdfGrid* grid : grids) {
    padded.by_material.push_back(PadGrid(*grid));
  }
  return padded;
}

void Transport::RenderLit(const PaddedGrids& f, const PairSources& sources,
                          double* L_o) const {
  const Corners corners(options_.grid);
  ParallelFor(
      static_cast<int64_t>(pairs_->chunks.size()), options_.num_threads,
      [&](int64_t index, int) {
        ForPoints(pairs_->chunks[index], [&](int point, const auto& far,
                                             const auto& near) {
          const float* const grid = f.Of(*pairs_, point);
          Double4 sum = {};
          for (const FarPair& pair : far) {
            sum += Widen(pair.weight * Interpolate(pair, corners, grid) *
                         sources.Light(pair));
          }
          for (const NearPair& pair : near) {
            sum += Widen(pair.weight * Interpolate(pair, corners, grid) *
                         sources.Light(pair));
          }
          for (int c = 0; c < 3; ++c) L_o[size_t{3} * point + c] = sum[c];
        });
      });
}

std::vector<std::vector<double>> Transport::Emitted(
    const PaddedGrids& f, int bounces, PairSources* sources) const {
  CHECK(bounces >= 0 && bounces <= this->bounces());
  std::vector<std::vector<double>> emitted(1);
  for (int b = 0; b < bounces; ++b) {
    if (b > 0) sources->SetEmitted(emitted.back().data());
    std::vector<double> next(size_t{3} * patches_->num_points());
    patches_->RenderLit(f, *sources, next.data());
    emitted.push_back(std::move(next));
  }
  return emitted;
}

std::vector<std::vector<double>> Transport::Emitted(const BrdfGrid& grid,
                                                    const float* map) const {
  PairSources sources(*pairs_, map);
  return Emitted(PadGrids({&grid}), bounces(), &sources);
}

void Transport::Render(const BrdfGrid& grid, const float* map,
                       double* L_o) const {
  Render(MaterialGrids{&grid}, map, L_o);
}

void Transport::Render(const MaterialGrids& grids, const float* map,
                       double* L_o) const {
  RenderBounces(grids, map, bounces(), L_o);
}

void Transport::RenderBounces(const BrdfGrid& grid, const float* map,
                              int bounces, double* L_o) const {
  RenderBounces(MaterialGrids{&grid}, map, bounces, L_o);
}

void Transport::RenderBounces(const MaterialGrids& grids, const float* map,
                              int bounces, double* L_o) const {
  const PaddedGrids f = PadGrids(grids);
  PairSources sources(*pairs_, map);
  const std::vector<double> emitted = Emitted(f, bounces, &sources).back();
  if (!emitted.empty()) sources.SetEmitted(emitted.data());
  RenderLit(f, sources, L_o);
}

void Transport::AddGridGradient(const PairSources& sources,
                                const double* adjoint,
                                std::vector<double>* sums) const {
  const BrdfGridShape& s = options_.grid;
  const Corners corners(s);
  std::vector<std::vector<float>> partial(pairs_->chunks.size());
  ParallelFor(static_cast<int64_t>(partial.size()), options_.num_threads,
              [&](int64_t index, int) {
                std::vector<float>& g = partial[index];
                g.assign(size_t{4} * pairs_->num_padded_nodes(), 0.0f);
                const auto scatter = [&](const auto& pair, Float4 light) {
                  float weight[8];
                  TrilinearWeights(pair, weight);
                  float* base = &g[size_t{4} * pair.node];
                  for (int k = 0; k < 8; ++k) {
                    Add4(base + 4 * corners.offset[k], weight[k] * light);
                  }
                };
                ForPoints(pairs_->chunks[index], [&](int point, const auto& far,
                                                     const auto& near) {
                  const double* const a = adjoint + size_t{3} * point;
                  const Float4 a4 = {static_cast<float>(a[0]),
                                     static_cast<float>(a[1]),
                                     static_cast<float>(a[2]), 0.0f};
                  for (const FarPair& pair : far) {
                    scatter(pair, a4 * pair.weight * sources.Light(pair));
                  }
                  for (const NearPair& pair : near) {
                    scatter(pair, a4 * pair.weight * sources.Light(pair));
                  }
                });
              });
  for (const std::vector<float>& g : partial) {
    for (int hd = 0; hd < s.h * s.d; ++hd) {
      for (int p = 0; p <= s.p; ++p) {
        const int node = hd * s.p + p % s.p;
        for (int c = 0; c < 3; ++c) {
          (*sums)[static_cast<size_t>(c) * s.num_nodes() + node] +=
              g[4 * (static_cast<size_t>(hd) * (s.p + 1) + p) + c];
        }
      }
    }
  }
}

std::vector<double> Transport::ByEmitted(const std::vector<float>& f,
                                         const double* adjoint) const {
  const Corners corners(options_.grid);
  const size_t num_patches = pairs_->num_patches;
  std::vector<std::vector<double>> partial(pairs_->chunks.size());
  ParallelFor(static_cast<int64_t>(partial.size()), options_.num_threads,
              [&](int64_t index, int) {
                std::vector<double>& g = partial[index];
                g.assign(4 * num_patches, 0.0);
                ForPoints(pairs_->chunks[index], [&](int point, const auto& far,
                                                     const auto&) {
                  const double* const a = adjoint + size_t{3} * point;
                  for (const FarPair& pair : far) {
                    if (pair.source < pairs_->num_blocks ||
                        pair.source >= pairs_->first_bright()) {
                      continue;
                    }
                    const Float4 v =
                        pair.weight * Interpolate(pair, corners, f.data());
                    double* const to =
                        &g[size_t{4} * (pair.source - pairs_->num_blocks)];
                    for (int c = 0; c < 3; ++c) to[c] += v[c] * a[c];
                  }
                });
              });
  std::vector<double> by_emitted(3 * num_patches, 0.0);
  for (const std::vector<double>& g : partial) {
    for (size_t j = 0; j < num_patches; ++j) {
      for (size_t c = 0; c < 3; ++c) by_emitted[3 * j + c] += g[4 * j + c];
    }
  }
  return by_emitted;
}

void Transport::GridGradient(const BrdfGrid& grid, const float* map,
                             const double* adjoint, float* gradient) const {
  std::vector<double> sums(size_t{3} * options_.grid.num_nodes(), 0.0);
  PairSources sources(*pairs_, map);
  if (bounces() == 0) {
    AddGridGradient(sources, adjoint, &sums);
  } else {
    const PaddedGrids grids = PadGrids({&grid});
    const std::vector<float>& f = grids.by_material.front();
    const std::vector<std::vector<double>> emitted =
        Emitted(grids, bounces(), &sources);
    sources.SetEmitted(emitted.back().data());
    AddGridGradient(sources, adjoint, &sums);
    // The adjoint of R_b, b falling.
    std::vector<double> by_emitted = ByEmitted(f, adjoint);
    for (int b = bounces(); b > 0; --b) {
      sources.SetEmitted(b > 1 ? emitted[b - 1].data() : nullptr);
      patches_->AddGridGradient(sources, by_emitted.data(), &sums);
      if (b > 1) by_emitted = patches_->ByEmitted(f, by_emitted.data());
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    gradient[i] = static_cast<float>(sums[i]);
  }
}

LightOperator Transport::ByLight(const BrdfGrid& grid) const {
  return ByLight(MaterialGrids{&grid});
}

LightOperator Transport::ByLight(const MaterialGrids& grids) const {
  std::shared_ptr<const LightOperator> patches;
  if (patches_ != nullptr) {
    patches = std::make_shared<const LightOperator>(patches_->ByLight(grids));
  }
  return LightOperator(*pairs_, PadGrids(grids), patches,
                       patches != nullptr ? bounces() : 0);
}

ReflectanceOperator Transport::ByReflectance(const float* map) const {
  return ReflectanceOperator(*pairs_, PairSources(*pairs_, map));
}

void Transport::RenderLobes(const float* const* fields, int num_fields,
                            const float* map, float* out,
                            const double* emitted) const {
  if (num_fields <= 0) return;
  const int num_threads = options_.num_threads;
  const int stride = LobeStride(num_fields);
  const std::vector<float> by_node =
      PadFields(options_.grid, fields, num_fields, stride, num_threads);
  PairSources sources(*pairs_, map);
  sources.SetEmitted(emitted);
  const ContractLobesFunction contract = ContractLobes();
  std::vector<LightGatherer> gatherers(num_threads > 0 ? num_threads
                                                       : HardwareThreads());
  ParallelFor(
      static_cast<int64_t>(pairs_->chunks.size()), num_threads,
      [&](int64_t index, int worker) {
        std::vector<float> sums(size_t{3} * stride);
        gatherers[worker].Gather(
            *pairs_, sources, pairs_->chunks[index],
            [&](int point, const std::vector<uint32_t>& nodes,
                const std::vector<float>& light) {
              contract(nodes.data(), static_cast<int>(nodes.size()),
                       light.data(), by_node.data(), stride, sums.data());
              std::copy_n(sums.data(), 3 * num_fields,
                          out + static_cast<size_t>(point) * 3 * num_fields);
            });
      });
}

}  // namespace ibrdf
