#include "ibrdf/transport/transport_pairs.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/map_sources.h"

namespace ibrdf {
namespace {

// Points are joined in this many sums, whatever the number of threads.
constexpr int kMaxChunks = 32;

uint16_t Quantise(double fraction) {
  return static_cast<uint16_t>(std::clamp(fraction, 0.0, 1.0) * 65535.0 + 0.5);
}

// A pair where a sample's angles lie in the grid.
template <typename Pair, typename Sample>
Pair PairAt(const BrdfGridShape& shape, const Sample& sample, double weight) {
  const BrdfGridCell cell = FindCell(
      shape, {sample.x_h, sample.theta_d / (kPi / 2), sample.phi_d / kPi});
  Pair pair{};
  pair.node = static_cast<uint32_t>(
      (cell.h * shape.d + cell.d) * (shape.p + 1) + cell.p);
  pair.fh = Quantise(cell.fh);
  pair.fd = Quantise(cell.fd);
  pair.fp = Quantise(cell.fp);
  pair.weight = static_cast<float>(weight);
  return pair;
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

// Lists the pairs of one chunk, point by point.
class ChunkBuilder {
 public:
  ChunkBuilder(const TransportPairs& pairs, const TransportOptions& options,
               const std::vector<FarCell>& cells,
               const PointQuadrature& quadrature, PairsOf of, PairChunk* chunk)
      : pairs_(pairs),
        visibility_(options.visibility.get()),
        patches_(options.patches.get()),
        cells_(cells),
        quadrature_(quadrature),
        of_(of),
        chunk_(*chunk) {}

  void Build(const std::vector<ShadingPoint>& points);

 private:
  // A point, and what it sees of the object.
  struct Sight {
    Eigen::Vector3d n, wo;             // unit
    const uint64_t* hidden = nullptr;  // Visibility::Hidden; null: nothing is
    SeenPatches seen;
  };
  Sight SightOf(const ShadingPoint& point) const;
  // A sample of the far rule: its cell as far as it is visible, patches where
  // it is hidden.
  void AddFar(FarSample sample, const Sight& sight);
  void AddPatchesBehind(const FarSample& sample, const GridRange& range,
                        const Sight& sight);
  // A far sample whose block is hidden in part, as pairs with its texels.
  void AddTexelsOf(const FarSample& sample, const Sight& sight);
  // A sample of the near rule, likewise.
  void AddNear(NearSample sample, const Sight& sight);
  // Every bright sample that the point sees.
  void AddBright(const Sight& sight);

  template <typename Sample>
  void AddSource(const Sample& sample, int source, double weight) {
    auto pair = PairAt<FarPair>(pairs_.grid, sample, weight);
    pair.source = static_cast<uint16_t>(source);
    chunk_.far.push_back(pair);
  }

  const TransportPairs& pairs_;
  const Visibility* const visibility_;
  const RadiosityPatches* const patches_;
  const std::vector<FarCell>& cells_;
  const PointQuadrature& quadrature_;
  const PairsOf of_;
  PairChunk& chunk_;
  PointSamples samples_;
  std::vector<PatchShare> shares_;
};

void ChunkBuilder::Build(const std::vector<ShadingPoint>& points) {
  for (int i = chunk_.begin; i < chunk_.end; ++i) {
    const Sight sight = SightOf(points[i]);
    quadrature_.Sample(sight.n, sight.wo, &samples_);
    for (const FarSample& sample : samples_.far) AddFar(sample, sight);
    for (const NearSample& sample : samples_.near) AddNear(sample, sight);
    AddBright(sight);
    const double of_done =
        1.0 * (chunk_.end - chunk_.begin) / (i + 1 - chunk_.begin);
    ReserveFor(of_done, &chunk_.far);
    ReserveFor(of_done, &chunk_.near);
    chunk_.far_end.push_back(chunk_.far.size());
    chunk_.near_end.push_back(chunk_.near.size());
  }
  GiveBackSpare(&chunk_.far);
  GiveBackSpare(&chunk_.near);
}

ChunkBuilder::Sight ChunkBuilder::SightOf(const ShadingPoint& point) const {
  Sight sight;
  sight.n = point.normal.cast<double>().normalized();
  sight.wo = point.wo.cast<double>().normalized();
  if (visibility_ != nullptr) sight.hidden = visibility_->Hidden(point);
  if (sight.hidden != nullptr && patches_ != nullptr) {
    sight.seen = of_ == PairsOf::kPoints ? patches_->SeenFrom(point)
                                         : patches_->SeenFromPatch(point);
  }
  return sight;
}

void ChunkBuilder::AddFar(FarSample sample, const Sight& sight) {
  if (sight.hidden != nullptr) {
    const VisibilityGrid& grid = visibility_->grid();
    const int columns = pairs_.map_width / pairs_.block;
    const GridRange range =
        grid.RangeOf(sample.cell / columns, sample.cell % columns,
                     pairs_.map_height / pairs_.block, columns);
    const double share = grid.VisibleShare(sight.hidden, sight.n, range);
    if (share < 1.0 && !sight.seen.empty()) {
      AddPatchesBehind(sample, range, sight);
    }
    if (share <= 0.0) return;
    if (share < 1.0 && pairs_.block > 1) return AddTexelsOf(sample, sight);
    sample.weight *= share;
  }
  AddSource(sample, sample.cell, sample.weight);
}

void ChunkBuilder::AddPatchesBehind(const FarSample& sample,
                                    const GridRange& range,
                                    const Sight& sight) {
  patches_->SharesIn(visibility_->grid(), sight.hidden, sight.n, range,
                     sight.seen, &shares_);
  for (const PatchShare& e : shares_) {
    AddSource(sample, pairs_.num_blocks + e.patch,
              sample.weight * cells_[sample.cell].solid_angle * e.share);
  }
}

void ChunkBuilder::AddTexelsOf(const FarSample& sample, const Sight& sight) {
  const VisibilityGrid& grid = visibility_->grid();
  const int height = pairs_.map_height, width = pairs_.map_width;
  const int side = pairs_.block, columns = width / side;
  const auto whole = PairAt<NearPair>(pairs_.grid, sample, sample.weight);
  for (int k = 0; k < side * side; ++k) {
    const int y = sample.cell / columns * side + k / side;
    const int x = sample.cell % columns * side + k % side;
    const double share = grid.VisibleShare(sight.hidden, sight.n,
                                           grid.RangeOf(y, x, height, width));
    if (share <= 0.0) continue;
    NearPair pair = whole;
    pair.texel = static_cast<uint32_t>((y + 1) * pairs_.padded_row() + x);
    pair.weight *=
        static_cast<float>(share * TexelSolidAngle(y, height, width));
    chunk_.near.push_back(pair);
  }
}

void ChunkBuilder::AddNear(NearSample sample, const Sight& sight) {
  if (sight.hidden != nullptr) {
    const double visible =
        visibility_->grid().VisibleAlong(sight.hidden, sight.n, sample.wi);
    if (visible < 1.0 && !sight.seen.empty()) {
      const int patch = patches_->Along(sight.seen, sample.wi);
      if (patch >= 0) {
        AddSource(sample, pairs_.num_blocks + patch,
                  sample.weight * (1.0 - visible));
      }
    }
    sample.weight *= visible;
    if (sample.weight <= 0.0) return;
  }
  auto pair = PairAt<NearPair>(pairs_.grid, sample, sample.weight);
  const int width = pairs_.map_width;
  double row = 0.0, column = 0.0;
  FastMapPosition(sample.wi, pairs_.map_height, width, &row, &column);
  const double y0 = std::floor(row - 0.5), x0 = std::floor(column - 0.5);
  const int x = (static_cast<int>(x0) + width) % width;
  pair.texel = static_cast<uint32_t>(
      (static_cast<int>(y0) + 1) * pairs_.padded_row() + x);
  pair.fy = Quantise(row - 0.5 - y0);
  pair.fx = Quantise(column - 0.5 - x0);
  chunk_.near.push_back(pair);
}

void ChunkBuilder::AddBright(const Sight& sight) {
  const Eigen::Vector3d& n = sight.n;
  for (size_t k = 0; k < pairs_.bright.size(); ++k) {
    const Eigen::Vector3d& wi = pairs_.bright[k].direction;
    FarSample sample{};
    sample.weight = wi.dot(n);
    if (sample.weight > 0.0 && sight.hidden != nullptr) {
      sample.weight *= visibility_->grid().VisibleAlong(sight.hidden, n, wi);
    }
    if (sample.weight <= 0.0) continue;
    const Eigen::Vector3d h = (wi + sight.wo).normalized();
    const double cos_h = std::max(n.dot(h), 0.0), cos_d = wi.dot(h);
    const Eigen::Vector3d across = n.cross(h);
    sample.theta_h = FastAtan2(across.norm(), cos_h);
    sample.theta_d = FastAtan2(wi.cross(h).norm(), cos_d);
    // As PointQuadrature has it; at theta_h = 0, where no direction is meant,
    // an isotropic reflectance does not depend on it.
    sample.phi_d =
        FoldPhi(FastAtan2(across.dot(wi), cos_h * cos_d - n.dot(wi)));
    sample.x_h = ToUnitCube(sample.theta_h, sample.theta_d, sample.phi_d)[0];
    AddSource(sample, pairs_.first_bright() + static_cast<int>(k),
              sample.weight);
  }
}

}  // namespace

TransportPairs::TransportPairs(const std::vector<ShadingPoint>& points,
                               int height, int width,
                               const TransportOptions& options, PairsOf of)
    : grid(options.grid),
      num_threads(options.num_threads),
      num_points(static_cast<int>(points.size())),
      map_height(height),
      map_width(width),
      block(FarBlockSize(height, width, options.quadrature.far_width)),
      num_patches(options.patches != nullptr ? options.patches->count() : 0),
      bright(options.bright) {
  CHECK(height > 0 && width > 1 && width % 2 == 0);
  CHECK(grid.h >= 2 && grid.d >= 2 && grid.p >= 1);
  num_blocks = (height / block) * (width / block);
  for (const ShadingPoint& point : points) material.push_back(point.material);
  CHECK(options.patches == nullptr || options.visibility != nullptr);
  CHECK_LE(first_bright() + bright.size(), size_t{kMaxFarSources})
      << "map of odd size: resize it first";
  padded_texels = PaddedTexels(height, width);
  const std::vector<FarCell> cells = MapCells(height, width, block);
  const PointQuadrature quadrature(cells, options.quadrature);
  const int num_chunks = std::min(kMaxChunks, num_points);
  chunks.resize(num_chunks);
  ParallelFor(num_chunks, num_threads, [&](int64_t i, int) {
    PairChunk& chunk = chunks[i];
    chunk.begin = static_cast<int>(i * num_points / num_chunks);
    chunk.end = static_cast<int>((i + 1) * num_points / num_chunks);
    ChunkBuilder(*this, options, cells, quadrature, of, &chunk).Build(points);
  });
}

size_t TransportPairs::MemoryBytes() const {
  size_t bytes = 0;
  for (const PairChunk& chunk : chunks) {
    bytes +=
        chunk.far.capacity() * sizeof(FarPair) +
        chunk.near.capacity() * sizeof(NearPair) +
        (chunk.far_end.capacity() + chunk.near_end.capacity()) * sizeof(size_t);
  }
  return bytes;
}

PairSources::PairSources(const TransportPairs& pairs, const float* map)
    : pairs_(pairs),
      row_(pairs.padded_row()),
      texels_(4 * pairs.padded_texels.size(), 0.0f),
      far_(SumBlocks(map, pairs.map_height, pairs.map_width, pairs.block)) {
  for (size_t i = 0; i < pairs.padded_texels.size(); ++i) {
    std::copy_n(map + size_t{3} * pairs.padded_texels[i], 3, &texels_[4 * i]);
  }
  const size_t first = pairs.first_bright();
  far_.resize(4 * (first + pairs.bright.size()), 0.0f);
  for (size_t k = 0; k < pairs.bright.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      far_[4 * (first + k) + c] = static_cast<float>(pairs.bright[k].power[c]);
    }
  }
}

void PairSources::SetEmitted(const double* emitted) {
  for (int j = 0; j < pairs_.num_patches; ++j) {
    for (int c = 0; c < 3; ++c) {
      far_[size_t{4} * (pairs_.num_blocks + j) + c] =
          emitted != nullptr ? static_cast<float>(emitted[3 * j + c]) : 0.0f;
    }
  }
}

std::vector<float> PadFields(const BrdfGridShape& s, const float* const* fields,
                             int num_fields, int stride, int num_threads) {
  const int row = s.p + 1;
  std::vector<float> padded(static_cast<size_t>(s.h) * s.d * row * stride,
                            0.0f);
  ParallelFor(s.h, num_threads, [&](int64_t ih, int) {
    for (int hd = static_cast<int>(ih) * s.d; hd < (ih + 1) * s.d; ++hd) {
      for (int p = 0; p <= s.p; ++p) {
        float* const to = &padded[(static_cast<size_t>(hd) * row + p) * stride];
        for (int k = 0; k < num_fields; ++k) {
          to[k] = fields[k][hd * s.p + p % s.p];
        }
      }
    }
  });
  return padded;
}

}  // namespace ibrdf
