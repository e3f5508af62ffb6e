#include "ibrdf/transport/transport.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"
#include "ibrdf/transport/transport_taps.h"

namespace ibrdf {

using namespace taps;  // NOLINT

namespace {

// Points are joined in this many sums, whatever the number of threads.
constexpr int kMaxChunks = 32;

uint16_t Quantise(double fraction) {
  return static_cast<uint16_t>(std::clamp(fraction, 0.0, 1.0) * 65535.0 + 0.5);
}

// Where a sample's angles lie in the grid, and its weight.
template <typename Sample, typename Pair>
void SetCell(const BrdfGridShape& shape, const Sample& sample, Pair* pair) {
  const BrdfGridCell cell =
      FindCell(shape, ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d));
  pair->node = static_cast<uint32_t>(
      (cell.h * shape.d + cell.d) * (shape.p + 1) + cell.p);
  pair->fh = Quantise(cell.fh);
  pair->fd = Quantise(cell.fd);
  pair->fp = Quantise(cell.fp);
  pair->weight = static_cast<float>(sample.weight);
}

constexpr double kSpare = 1.1;

// Room for so many times what is there: lists that grow by doubling are copied,
// and touch new pages, twice over.
template <typename Pair>
void ReserveFor(double times, std::vector<Pair>* pairs) {
  const double expected = times * static_cast<double>(pairs->size());
  if (expected > static_cast<double>(pairs->capacity())) {
    pairs->reserve(static_cast<size_t>(kSpare * expected));
  }
}

template <typename Pair>
void GiveBackSpare(std::vector<Pair>* pairs) {
  const auto size = static_cast<double>(pairs->size());
  if (static_cast<double>(pairs->capacity()) > kSpare * kSpare * size) {
    pairs->shrink_to_fit();
  }
}

}  // namespace

Transport::Transport(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const TransportOptions& options)
    : Transport(points, map_height, map_width, options, Of::kPoints) {
  if (options.patches == nullptr || options.patches->count() == 0) {
    options_.patches = nullptr;
    return;
  }
  TransportOptions own = options;
  own.visibility = options.patches->visibility();
  patches_ = std::shared_ptr<const Transport>(new Transport(
      options.patches->points(), map_height, map_width, own, Of::kPatches));
}

Transport::Transport(const std::vector<ShadingPoint>& points, int map_height,
                     int map_width, const TransportOptions& options, Of of)
    : options_(options),
      num_points_(static_cast<int>(points.size())),
      map_height_(map_height),
      map_width_(map_width),
      block_(
          FarBlockSize(map_height, map_width, options.quadrature.far_width)) {
  CHECK(map_height > 0 && map_width > 1 && map_width % 2 == 0);
  CHECK(options.grid.h >= 2 && options.grid.d >= 2 && options.grid.p >= 1);
  num_blocks_ = (map_height / block_) * (map_width / block_);
  CHECK(options.patches == nullptr || options.visibility != nullptr);
  CHECK_LE(num_blocks_ + num_patches() + options.bright.size(),
           size_t{kMaxFarSources})
      << "map of odd size: resize it first";
  const std::vector<FarCell> cells = MapCells(map_height, map_width, block_);
  const PointQuadrature quadrature(cells, options.quadrature);
  const int num_chunks = std::min(kMaxChunks, num_points_);
  chunks_.resize(num_chunks);
  ParallelFor(num_chunks, options_.num_threads, [&](int64_t i, int) {
    Chunk& chunk = chunks_[i];
    chunk.begin = static_cast<int>(i * num_points_ / num_chunks);
    chunk.end = static_cast<int>((i + 1) * num_points_ / num_chunks);
    BuildChunk(points, cells, quadrature, of, &chunk);
  });
}

void Transport::BuildChunk(const std::vector<ShadingPoint>& points,
                           const std::vector<FarCell>& cells,
                           const PointQuadrature& quadrature, Of of,
                           Chunk* chunk) const {
  const Visibility* const visibility = options_.visibility.get();
  const RadiosityPatches* const patches = options_.patches.get();
  const int columns = map_width_ / block_;
  PointSamples samples;
  std::vector<PatchShare> shares;
  const auto add_patch = [&](const auto& sample, int patch, double weight) {
    FarPair pair{};
    SetCell(options_.grid, sample, &pair);
    pair.block = static_cast<uint16_t>(num_blocks_ + patch);
    pair.weight = static_cast<float>(weight);
    chunk->far.push_back(pair);
  };
  for (int i = chunk->begin; i < chunk->end; ++i) {
    const Eigen::Vector3d n = points[i].normal.cast<double>().normalized();
    const uint64_t* const hidden =
        visibility != nullptr ? visibility->Hidden(points[i]) : nullptr;
    SeenPatches seen;
    if (hidden != nullptr && patches != nullptr) {
      seen = of == Of::kPoints ? patches->SeenFrom(points[i])
                               : patches->SeenFromPatch(points[i]);
    }
    quadrature.Sample(n, points[i].wo.cast<double>().normalized(), &samples);
    for (FarSample& s : samples.far) {
      if (hidden != nullptr) {
        const VisibilityGrid& grid = visibility->grid();
        const GridRange range = grid.RangeOf(s.cell / columns, s.cell % columns,
                                             map_height_ / block_, columns);
        const double share = grid.VisibleShare(hidden, n, range);
        if (share < 1.0 && !seen.empty()) {
          patches->SharesIn(grid, hidden, n, range, seen, &shares);
          for (const PatchShare& e : shares) {
            add_patch(s, e.patch,
                      s.weight * cells[s.cell].solid_angle * e.share);
          }
        }
        if (share <= 0.0) continue;
        if (share < 1.0 && block_ > 1) {
          NearPair sample{};
          SetCell(options_.grid, s, &sample);
          SplitBlock(hidden, n, s.cell, sample, &chunk->near);
          continue;
        }
        s.weight *= share;
      }
      FarPair pair{};
      SetCell(options_.grid, s, &pair);
      pair.block = static_cast<uint16_t>(s.cell);
      chunk->far.push_back(pair);
    }
    for (NearSample& s : samples.near) {
      if (hidden != nullptr) {
        const double visible = visibility->grid().VisibleAlong(hidden, n, s.wi);
        if (visible < 1.0 && !seen.empty()) {
          const int patch = patches->Along(seen, s.wi);
          if (patch >= 0) {
            add_patch(s, patch, s.weight * (1.0 - visible));
          }
        }
        s.weight *= visible;
        if (s.weight <= 0.0) continue;
      }
      NearPair pair{};
      SetCell(options_.grid, s, &pair);
      double row = 0.0, column = 0.0;
      FastMapPosition(s.wi, map_height_, map_width_, &row, &column);
      const double y0 = std::floor(row - 0.5), x0 = std::floor(column - 0.5);
      const int x = (static_cast<int>(x0) + map_width_) % map_width_;
      pair.texel = static_cast<uint32_t>(
          (static_cast<int>(y0) + 1) * (map_width_ + 1) + x);
      pair.fy = Quantise(row - 0.5 - y0);
      pair.fx = Quantise(column - 0.5 - x0);
      chunk->near.push_back(pair);
    }
    AddBright(points[i], hidden, chunk);
    const double of_done =
        1.0 * (chunk->end - chunk->begin) / (i + 1 - chunk->begin);
    ReserveFor(of_done, &chunk->far);
    ReserveFor(of_done, &chunk->near);
    chunk->far_end.push_back(chunk->far.size());
    chunk->near_end.push_back(chunk->near.size());
  }
  GiveBackSpare(&chunk->far);
  GiveBackSpare(&chunk->near);
}

void Transport::AddBright(const ShadingPoint& point, const uint64_t* hidden,
                          Chunk* chunk) const {
  if (options_.bright.empty()) return;
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  const int first = num_blocks_ + num_patches();
  for (size_t k = 0; k < options_.bright.size(); ++k) {
    const Eigen::Vector3d& wi = options_.bright[k].direction;
    FarSample sample{};
    sample.weight = wi.dot(n);
    if (sample.weight > 0.0 && hidden != nullptr) {
      sample.weight *= options_.visibility->grid().VisibleAlong(hidden, n, wi);
    }
    if (sample.weight <= 0.0) continue;
    const Eigen::Vector3d h = (wi + wo).normalized();
    const double cos_h = std::max(n.dot(h), 0.0), cos_d = wi.dot(h);
    const Eigen::Vector3d across = n.cross(h);
    sample.theta_h = FastAtan2(across.norm(), cos_h);
    sample.theta_d = FastAtan2(wi.cross(h).norm(), cos_d);
    // As PointQuadrature has it; at theta_h = 0, where no direction is meant,
    // an isotropic reflectance does not depend on it.
    sample.phi_d =
        FoldPhi(FastAtan2(across.dot(wi), cos_h * cos_d - n.dot(wi)));
    FarPair pair{};
    SetCell(options_.grid, sample, &pair);
    pair.block = static_cast<uint16_t>(first + k);
    chunk->far.push_back(pair);
  }
}

void Transport::SplitBlock(const uint64_t* hidden, const Eigen::Vector3d& n,
                           int block, const NearPair& sample,
                           std::vector<NearPair>* pairs) const {
  const VisibilityGrid& grid = options_.visibility->grid();
  const int columns = map_width_ / block_;
  for (int k = 0; k < block_ * block_; ++k) {
    const int y = block / columns * block_ + k / block_;
    const int x = block % columns * block_ + k % block_;
    const double share = grid.VisibleShare(
        hidden, n, grid.RangeOf(y, x, map_height_, map_width_));
    if (share <= 0.0) continue;
    NearPair pair = sample;
    pair.texel = static_cast<uint32_t>((y + 1) * (map_width_ + 1) + x);
    pair.weight *=
        static_cast<float>(share * TexelSolidAngle(y, map_height_, map_width_));
    pairs->push_back(pair);
  }
}

size_t Transport::MemoryBytes() const {
  size_t bytes = 0;
  for (const Chunk& chunk : chunks_) {
    bytes +=
        chunk.far.capacity() * sizeof(FarPair) +
        chunk.near.capacity() * sizeof(NearPair) +
        (chunk.far_end.capacity() + chunk.near_end.capacity()) * sizeof(size_t);
  }
  if (patches_ != nullptr) bytes += patches_->MemoryBytes();
  return bytes;
}

std::vector<float> Transport::PadMap(const float* map) const {
  const std::vector<int> texel = PaddedTexels(map_height_, map_width_);
  std::vector<float> out(4 * texel.size(), 0.0f);
  for (size_t i = 0; i < texel.size(); ++i) {
    std::copy_n(map + size_t{3} * texel[i], 3, &out[4 * i]);
  }
  return out;
}

std::vector<float> Transport::PadGrid(const BrdfGrid& grid) const {
  const BrdfGridShape& s = options_.grid;
  CHECK(grid.shape == s);
  std::vector<float> out(size_t{4} * PaddedNodes(), 0.0f);
  for (int hd = 0; hd < s.h * s.d; ++hd) {
    for (int p = 0; p <= s.p; ++p) {
      for (int c = 0; c < 3; ++c) {
        out[4 * (static_cast<size_t>(hd) * (s.p + 1) + p) + c] =
            grid.Channel(c)[hd * s.p + p % s.p];
      }
    }
  }
  return out;
}

std::vector<float> Transport::FarSources(const float* map,
                                         const double* emitted) const {
  std::vector<float> sources = SumBlocks(map, map_height_, map_width_, block_);
  const size_t first = sources.size();
  const auto count = static_cast<size_t>(num_patches());
  sources.resize(first + 4 * (count + options_.bright.size()), 0.0f);
  for (size_t k = 0; k < options_.bright.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      sources[first + 4 * (count + k) + c] =
          static_cast<float>(options_.bright[k].power[c]);
    }
  }
  if (emitted == nullptr) return sources;
  for (size_t j = 0; j < count; ++j) {
    for (size_t c = 0; c < 3; ++c) {
      sources[first + 4 * j + c] = static_cast<float>(emitted[3 * j + c]);
    }
  }
  return sources;
}

void Transport::RenderLit(const std::vector<float>& f, const float* map,
                          const double* emitted, double* L_o) const {
  const std::vector<float> texels = PadMap(map),
                           blocks = FarSources(map, emitted);
  const Corners corners(options_.grid);
  const int row = map_width_ + 1;
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int) {
        const Chunk& chunk = chunks_[index];
        size_t far = 0, near = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          Double4 sum = {};
          for (; far < chunk.far_end[i]; ++far) {
            const FarPair& pair = chunk.far[far];
            sum += Widen(pair.weight * Interpolate(pair, corners, f.data()) *
                         Load4(&blocks[size_t{4} * pair.block]));
          }
          for (; near < chunk.near_end[i]; ++near) {
            const NearPair& pair = chunk.near[near];
            sum += Widen(pair.weight * Interpolate(pair, corners, f.data()) *
                         LookUp(pair, row, texels.data()));
          }
          for (int c = 0; c < 3; ++c) {
            L_o[3 * static_cast<size_t>(chunk.begin + i) + c] = sum[c];
          }
        }
      });
}

std::vector<std::vector<double>> Transport::Emitted(const std::vector<float>& f,
                                                    const float* map,
                                                    int bounces) const {
  CHECK(bounces >= 0 && bounces <= this->bounces());
  std::vector<std::vector<double>> emitted(1);
  for (int b = 0; b < bounces; ++b) {
    std::vector<double> next(size_t{3} * patches_->num_points());
    const double* const last = b > 0 ? emitted.back().data() : nullptr;
    patches_->RenderLit(f, map, last, next.data());
    emitted.push_back(std::move(next));
  }
  return emitted;
}

std::vector<std::vector<double>> Transport::Emitted(const BrdfGrid& grid,
                                                    const float* map) const {
  return Emitted(PadGrid(grid), map, bounces());
}

void Transport::Render(const BrdfGrid& grid, const float* map,
                       double* L_o) const {
  RenderBounces(grid, map, bounces(), L_o);
}

void Transport::RenderBounces(const BrdfGrid& grid, const float* map,
                              int bounces, double* L_o) const {
  const std::vector<float> f = PadGrid(grid);
  const std::vector<double> emitted = Emitted(f, map, bounces).back();
  RenderLit(f, map, emitted.empty() ? nullptr : emitted.data(), L_o);
}

void Transport::AddGridGradient(const float* map, const double* emitted,
                                const double* adjoint,
                                std::vector<double>* sums) const {
  const BrdfGridShape& s = options_.grid;
  const std::vector<float> texels = PadMap(map),
                           blocks = FarSources(map, emitted);
  const Corners corners(s);
  const int row = map_width_ + 1;
  std::vector<std::vector<float>> partial(chunks_.size());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int) {
        const Chunk& chunk = chunks_[index];
        std::vector<float>& g = partial[index];
        g.assign(size_t{4} * PaddedNodes(), 0.0f);
        const auto scatter = [&](const auto& pair, Float4 light) {
          float weight[8];
          TrilinearWeights(pair, weight);
          float* base = &g[size_t{4} * pair.node];
          for (int k = 0; k < 8; ++k) {
            Add4(base + 4 * corners.offset[k], weight[k] * light);
          }
        };
        size_t far = 0, near = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          const double* a = adjoint + 3 * static_cast<size_t>(chunk.begin + i);
          const Float4 a4 = {static_cast<float>(a[0]), static_cast<float>(a[1]),
                             static_cast<float>(a[2]), 0.0f};
          for (; far < chunk.far_end[i]; ++far) {
            const FarPair& pair = chunk.far[far];
            scatter(pair,
                    a4 * pair.weight * Load4(&blocks[size_t{4} * pair.block]));
          }
          for (; near < chunk.near_end[i]; ++near) {
            const NearPair& pair = chunk.near[near];
            scatter(pair, a4 * pair.weight * LookUp(pair, row, texels.data()));
          }
        }
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
  const size_t size = size_t{4} * options_.patches->count();
  std::vector<std::vector<double>> partial(chunks_.size());
  ParallelFor(
      static_cast<int64_t>(chunks_.size()), options_.num_threads,
      [&](int64_t index, int) {
        const Chunk& chunk = chunks_[index];
        std::vector<double>& g = partial[index];
        g.assign(size, 0.0);
        size_t far = 0;
        for (int i = 0; i < chunk.end - chunk.begin; ++i) {
          const double* a = adjoint + 3 * static_cast<size_t>(chunk.begin + i);
          for (; far < chunk.far_end[i]; ++far) {
            const FarPair& pair = chunk.far[far];
            const int patch = pair.block - num_blocks_;
            if (patch < 0 || patch >= num_patches()) continue;
            const Float4 v = pair.weight * Interpolate(pair, corners, f.data());
            double* const to = &g[size_t{4} * patch];
            for (int c = 0; c < 3; ++c) to[c] += v[c] * a[c];
          }
        }
      });
  std::vector<double> by_emitted(size / 4 * 3, 0.0);
  for (const std::vector<double>& g : partial) {
    for (size_t j = 0; j < size / 4; ++j) {
      for (size_t c = 0; c < 3; ++c) by_emitted[3 * j + c] += g[4 * j + c];
    }
  }
  return by_emitted;
}

void Transport::GridGradient(const BrdfGrid& grid, const float* map,
                             const double* adjoint, float* gradient) const {
  std::vector<double> sums(size_t{3} * options_.grid.num_nodes(), 0.0);
  if (bounces() == 0) {
    AddGridGradient(map, nullptr, adjoint, &sums);
  } else {
    const std::vector<float> f = PadGrid(grid);
    const std::vector<std::vector<double>> emitted = Emitted(f, map, bounces());
    AddGridGradient(map, emitted.back().data(), adjoint, &sums);
    std::vector<double> by_emitted = ByEmitted(f, adjoint);
    for (int b = bounces(); b > 0; --b) {
      patches_->AddGridGradient(map, b > 1 ? emitted[b - 1].data() : nullptr,
                                by_emitted.data(), &sums);
      if (b > 1) by_emitted = patches_->ByEmitted(f, by_emitted.data());
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    gradient[i] = static_cast<float>(sums[i]);
  }
}

}  // namespace ibrdf
