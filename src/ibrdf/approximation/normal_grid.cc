#include "ibrdf/approximation/normal_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Cells of the first cut: by angle to the view and around it.
constexpr int kRows = 2;
constexpr int kColumns = 8;
// A cell is cut in four at most this often.
constexpr int kMaxDepth = 8;
// Steps of the finest nodes; a cell of depth d spans 2^(kMaxDepth - d + 1).
constexpr int kCellSteps = 2 << kMaxDepth;
constexpr int kFinestColumns = kColumns * kCellSteps;
// Nodes that cutting a cell adds; the points that make it worth while are more,
// for the parts may fail as well.
constexpr int kNewNodes = 16;
constexpr size_t kWorthCutting = 3 * kNewNodes;
// Cutting a cell of a smooth function in four divides its error by 8. The error
// known of a cell is that of the one it was cut from.
constexpr double kGain = 8.0;
constexpr double kFirstTolerance = 32.0;  // of the requested error
constexpr int kRounds = 12;               // each halves the tolerance
constexpr double kDark = 1e-3;            // of the geometric mean

double MaxTheta() { return std::acos(double{kMinViewCosine}); }

// A node has one key for all its turns around the view.
int NodeKey(int row, int column) {
  return row * kFinestColumns + (row == 0 ? 0 : column % kFinestColumns);
}

// A cell is known by its first node.
int64_t CellKey(int row, int column, int depth) {
  return (int64_t{depth} * (kRows * kCellSteps + 1) + row) * kFinestColumns +
         column;
}

}  // namespace

int NormalGrid::Cell::steps() const { return kCellSteps >> depth; }

NormalGrid::NormalGrid(const std::vector<ShadingPoint>& points,
                       const RadianceRenderer& renderer,
                       const ReflectanceMapOptions& options)
    : renderer_(renderer),
      options_(options),
      wo_(points[0].wo.cast<double>().normalized()),
      t_(wo_.unitOrthogonal()),
      b_(wo_.cross(t_)),
      any_(points[0]) {}

NormalGrid::Place NormalGrid::PlaceOf(const ShadingPoint& point) const {
  const Eigen::Vector3d n = point.normal.cast<double>();
  const double x = n.dot(t_), y = n.dot(b_);
  const double theta = std::atan2(std::hypot(x, y), n.dot(wo_));
  double turn = std::atan2(y, x) / (2.0 * kPi);
  if (turn < 0.0) turn += 1.0;
  return {std::clamp(theta / MaxTheta(), 0.0, 1.0) * kRows * kCellSteps,
          std::min(turn, 1.0) * kFinestColumns};
}

int NormalGrid::AskForNode(int row, int column) {
  const auto [it, is_new] =
      nodes_.try_emplace(NodeKey(row, column), static_cast<int>(nodes_.size()));
  if (is_new) {
    const double theta = MaxTheta() * row / (kRows * kCellSteps);
    const double phi =
        row == 0 ? 0.0 : 2.0 * kPi * (column % kFinestColumns) / kFinestColumns;
    ShadingPoint p = any_;
    p.normal = (std::sin(theta) * (std::cos(phi) * t_ + std::sin(phi) * b_) +
                std::cos(theta) * wo_)
                   .cast<float>();
    waiting_.push_back(p);
  }
  return it->second;
}

int NormalGrid::NodeAt(int row, int column) const {
  return nodes_.at(NodeKey(row, column));
}

bool NormalGrid::RenderNodes(const RadianceRenderer::Progress& progress) {
  if (waiting_.empty()) return true;
  const size_t first = radiance_.size();
  radiance_.resize(first + 3 * waiting_.size());
  const bool go_on = renderer_.Render(waiting_, progress, &radiance_[first]);
  waiting_.clear();
  return go_on;
}

double NormalGrid::Log(double radiance, int channel) const {
  return std::log(std::max(radiance, 0.0) + dark_[channel]);
}

void NormalGrid::FindDark() {
  const auto count = static_cast<double>(radiance_.size() / 3);
  for (int c = 0; c < 3; ++c) {
    double mean = 0.0, log_mean = 0.0;
    for (size_t k = c; k < radiance_.size(); k += 3) {
      mean += std::max(radiance_[k], 0.0) / count;
    }
    if (!(mean > 0.0)) continue;
    for (size_t k = c; k < radiance_.size(); k += 3) {
      log_mean += std::log(std::max(radiance_[k], 1e-9 * mean)) / count;
    }
    dark_[c] = kDark * std::exp(log_mean);
  }
}

Eigen::Array3d NormalGrid::InterpolateLog(const Cell& cell,
                                          const Place& place) const {
  const auto weights = [&](double at, int first, double w[3]) {
    const double x = 2.0 * (at - first) / cell.steps();
    w[0] = 0.5 * (x - 1.0) * (x - 2.0);
    w[1] = x * (2.0 - x);
    w[2] = 0.5 * x * (x - 1.0);
  };
  double wr[3], wc[3];
  weights(place.row, cell.row, wr);
  weights(place.column, cell.column, wc);
  const int half = cell.steps() / 2;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) {
      const int node = NodeAt(cell.row + r * half, cell.column + k * half);
      for (int c = 0; c < 3; ++c) sum[c] += wr[r] * wc[k] * NodeLog(node, c);
    }
  }
  return sum;
}

void NormalGrid::Interpolate(const Cell& cell, const Place& place,
                             double* L_o) const {
  const Eigen::Array3d log_radiance = InterpolateLog(cell, place);
  for (int c = 0; c < 3; ++c) {
    L_o[c] = std::max(std::exp(log_radiance[c]) - dark_[c], 0.0);
  }
}

void NormalGrid::AskForParts(const Cell& cell) {
  const int quarter = cell.steps() / 4;
  for (int r = 0; r <= 4; ++r) {
    for (int c = 0; c <= 4; ++c) {
      AskForNode(cell.row + r * quarter, cell.column + c * quarter);
    }
  }
}

double NormalGrid::ErrorAtParts(const Cell& cell) const {
  const int quarter = cell.steps() / 4;
  double sum = 0.0;
  int count = 0;
  for (int r = 0; r <= 4; ++r) {
    for (int c = 0; c <= 4; ++c) {
      const int row = cell.row + r * quarter;
      const int column = cell.column + c * quarter;
      if ((r % 2 == 0 && c % 2 == 0) || row == 0) continue;
      const int node = NodeAt(row, column);
      const Eigen::Array3d guess = InterpolateLog(
          cell, {static_cast<double>(row), static_cast<double>(column)});
      for (int k = 0; k < 3; ++k) sum += std::abs(guess[k] - NodeLog(node, k));
      count += 3;
    }
  }
  return sum / count;
}

bool NormalGrid::WorthCutting(const Cell& cell, double tolerance) {
  double error = cell.error;
  int depth = cell.depth;
  for (size_t count = cell.points.size();
       count >= kWorthCutting && depth < kMaxDepth; count /= 4) {
    error /= kGain;
    ++depth;
    if (error <= tolerance) return true;
  }
  return false;
}

void NormalGrid::Cut(const Fitted& fitted, size_t index, double error) {
  cells_[index].leaf = false;
  const Cell whole = std::move(cells_[index]);
  const int half = whole.steps() / 2;
  Cell parts[4];
  for (int k = 0; k < 4; ++k) {
    parts[k] = {whole.row + (k >> 1) * half,
                whole.column + (k & 1) * half,
                whole.depth + 1,
                error,
                {}};
  }
  for (const int i : whole.points) {
    const int k = (fitted.places[i].row >= whole.row + half ? 2 : 0) +
                  (fitted.places[i].column >= whole.column + half ? 1 : 0);
    parts[k].points.push_back(i);
  }
  for (Cell& part : parts) {
    if (!part.points.empty()) cells_.push_back(std::move(part));
  }
}

bool NormalGrid::Refine(const Fitted& fitted, double tolerance) {
  for (;;) {
    std::vector<size_t> to_cut;
    for (size_t k = 0; k < cells_.size(); ++k) {
      const Cell& cell = cells_[k];
      if (!cell.leaf || cell.error <= tolerance) continue;
      if (WorthCutting(cell, tolerance)) to_cut.push_back(k);
    }
    if (to_cut.empty()) return true;
    for (const size_t k : to_cut) AskForParts(cells_[k]);
    if (!RenderNodes(fitted.progress)) return false;
    for (const size_t k : to_cut) Cut(fitted, k, ErrorAtParts(cells_[k]));
  }
}

bool NormalGrid::RenderHeldOut(const Fitted& fitted) {
  const size_t count = fitted.points.size();
  const size_t tests =
      std::min(count, static_cast<size_t>(std::max(options_.held_out, 1)));
  held_out_.place.assign(count, -1);
  std::vector<ShadingPoint> points;
  for (size_t k = 0; k < tests; ++k) {
    const size_t i = (2 * k + 1) * count / (2 * tests);
    held_out_.index.push_back(static_cast<int>(i));
    held_out_.place[i] = static_cast<int>(k);
    points.push_back(fitted.points[i]);
  }
  held_out_.truth.resize(3 * tests);
  report_.rendered = static_cast<int>(tests);
  return renderer_.Render(points, fitted.progress, held_out_.truth.data());
}

bool NormalGrid::MakeCells(const Fitted& fitted) {
  if (fitted.points.size() <
      held_out_.index.size() + size_t{kRows} * kColumns * kWorthCutting) {
    return true;
  }
  std::vector<std::vector<int>> first(size_t{kRows} * kColumns);
  for (size_t i = 0; i < fitted.points.size(); ++i) {
    const Place& place = fitted.places[i];
    const int r = std::min(static_cast<int>(place.row / kCellSteps), kRows - 1);
    const int c =
        std::min(static_cast<int>(place.column / kCellSteps), kColumns - 1);
    first[size_t{kColumns} * r + c].push_back(static_cast<int>(i));
  }
  for (int k = 0; k < kRows * kColumns; ++k) {
    if (first[k].empty()) continue;
    // The error of a first cell is not known: as if a cut would just do.
    cells_.push_back({k / kColumns * kCellSteps, k % kColumns * kCellSteps, 0,
                      0.0, std::move(first[k])});
    AskForParts(cells_.back());
  }
  if (!RenderNodes(fitted.progress)) return false;
  FindDark();
  for (size_t k = 0, end = cells_.size(); k < end; ++k) {
    Cut(fitted, k, ErrorAtParts(cells_[k]));
  }
  return true;
}

bool NormalGrid::FindTolerance(const Fitted& fitted) {
  double tried = kFirstTolerance * options_.log_error;
  for (int round = 0; !cells_.empty() && round < kRounds; ++round) {
    if (!Refine(fitted, tried)) return false;
    MeasureError(fitted, tried);
    if (report_.log_error + 2.0 * report_.standard_error <=
        options_.log_error) {
      tolerance_ = tried;
      return true;
    }
    tried /= 2.0;
  }
  return true;
}

void NormalGrid::MeasureError(const Fitted& fitted, double tolerance) {
  double sum = 0.0, squares = 0.0;
  for (const Cell& cell : cells_) {
    if (!IsGood(cell, tolerance)) continue;
    for (const int i : cell.points) {
      if (held_out_.place[i] < 0) continue;
      const Eigen::Array3d guess = InterpolateLog(cell, fitted.places[i]);
      double error = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double truth = held_out_.truth[3 * held_out_.place[i] + c];
        error += std::abs(guess[c] - Log(truth, c)) / 3.0;
      }
      sum += error;
      squares += error * error;
    }
  }
  const auto n = static_cast<double>(held_out_.index.size());
  report_.log_error = sum / n;
  report_.standard_error =
      std::sqrt(std::max(squares / n - std::pow(sum / n, 2), 0.0) / n);
}

void NormalGrid::FindGoodCells() {
  for (size_t k = 0; k < cells_.size(); ++k) {
    const Cell& cell = cells_[k];
    if (!IsGood(cell, tolerance_)) continue;
    good_[CellKey(cell.row, cell.column, cell.depth)] = k;
  }
}

const NormalGrid::Cell* NormalGrid::GoodCell(const Place& place) const {
  const int row = std::min(static_cast<int>(place.row), kRows * kCellSteps - 1);
  const int column =
      std::min(static_cast<int>(place.column), kFinestColumns - 1);
  for (int depth = 0; depth <= kMaxDepth; ++depth) {
    const int steps = kCellSteps >> depth;
    const auto it =
        good_.find(CellKey(row / steps * steps, column / steps * steps, depth));
    if (it != good_.end()) return &cells_[it->second];
  }
  return nullptr;
}

bool NormalGrid::Fit(const std::vector<ShadingPoint>& points,
                     const RadianceRenderer::Progress& progress) {
  Fitted fitted = {points, progress, {}};
  fitted.places.reserve(points.size());
  for (const ShadingPoint& p : points) fitted.places.push_back(PlaceOf(p));
  if (!RenderHeldOut(fitted) || !MakeCells(fitted) || !FindTolerance(fitted)) {
    return false;
  }
  FindGoodCells();
  report_.nodes = static_cast<int>(nodes_.size());
  report_.rendered += report_.nodes;
  if (good_.empty()) report_.log_error = report_.standard_error = 0.0;
  return true;
}

bool NormalGrid::RenderRest(const std::vector<ShadingPoint>& points,
                            const std::vector<char>& done,
                            const RadianceRenderer::Progress& progress,
                            double* L_o, ReflectanceMapReport* report) const {
  std::vector<size_t> direct;
  std::vector<ShadingPoint> rest;
  for (size_t i = 0; i < points.size(); ++i) {
    if (done[i] != 0) continue;
    const Place place = PlaceOf(points[i]);
    if (const Cell* cell = GoodCell(place)) {
      Interpolate(*cell, place, &L_o[3 * i]);
      ++report->interpolated;
      continue;
    }
    direct.push_back(i);
    rest.push_back(points[i]);
  }
  std::vector<double> radiance(3 * rest.size());
  if (!rest.empty() && !renderer_.Render(rest, progress, radiance.data())) {
    return false;
  }
  for (size_t k = 0; k < rest.size(); ++k) {
    std::copy_n(&radiance[3 * k], 3, &L_o[3 * direct[k]]);
  }
  report->rendered += static_cast<int>(rest.size());
  return true;
}

bool NormalGrid::RenderFitted(const std::vector<ShadingPoint>& points,
                              const RadianceRenderer::Progress& progress,
                              double* L_o) {
  std::vector<char> done(points.size(), 0);
  for (size_t k = 0; k < held_out_.index.size(); ++k) {
    const size_t i = held_out_.index[k];
    std::copy_n(&held_out_.truth[3 * k], 3, &L_o[3 * i]);
    done[i] = 1;
  }
  return RenderRest(points, done, progress, L_o, &report_);
}

bool NormalGrid::RenderAny(const std::vector<ShadingPoint>& points,
                           const RadianceRenderer::Progress& progress,
                           double* L_o) const {
  ReflectanceMapReport not_kept;
  return RenderRest(points, std::vector<char>(points.size(), 0), progress, L_o,
                    &not_kept);
}

}  // namespace ibrdf
