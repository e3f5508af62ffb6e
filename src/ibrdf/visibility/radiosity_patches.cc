#include "ibrdf/visibility/radiosity_patches.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr int kNormalBins = 2;  // per edge of a cube's face: 24 orientations
constexpr double kPatchGrowth = 1.25;
// A site beside a hit's stands for it if their normals are this much alike.
constexpr double kLikeNormals = 0.5;
// Rounds in which patches find patches that nothing else sees.
constexpr int kMaxRounds = 4;
// Patches are looked at from no flatter than this: nearer the horizon tables
// of reflectance are not to be trusted (interpolated, a smooth surface gives
// back a thousand times what it gets), and every bounce would multiply the
// error.
constexpr double kLeastCosine = 0.15;
// Patches see in steps this much wider than points.
constexpr int kCoarser = 2;

// The square of a cube's face, n x n of them each, that a direction goes
// through.
int CubeBin(const Eigen::Vector3d& d, int n) {
  int axis = 0;
  d.cwiseAbs().maxCoeff(&axis);
  const double size = std::max(std::abs(d[axis]), 1e-300);
  const auto bin = [&](double x) {
    return std::clamp(static_cast<int>((x / size + 1) / 2 * n), 0, n - 1);
  };
  const int face = 2 * axis + (d[axis] < 0.0 ? 1 : 0);
  return (face * n + bin(d[(axis + 1) % 3])) * n + bin(d[(axis + 2) % 3]);
}

Eigen::Vector3d NotTooFlat(const Eigen::Vector3d& n,
                           const Eigen::Vector3d& wo) {
  if (n.dot(wo) >= kLeastCosine) return wo;
  const Eigen::Vector3d across = wo - n.dot(wo) * n;
  return kLeastCosine * n +
         std::sqrt(1.0 - kLeastCosine * kLeastCosine) * across.normalized();
}

}  // namespace

RadiosityOptions PatchesFor(size_t num_points, int bounces) {
  RadiosityOptions options;
  options.bounces = bounces;
  options.max_patches = static_cast<int>(
      std::clamp<size_t>(num_points, 500, options.max_patches));
  return options;
}

RadiosityPatches::RadiosityPatches(const Scene& scene,
                                   const std::vector<ShadingPoint>& points,
                                   std::shared_ptr<const Visibility> visibility,
                                   const RadiosityOptions& options)
    : options_(options), scene_(scene) {
  CHECK(options.bounces >= 1 && options.views >= 1 && options.patch_size > 0.0);
  CHECK_EQ(visibility->grid().rows() % options.lattice_rows, 0);
  CHECK_LE(2 * options.lattice_rows * options.lattice_rows, 65536);
  CHECK(options.max_patches >= 200 && options.max_patches < kNoPatch);
  PlacePatches(CastRays(SpreadPoints(points, options.max_points), *visibility));
  VisibilityOptions rays;
  rays.rows = std::max(visibility->grid().rows() / kCoarser, 32);
  rays.num_threads = options.num_threads;
  const auto own = std::make_shared<Visibility>(scene_, points_, rays);
  visibility_ = own;
  by_point_.lattice_rows = options.lattice_rows;
  LookFrom(points, *visibility, &by_point_);
  if (options.bounces > 1) LinkPatches(own.get());
  TakeMaterials(points);
}

void RadiosityPatches::TakeMaterials(const std::vector<ShadingPoint>& points) {
  const bool one = std::all_of(
      points.begin(), points.end(),
      [&](const ShadingPoint& p) { return p.material == points[0].material; });
  if (points.empty()) return;
  ParallelFor(count(), options_.num_threads, [&](int64_t i, int) {
    ShadingPoint& patch = points_[i];
    const auto distance = [&](const ShadingPoint& p) {
      return (p.position - patch.position).squaredNorm();
    };
    patch.material = one ? points[0].material
                         : std::min_element(points.begin(), points.end(),
                                            [&](const auto& a, const auto& b) {
                                              return distance(a) < distance(b);
                                            })
                               ->material;
  });
}

std::vector<RadiosityPatches::Hit> RadiosityPatches::CastRays(
    const std::vector<ShadingPoint>& points,
    const Visibility& visibility) const {
  std::vector<std::vector<Hit>> found(points.size());
  ParallelFor(static_cast<int64_t>(points.size()), options_.num_threads,
              [&](int64_t i, int) {
                const uint64_t* const hidden = visibility.Hidden(points[i]);
                if (hidden == nullptr) return;
                std::vector<HiddenCell> cells;
                HiddenCells(visibility.grid(), points[i], hidden,
                            options_.lattice_rows, &cells);
                for (const HiddenCell& cell : cells) {
                  Hit hit;
                  if (Meet(points[i], cell.direction, &hit)) {
                    found[i].push_back(hit);
                  }
                }
              });
  std::vector<Hit> hits;
  for (const std::vector<Hit>& of_point : found) {
    hits.insert(hits.end(), of_point.begin(), of_point.end());
  }
  return hits;
}

void RadiosityPatches::PlacePatches(const std::vector<Hit>& hits) {
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  if (!hits.empty()) low_ = high = hits[0].position;
  for (const Hit& hit : hits) {
    low_ = low_.cwiseMin(hit.position);
    high = high.cwiseMax(hit.position);
  }
  const double box = std::max((high - low_).norm(), 1e-300);
  side_ = options_.patch_size * box / 2;
  while (!Gather(hits)) {
    side_ *= kPatchGrowth;
    // One cube holds all: 24 orientations, 6 views each.
    if (side_ > 2 * box) options_.views = 1;
  }
}

void RadiosityPatches::LinkPatches(Visibility* visibility) {
  by_patch_.lattice_rows = std::max(options_.lattice_rows / kCoarser, 1);
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto looked = static_cast<int64_t>(by_patch_.begin.size()) - 1;
    const std::vector<ShadingPoint> fresh(points_.begin() + looked,
                                          points_.end());
    if (fresh.empty()) break;
    if (round > 0) visibility->Add(fresh);
    const std::vector<Unknown> unknown =
        LookFrom(fresh, *visibility, &by_patch_);
    if (round + 1 < kMaxRounds) AddPatches(unknown, &by_patch_);
  }
}

void RadiosityPatches::HiddenCells(const VisibilityGrid& grid,
                                   const ShadingPoint& point,
                                   const uint64_t* hidden, int lattice_rows,
                                   std::vector<HiddenCell>* cells) {
  cells->clear();
  const int rows = lattice_rows;
  const Eigen::Vector3d n = point.normal.cast<double>();
  std::vector<Eigen::Vector3d> directions;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < 2 * rows; ++column) {
      const GridRange range = grid.RangeOf(row, column, rows, 2 * rows);
      directions.clear();
      int texels = 0;
      for (int r = range.row_begin; r < range.row_end; ++r) {
        for (int c = range.column_begin; c < range.column_end; ++c, ++texels) {
          if (!grid.Hidden(hidden, r, c)) continue;
          directions.push_back(grid.Direction(r, c));
        }
      }
      if (directions.empty()) continue;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& d : directions) {
        middle += std::max(n.dot(d), 1e-6) * d;
      }
      const auto nearest = std::max_element(
          directions.begin(), directions.end(),
          [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
            return a.dot(middle) < b.dot(middle);
          });
      cells->push_back(
          {static_cast<uint16_t>(row * 2 * rows + column), *nearest});
    }
  }
}

bool RadiosityPatches::Meet(const ShadingPoint& point,
                            const Eigen::Vector3d& direction, Hit* hit) const {
  SurfaceHit surface;
  if (!scene_.Intersect({point.position, direction}, false, &surface)) {
    return false;
  }
  hit->position = surface.position;
  hit->normal = surface.normal;
  hit->wo = -direction;
  hit->texture = surface.texture;
  return true;
}

bool RadiosityPatches::Meet(const ShadingPoint& point,
                            const Eigen::Vector3d& direction,
                            ShadingPoint* met) const {
  Hit hit;
  if (!Meet(point, direction, &hit)) return false;
  ShadingPoint point_met{};
  point_met.normal = hit.normal.cast<float>();
  point_met.wo = hit.wo.cast<float>();
  point_met.position = hit.position;
  point_met.texture = hit.texture;
  point_met.pixel = -1;
  point_met.coverage = 1.0f;
  *met = point_met;
  return true;
}

uint64_t RadiosityPatches::SiteOf(const Eigen::Vector3d& position,
                                  const Eigen::Vector3d& normal) const {
  uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    // Those met later may lie outside the box: offset, and far less than 2^19
    // sides away.
    const auto cell = static_cast<int64_t>(
        std::floor((position[k] - low_[k]) / side_) + (1 << 18));
    key = key << 19 | static_cast<uint64_t>(
                          std::clamp<int64_t>(cell, 0, (int64_t{1} << 19) - 1));
  }
  return key * (6 * kNormalBins * kNormalBins) +
         static_cast<uint64_t>(CubeBin(normal, kNormalBins));
}

bool RadiosityPatches::Gather(const std::vector<Hit>& hits) {
  struct Group {
    uint64_t site;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d wo = Eigen::Vector3d::Zero();
    int count = 0;
    int nearest = -1;  // the hit nearest to the mean position
    double distance = 0.0;
  };
  const uint64_t views = 6 * options_.views * options_.views;
  std::vector<Group> groups;
  std::unordered_map<uint64_t, int> by_key;
  std::vector<int> group_of(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const uint64_t site = SiteOf(hits[i].position, hits[i].normal);
    const uint64_t key = site * views + static_cast<uint64_t>(CubeBin(
                                            hits[i].wo, options_.views));
    const auto [at, added] =
        by_key.try_emplace(key, static_cast<int>(groups.size()));
    if (added) groups.emplace_back().site = site;
    if (groups.size() > static_cast<size_t>(options_.max_patches)) {
      return false;
    }
    Group& group = groups[at->second];
    group.position += hits[i].position;
    group.wo += hits[i].wo;
    ++group.count;
    group_of[i] = at->second;
  }
  for (size_t i = 0; i < hits.size(); ++i) {
    Group& group = groups[group_of[i]];
    const double distance =
        (hits[i].position - group.position / group.count).norm();
    if (group.nearest >= 0 && distance >= group.distance) continue;
    group.nearest = static_cast<int>(i);
    group.distance = distance;
  }
  for (const Group& group : groups) {
    Hit hit = hits[group.nearest];
    const Eigen::Vector3d wo = group.wo.normalized();
    if (hit.normal.dot(wo) >= kMinViewCosine) hit.wo = wo;
    AddPatch(group.site, hit);
  }
  return true;
}

void RadiosityPatches::AddPatch(uint64_t site, const Hit& hit) {
  ShadingPoint point{};
  point.normal = hit.normal.cast<float>();
  point.wo = NotTooFlat(hit.normal, hit.wo).cast<float>();
  point.position = hit.position;
  point.pixel = -1;
  point.coverage = 1.0f;
  point.index = count();
  sites_[site].push_back(point.index);
  points_.push_back(point);
}

int RadiosityPatches::Find(const Hit& hit) const {
  const auto nearest_view = [&](const std::vector<int>& patches) {
    return *std::max_element(patches.begin(), patches.end(), [&](int a, int b) {
      return points_[a].wo.cast<double>().dot(hit.wo) <
             points_[b].wo.cast<double>().dot(hit.wo);
    });
  };
  const auto own = sites_.find(SiteOf(hit.position, hit.normal));
  if (own != sites_.end()) return nearest_view(own->second);
  int best = -1;
  double least = 0.0;
  for (int k = 0; k < 27; ++k) {
    const Eigen::Vector3d step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const Eigen::Vector3d position = hit.position + side_ * step;
    const uint64_t first = SiteOf(position, Eigen::Vector3d::UnitX()) /
                           (6 * kNormalBins * kNormalBins) *
                           (6 * kNormalBins * kNormalBins);
    for (int bin = 0; bin < 6 * kNormalBins * kNormalBins; ++bin) {
      const auto beside = sites_.find(first + bin);
      if (beside == sites_.end()) continue;
      const ShadingPoint& patch = points_[beside->second.front()];
      if (patch.normal.cast<double>().dot(hit.normal) < kLikeNormals) {
        continue;
      }
      const double distance = (patch.position - hit.position).norm();
      if (best >= 0 && distance >= least) continue;
      least = distance;
      best = nearest_view(beside->second);
    }
  }
  return best;
}

SeenPatches RadiosityPatches::Look(const ShadingPoint& point,
                                   const VisibilityGrid& grid,
                                   const uint64_t* hidden,
                                   std::vector<SeenPatch>* seen) const {
  Look(point, grid, hidden, options_.lattice_rows, seen, nullptr);
  return {seen->data(), seen->data() + seen->size(), options_.lattice_rows};
}

void RadiosityPatches::Look(const ShadingPoint& point,
                            const VisibilityGrid& grid, const uint64_t* hidden,
                            int lattice_rows, std::vector<SeenPatch>* seen,
                            std::vector<Unknown>* unknown) const {
  std::vector<HiddenCell> cells;
  HiddenCells(grid, point, hidden, lattice_rows, &cells);
  seen->clear();
  for (const HiddenCell& cell : cells) {
    Hit hit;
    const bool met = Meet(point, cell.direction, &hit);
    const int patch = met ? Find(hit) : -1;
    if (patch < 0 && met && unknown != nullptr) {
      unknown->push_back({static_cast<int64_t>(seen->size()), hit});
    }
    seen->push_back(
        {cell.cell, patch < 0 ? kNoPatch : static_cast<uint16_t>(patch)});
  }
}

std::vector<RadiosityPatches::Unknown> RadiosityPatches::LookFrom(
    const std::vector<ShadingPoint>& points, const Visibility& visibility,
    Table* table) const {
  std::vector<std::vector<SeenPatch>> seen(points.size());
  std::vector<std::vector<Unknown>> missing(points.size());
  ParallelFor(static_cast<int64_t>(points.size()), options_.num_threads,
              [&](int64_t i, int) {
                const uint64_t* const hidden = visibility.Hidden(points[i]);
                if (hidden == nullptr) return;
                Look(points[i], visibility.grid(), hidden, table->lattice_rows,
                     &seen[i], &missing[i]);
              });
  std::vector<int64_t> order(points.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int64_t>(i);
  std::sort(order.begin(), order.end(), [&](int64_t a, int64_t b) {
    return points[a].index < points[b].index;
  });
  std::vector<Unknown> unknown;
  for (const int64_t i : order) {
    const auto first = static_cast<int64_t>(table->seen.size());
    // Indices that no point has see nothing.
    table->begin.resize(points[i].index + size_t{1}, first);
    for (Unknown& u : missing[i]) {
      u.entry += first;
      unknown.push_back(u);
    }
    table->seen.insert(table->seen.end(), seen[i].begin(), seen[i].end());
    table->begin.push_back(static_cast<int64_t>(table->seen.size()));
  }
  return unknown;
}

void RadiosityPatches::AddPatches(const std::vector<Unknown>& unknown,
                                  Table* table) {
  for (const Unknown& u : unknown) {
    int patch = Find(u.hit);
    if (patch < 0 && count() < kNoPatch) {
      patch = count();
      AddPatch(SiteOf(u.hit.position, u.hit.normal), u.hit);
    }
    if (patch < 0) continue;
    table->seen[u.entry].patch = static_cast<uint16_t>(patch);
  }
}

SeenPatches RadiosityPatches::Table::Of(int index) const {
  if (index < 0 || static_cast<size_t>(index) + 1 >= begin.size()) return {};
  return {seen.data() + begin[index], seen.data() + begin[index + 1],
          lattice_rows};
}

SeenPatches RadiosityPatches::SeenFrom(const ShadingPoint& point) const {
  return by_point_.Of(point.index);
}

SeenPatches RadiosityPatches::SeenFromPatch(const ShadingPoint& patch) const {
  return by_patch_.Of(patch.index);
}

void RadiosityPatches::SharesIn(const VisibilityGrid& grid,
                                const uint64_t* hidden,
                                const Eigen::Vector3d& n,
                                const GridRange& range, const SeenPatches& seen,
                                std::vector<PatchShare>* shares) const {
  shares->clear();
  const int stride = grid.rows() / seen.lattice_rows;
  const int columns = 2 * seen.lattice_rows;
  double all = 0.0, behind = 0.0;
  const int row_end = (range.row_end + stride - 1) / stride;
  const int column_end = (range.column_end + stride - 1) / stride;
  for (int row = range.row_begin / stride; row < row_end; ++row) {
    for (int column = range.column_begin / stride; column < column_end;
         ++column) {
      const GridRange part = {
          std::max(range.row_begin, row * stride),
          std::min(range.row_end, (row + 1) * stride),
          std::max(range.column_begin, column * stride),
          std::min(range.column_end, (column + 1) * stride)};
      double part_all = 0.0;
      grid.CosineSums(hidden, n, part, &part_all, &behind);
      all += part_all;
      if (behind <= 0.0) continue;
      const int patch = InCell(seen, row * columns + column);
      if (patch >= 0) shares->push_back({patch, behind});
    }
  }
  for (PatchShare& share : *shares) share.share /= all;
}

int RadiosityPatches::InCell(const SeenPatches& seen, int cell) {
  const SeenPatch* const at = std::lower_bound(
      seen.begin, seen.end, cell,
      [](const SeenPatch& s, int wanted) { return s.cell < wanted; });
  if (at == seen.end || at->cell != cell || at->patch == kNoPatch) {
    return -1;
  }
  return at->patch;
}

int RadiosityPatches::Along(const SeenPatches& seen,
                            const Eigen::Vector3d& wi) const {
  const int rows = seen.lattice_rows;
  double row = 0.0, column = 0.0;
  MapPosition(wi, rows, 2 * rows, &row, &column);
  const int r = std::clamp(static_cast<int>(row), 0, rows - 1);
  const int c = std::clamp(static_cast<int>(column), 0, 2 * rows - 1);
  // Visibility is interpolated: beside an edge the next cell has the patch.
  const int beside_r = std::clamp(r + (row - r < 0.5 ? -1 : 1), 0, rows - 1);
  const int beside_c =
      (c + (column - c < 0.5 ? -1 : 1) + 2 * rows) % (2 * rows);
  for (const int cell :
       {r * 2 * rows + c, r * 2 * rows + beside_c, beside_r * 2 * rows + c,
        beside_r * 2 * rows + beside_c}) {
    const int patch = InCell(seen, cell);
    if (patch >= 0) return patch;
  }
  return -1;
}

size_t RadiosityPatches::MemoryBytes() const {
  size_t bytes = points_.capacity() * sizeof(ShadingPoint);
  for (const Table* table : {&by_point_, &by_patch_}) {
    bytes += table->seen.capacity() * sizeof(SeenPatch) +
             table->begin.capacity() * sizeof(int64_t);
  }
  return bytes + visibility_->MemoryBytes();
}

}  // namespace ibrdf
