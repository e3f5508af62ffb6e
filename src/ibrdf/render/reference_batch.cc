#include "ibrdf/render/reference_batch.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// Texels with this many times the mean power of a texel stay apart.
constexpr double kBrightTexel = 16.0;

int RoundUp(size_t n) {
  return static_cast<int>((n + kReferenceStride - 1) / kReferenceStride *
                          kReferenceStride);
}

// A texel's two neighbours among the centres of blocks and their weights; of
// the four, those across a pole or a seam are wrapped.
struct Share {
  int block[2];
  double weight[2];
};
Share ShareOf(int texel, int block) {
  const double x = (texel + 0.5) / block - 0.5;
  const double first = std::floor(x);
  Share share;
  for (int k = 0; k < 2; ++k) share.block[k] = static_cast<int>(first) + k;
  share.weight[1] = x - first;
  share.weight[0] = 1.0 - share.weight[1];
  return share;
}

}  // namespace

// The point mirrored so that its normal has no negative x and y. Cells of a map
// are mirrored with it: points of one key share the far rule's samples, but for
// the sense of phi_d, which one mirror turns around.
struct ReferenceBatch::Mirrored {
  using Key = std::array<float, 6>;
  explicit Mirrored(const ShadingPoint& point)
      : across_x(point.normal.x() < 0.0f), across_y(point.normal.y() < 0.0f) {
    for (Eigen::Vector3f* v : {&out.normal, &out.wo}) {
      *v = v == &out.normal ? point.normal : point.wo;
      if (across_x) v->x() = -v->x();
      if (across_y) v->y() = -v->y();
    }
  }
  Key key() const {
    return {out.normal.x(), out.normal.y(), out.normal.z(),
            out.wo.x(),     out.wo.y(),     out.wo.z()};
  }
  bool other_hand() const { return across_x != across_y; }
  // Cell of the point's own map for a cell of the mirrored one.
  int Cell(int cell, int height, int width) const {
    const int row = cell / width, column = cell % width;
    return (across_y ? height - 1 - row : row) * width +
           (across_x ? width - 1 - column : column);
  }

  bool across_x, across_y;
  ShadingPoint out{};
};

struct ReferenceBatch::Scratch {
  std::vector<NearSample> near;
  std::vector<FarSample> far;
  std::vector<MerlTaps> taps;
  std::vector<float> f;  // [kRayBlock][tables.stride] and room to read beyond
  std::vector<float> g;  // [kRayBlock][maps.stride]
  std::vector<double> sums;  // [points of the group][3][maps][tables, rounded]
  VisibilityGrid::Scratch trace;
  // Bits of the group's points; empty where nothing is hidden.
  std::vector<VisibilityGrid::Bits> hidden;
};

// Sorts the light of all maps into blocks and texels that stay apart.
class ReferenceBatch::LightGatherer {
 public:
  LightGatherer(const std::vector<const Image*>& maps, int stride,
                int far_width)
      : maps_(maps),
        height_(maps[0]->height),
        width_(maps[0]->width),
        stride_(stride),
        block_(FarBlockSize(height_, width_, far_width)),
        texels_(MapCells(height_, width_, 1)) {
    light_.height = height_ / block_;
    light_.width = width_ / block_;
    light_.blocks = MapCells(height_, width_, block_);
    sums_.resize(light_.blocks.size() * stride, 0.0);
    for (size_t l = 0; l < maps_.size(); ++l) bright_.push_back(BrightOf(l));
  }

  Light Gather() {
    std::vector<double> solid_angle(light_.blocks.size(), 0.0);
    for (int t = 0; t < height_ * width_; ++t) {
      const Corners corners = CornersOf(t);
      for (int k = 0; k < 4; ++k) {
        solid_angle[corners.cell[k]] +=
            corners.weight[k] * texels_[t].solid_angle;
      }
      AddTexel(t, corners);
    }
    // So that constant light stays constant.
    for (size_t i = 0; i < light_.blocks.size(); ++i) {
      light_.blocks[i].solid_angle = solid_angle[i];
    }
    light_.block_power.assign(sums_.begin(), sums_.end());
    return std::move(light_);
  }

 private:
  // The four blocks around a texel, and its shares of them.
  struct Corners {
    size_t cell[4];
    double weight[4];
  };

  Eigen::Array3d Power(size_t map, size_t texel) const {
    const float* const rgb = &maps_[map]->rgb[3 * texel];
    return Eigen::Array3d(rgb[0], rgb[1], rgb[2]) * texels_[texel].solid_angle;
  }

  // What a texel of that map must have to stay apart.
  double BrightOf(size_t map) const {
    double sum = 0.0;
    for (size_t t = 0; t < texels_.size(); ++t) {
      sum += Power(map, t).abs().sum();
    }
    return sum * (kBrightTexel / static_cast<double>(texels_.size()));
  }

  Corners CornersOf(int texel) const {
    const Share rows = ShareOf(texel / width_, block_);
    const Share columns = ShareOf(texel % width_, block_);
    Corners corners;
    for (int k = 0; k < 4; ++k) {
      const int a = k >> 1, b = k & 1;
      const int row = std::clamp(rows.block[a], 0, light_.height - 1);
      int column = columns.block[b] + light_.width;
      if (row != rows.block[a]) column += light_.width / 2;  // across a pole
      corners.cell[k] =
          static_cast<size_t>(row) * light_.width + column % light_.width;
      corners.weight[k] = rows.weight[a] * columns.weight[b];
    }
    return corners;
  }

  // To the blocks or, of the maps in which it is bright, apart.
  void AddTexel(int texel, const Corners& corners) {
    const size_t count = maps_.size();
    std::vector<float> apart;
    for (size_t l = 0; l < count; ++l) {
      const Eigen::Array3d power = Power(l, texel);
      if (block_ > 1 && power.abs().sum() > bright_[l]) {
        apart.resize(stride_, 0.0f);
        for (int c = 0; c < 3; ++c) {
          apart[c * count + l] = static_cast<float>(power[c]);
        }
        continue;
      }
      for (int k = 0; k < 4; ++k) {
        double* const to = &sums_[corners.cell[k] * stride_];
        for (int c = 0; c < 3; ++c) {
          to[c * count + l] += corners.weight[k] * power[c];
        }
      }
    }
    if (apart.empty()) return;
    light_.texels.push_back(texels_[texel]);
    light_.texel_of.push_back(texel);
    light_.texel_power.insert(light_.texel_power.end(), apart.begin(),
                              apart.end());
  }

  const std::vector<const Image*>& maps_;
  const int height_, width_;
  const size_t stride_;
  const int block_;  // side of the blocks in texels
  const std::vector<FarCell> texels_;
  std::vector<double> bright_;  // by map
  std::vector<double> sums_;    // [block][stride]
  Light light_;
};

ReferenceBatch::ReferenceBatch(const MerlTableStack& tables,
                               const std::vector<const Image*>& maps,
                               const ReferenceOptions& options)
    : ReferenceBatch(
          tables, maps,
          LightGatherer(maps, RoundUp(3 * maps.size()), options.far_width)
              .Gather(),
          options) {}

ReferenceBatch::ReferenceBatch(const MerlTableStack& tables,
                               const std::vector<const Image*>& maps,
                               Light&& light, const ReferenceOptions& options)
    : tables_(tables),
      num_maps_(static_cast<int>(maps.size())),
      num_threads_(options.num_threads),
      sums_size_(3 * maps.size() * RoundUp(tables.count())),
      maps_(maps, RoundUp(3 * maps.size())),
      far_height_(light.height),
      far_width_(light.width),
      texels_(light.texels),
      block_power_(std::move(light.block_power)),
      texel_power_(std::move(light.texel_power)),
      shadows_(options.shadows),
      quadrature_(std::move(light.blocks),
                  NearOptions(maps[0]->width, options)) {
  if (shadows_ == nullptr) return;
  for (int cell = 0; cell < far_height_ * far_width_; ++cell) {
    block_ranges_.push_back(shadows_->RangeOf(
        cell / far_width_, cell % far_width_, far_height_, far_width_));
  }
  for (const int texel : light.texel_of) {
    texel_ranges_.push_back(shadows_->RangeOf(
        texel / maps_.width, texel % maps_.width, maps_.height, maps_.width));
  }
}

void ReferenceBatch::Shade(const double* visible, int n, const float** rows,
                           Scratch* s) const {
  for (int k = 0; k < n; ++k) {
    float* const to = &s->g[size_t{1} * k * maps_.stride];
    const auto factor = static_cast<float>(visible[k]);
    for (int lane = 0; lane < maps_.stride; ++lane) {
      to[lane] = factor * rows[k][lane];
    }
    rows[k] = to;
  }
}

void ReferenceBatch::AddProducts(const float* const* rows, int n, int index,
                                 Scratch* s) const {
  kernels_.add_products(s->f.data(), tables_.stride(), tables_.count(), rows,
                        num_maps_, n, &s->sums[index * sums_size_]);
}

void ReferenceBatch::AddNear(const std::vector<ShadingPoint>& points,
                             const int* group, int count, Scratch* s) const {
  SampleNearOf(PointFrame(points[group[0]]), quadrature_, &s->near);
  std::vector<Eigen::Matrix3f> axes(count);
  for (int p = 0; p < count; ++p) axes[p] = PointFrame(points[group[p]]).Axes();
  for (size_t begin = 0; begin < s->near.size(); begin += kRayBlock) {
    const int n =
        static_cast<int>(std::min<size_t>(kRayBlock, s->near.size() - begin));
    float x[kRayBlock], y[kRayBlock], z[kRayBlock];
    float row[kRayBlock], column[kRayBlock];
    for (int k = 0; k < n; ++k) {
      const NearSample& near = s->near[begin + k];
      x[k] = static_cast<float>(near.wi.x());
      y[k] = static_cast<float>(near.wi.y());
      z[k] = static_cast<float>(near.wi.z());
      s->taps[k] =
          MerlTapsAt(near.theta_h, near.theta_d, near.phi_d, near.weight);
    }
    tables_.Blend(kernels_, s->taps.data(), n, s->f.data());
    for (int p = 0; p < count; ++p) {
      kernels_.place_rays(x, y, z, n, axes[p].data(), maps_.height, maps_.width,
                          row, column);
      kernels_.look_up_maps(maps_.lanes.data(), maps_.height, maps_.width,
                            maps_.stride, row, column, n, s->g.data());
      const float* rows[kRayBlock];
      for (int k = 0; k < n; ++k) rows[k] = &s->g[size_t{1} * k * maps_.stride];
      if (const VisibilityGrid::Bits& hidden = s->hidden[p]; !hidden.empty()) {
        kernels_.place_rays(x, y, z, n, axes[p].data(), shadows_->rows(),
                            shadows_->columns(), row, column);
        const Eigen::Vector3d normal = axes[p].col(2).cast<double>();
        double visible[kRayBlock];
        for (int k = 0; k < n; ++k) {
          visible[k] =
              shadows_->VisibleAt(hidden.data(), normal, row[k], column[k]);
        }
        Shade(visible, n, rows, s);
      }
      AddProducts(rows, n, p, s);
    }
  }
}

void ReferenceBatch::AddFar(const std::vector<ShadingPoint>& points,
                            const int* group, int count, Scratch* s) const {
  std::vector<std::pair<Mirrored, int>> mirrored, own;
  for (int p = 0; p < count; ++p) {
    mirrored.emplace_back(Mirrored(points[group[p]]), p);
  }
  std::stable_sort(mirrored.begin(), mirrored.end(),
                   [](const auto& a, const auto& b) {
                     return a.first.key() < b.first.key();
                   });
  for (size_t first = 0, last = 0; first < mirrored.size(); first = last) {
    const Mirrored& shared = mirrored[first].first;
    while (last < mirrored.size() &&
           mirrored[last].first.key() == shared.key()) {
      ++last;
    }
    const PointFrame frame(shared.out);
    const double correction = quadrature_.SampleFar(frame.n, frame.wo, &s->far);
    for (const bool other_hand : {false, true}) {
      own.clear();
      for (size_t m = first; m < last; ++m) {
        if (mirrored[m].first.other_hand() == other_hand) {
          own.push_back(mirrored[m]);
        }
      }
      if (!own.empty()) AddBlocks(points, group, own, other_hand, s);
    }
    for (size_t m = first; m < last; ++m) {
      const int index = mirrored[m].second;
      AddTexels(PointFrame(points[group[index]]), correction, index, s);
    }
  }
}

void ReferenceBatch::AddBlocks(const std::vector<ShadingPoint>& points,
                               const int* group,
                               const std::vector<std::pair<Mirrored, int>>& own,
                               bool other_hand, Scratch* s) const {
  for (size_t begin = 0; begin < s->far.size(); begin += kRayBlock) {
    const int n =
        static_cast<int>(std::min<size_t>(kRayBlock, s->far.size() - begin));
    const FarSample* const far = &s->far[begin];
    for (int k = 0; k < n; ++k) {
      const double phi_d = other_hand ? kPi - far[k].phi_d : far[k].phi_d;
      s->taps[k] =
          MerlTapsAt(far[k].theta_h, far[k].theta_d, phi_d, far[k].weight);
    }
    tables_.Blend(kernels_, s->taps.data(), n, s->f.data());
    for (const auto& [mirrored, index] : own) {
      const VisibilityGrid::Bits& hidden = s->hidden[index];
      const Eigen::Vector3d n_own = PointFrame(points[group[index]]).n;
      const float* rows[kRayBlock];
      double visible[kRayBlock];
      for (int k = 0; k < n; ++k) {
        const int cell = mirrored.Cell(far[k].cell, far_height_, far_width_);
        rows[k] = &block_power_[static_cast<size_t>(cell) * maps_.stride];
        if (hidden.empty()) continue;
        visible[k] =
            shadows_->VisibleShare(hidden.data(), n_own, block_ranges_[cell]);
      }
      if (!hidden.empty()) Shade(visible, n, rows, s);
      AddProducts(rows, n, index, s);
    }
  }
}

void ReferenceBatch::AddTexels(const PointFrame& frame, double correction,
                               int index, Scratch* s) const {
  const VisibilityGrid::Bits& hidden = s->hidden[index];
  quadrature_.SampleCells(texels_, frame.n, frame.wo, &s->far);
  for (size_t begin = 0; begin < s->far.size(); begin += kRayBlock) {
    const int n =
        static_cast<int>(std::min<size_t>(kRayBlock, s->far.size() - begin));
    const float* rows[kRayBlock];
    double visible[kRayBlock];
    for (int k = 0; k < n; ++k) {
      const FarSample& far = s->far[begin + k];
      s->taps[k] = MerlTapsAt(far.theta_h, far.theta_d, far.phi_d,
                              far.weight * correction);
      rows[k] = &texel_power_[static_cast<size_t>(far.cell) * maps_.stride];
      if (hidden.empty()) continue;
      visible[k] = shadows_->VisibleShare(hidden.data(), frame.n,
                                          texel_ranges_[far.cell]);
    }
    tables_.Blend(kernels_, s->taps.data(), n, s->f.data());
    if (!hidden.empty()) Shade(visible, n, rows, s);
    AddProducts(rows, n, index, s);
  }
}

void ReferenceBatch::Render(const std::vector<ShadingPoint>& points,
                            double* L_o) const {
  const ViewGroups groups(points);
  const size_t tables = tables_.count(), maps = num_maps_;
  const size_t row = RoundUp(tables);
  std::vector<Scratch> scratch(num_threads_ > 0 ? num_threads_
                                                : HardwareThreads());
  ParallelFor(groups.count(), num_threads_, [&](int64_t g, int worker) {
    Scratch& s = scratch[worker];
    const int* const group = &groups.order[groups.begins[g]];
    const size_t count = groups.begins[g + 1] - groups.begins[g];
    s.taps.resize(kRayBlock);
    s.f.resize(size_t{kRayBlock} * tables_.stride() + kReferenceStride);
    s.g.resize(size_t{kRayBlock} * maps_.stride);
    s.sums.assign(count * sums_size_, 0.0);
    s.hidden.resize(count);
    for (size_t p = 0; p < count; ++p) {
      if (shadows_ == nullptr ||
          !shadows_->Trace(points[group[p]], &s.trace, &s.hidden[p])) {
        s.hidden[p].clear();
      }
    }
    AddNear(points, group, static_cast<int>(count), &s);
    AddFar(points, group, static_cast<int>(count), &s);
    for (size_t p = 0; p < count; ++p) {
      for (size_t m = 0; m < tables; ++m) {
        for (size_t l = 0; l < maps; ++l) {
          double* const to =
              L_o + 3 * ((m * maps + l) * points.size() + group[p]);
          for (int c = 0; c < 3; ++c) {
            to[c] = s.sums[p * sums_size_ + (c * maps + l) * row + m];
          }
        }
      }
    }
  });
}

}  // namespace ibrdf
