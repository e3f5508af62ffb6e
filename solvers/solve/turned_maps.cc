#include "ibrdf/solvers/solve/turned_maps.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

using FloatMatrix =
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kMostColumns = 64;

Image CoarseMap(const Image& map) {
  return map.width <= kMostColumns
             ? map
             : ResizeMap(map, kMostColumns / 2, kMostColumns);
}

// All turns, the unmirrored first: columns [turn * 3 + channel].
FloatMatrix AllTurns(const Image& map) {
  const int turns = 2 * map.width;
  FloatMatrix out(static_cast<Eigen::Index>(map.num_pixels()), 3 * turns);
  for (int turn = 0; turn < turns; ++turn) {
    const Image turned = Turned(map, turn >= map.width, turn % map.width);
    out.middleCols(3 * turn, 3) =
        Eigen::Map<const FloatMatrix>(turned.rgb.data(), out.rows(), 3);
  }
  return out;
}

}  // namespace

Image Turned(const Image& map, bool mirrored, int columns) {
  Image out(map.width, map.height);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const int before = ((x - columns) % map.width + map.width) % map.width;
      const float* from = map.At(mirrored ? map.width - 1 - before : before, y);
      std::copy(from, from + 3, out.At(x, y));
    }
  }
  return out;
}

bool HasKnownRadiance(const Observations& observed, size_t pixel) {
  bool known = observed.valid[pixel] != 0;
  for (size_t v = 3 * pixel; v < 3 * pixel + 3; ++v) {
    const RadianceInterval seen = observed.Interval(v);
    known = known && seen.low > 0.0 && std::isfinite(seen.high);
  }
  return known;
}

TurnedMaps::TurnedMaps(const SolveSetup& setup,
                       const std::vector<ShadingPoint>& points,
                       const std::vector<BrdfGrid>& lobes) {
  const Image map = CoarseMap(*setup.problem->known_map);
  columns_ = map.width;
  TransportOptions options = setup.transport;
  options.patches = nullptr;
  options.bright.clear();
  options.quadrature.far_width =
      std::max(options.quadrature.far_width, map.width);
  const Transport transport(points, map.height, map.width, options);
  const FloatMatrix maps = AllTurns(map);
  radiance_.assign(
      lobes.size(),
      FloatMatrix(static_cast<Eigen::Index>(points.size()), maps.rows()));
  std::vector<const float*> fields;
  std::vector<float*> matrices;
  for (size_t k = 0; k < lobes.size(); ++k) {
    fields.push_back(lobes[k].Channel(0));
    matrices.push_back(radiance_[k].data());
  }
  transport.LightMatrices(fields, matrices);
  for (FloatMatrix& of_lobe : radiance_) of_lobe = of_lobe * maps;
}

MapTurns TurnedMaps::Best(const std::vector<double>& misfits,
                          double as_good) const {
  auto best = static_cast<int>(
      std::min_element(misfits.begin(), misfits.end()) - misfits.begin());
  int quarter = 0;
  for (int turn = 0; turn < num_turns(); ++turn) {
    if (4 * turn % columns_ == 0 && misfits[turn] < misfits[quarter]) {
      quarter = turn;
    }
  }
  if (misfits[quarter] <= as_good * misfits[best]) best = quarter;
  return {
      misfits.front(),
      {best >= columns_, 360.0 * (best % columns_) / columns_, misfits[best]}};
}

}  // namespace ibrdf
