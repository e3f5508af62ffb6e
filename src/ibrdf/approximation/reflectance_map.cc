#include "ibrdf/approximation/reflectance_map.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>
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

// Angle to the view in units of its largest, and turns around it.
struct Place {
  double row, column;  // in steps of the finest nodes
};

struct Cell {
  int row, column;  // first node
  int depth;
  double error;  // expected, nats
  std::vector<int> points;
  bool leaf = true;

  int steps() const { return kCellSteps >> depth; }
};

class NormalGrid {
 public:
  NormalGrid(const std::vector<ShadingPoint>& points,
             const RadianceRenderer& renderer,
             const RadianceRenderer::Progress& progress,
             const ReflectanceMapOptions& options)
      : points_(points),
        renderer_(renderer),
        progress_(progress),
        options_(options) {
    wo_ = points[0].wo.cast<double>().normalized();
    t_ = wo_.unitOrthogonal();
    b_ = wo_.cross(t_);
    places_.reserve(points.size());
    for (const ShadingPoint& p : points) places_.push_back(PlaceOf(p));
  }

  // False: the renderer stopped.
  bool Render(double* L_o);
  const ReflectanceMapReport& report() const { return report_; }

 private:
  // Points of the image that are rendered in any case: the error is measured
  // there.
  struct HeldOut {
    std::vector<int> index;     // into points_
    std::vector<int> place;     // of each of points_ in index; -1: not held out
    std::vector<double> truth;  // [index, 3]
  };

  // The steps of Render, in order; those that may stop return false.
  bool RenderHeldOut(HeldOut* held_out);
  // Cuts the visible normals for the first time, where that may pay, and each
  // cell into its parts.
  bool MakeCells(size_t num_held_out);
  // Cuts cells until the error at held-out points, of those whose cells meet
  // the tolerance, is within the requested one. Sets the tolerance; 0: it was
  // never within, and nothing may be interpolated.
  bool FindTolerance(const HeldOut& held_out, double* tolerance);
  void MeasureError(const HeldOut& held_out, double tolerance);
  void InterpolateCells(double tolerance, double* L_o);
  bool RenderRest(double* L_o);
  bool IsGood(const Cell& cell, double tolerance) const {
    return cell.leaf && !(cell.error > tolerance);
  }
  bool RenderPoints(const std::vector<ShadingPoint>& points, double* L_o) {
    return renderer_.Render(points, progress_, L_o);
  }

  Place PlaceOf(const ShadingPoint& point) const {
    const Eigen::Vector3d n = point.normal.cast<double>();
    const double x = n.dot(t_), y = n.dot(b_);
    const double theta = std::atan2(std::hypot(x, y), n.dot(wo_));
    double turn = std::atan2(y, x) / (2.0 * kPi);
    if (turn < 0.0) turn += 1.0;
    return {std::clamp(theta / MaxTheta(), 0.0, 1.0) * kRows * kCellSteps,
            std::min(turn, 1.0) * kFinestColumns};
  }
  static double MaxTheta() { return std::acos(double{kMinViewCosine}); }

  // A slot of values_; nodes asked for since the last call of RenderNodes()
  // have no values yet.
  int Node(int row, int column) {
    // One node stands for all turns around the view.
    const int c = row == 0 ? 0 : column % kFinestColumns;
    const int key = row * kFinestColumns + c;
    const auto [it, is_new] =
        nodes_.try_emplace(key, static_cast<int>(nodes_.size()));
    if (is_new) {
      const double theta = MaxTheta() * row / (kRows * kCellSteps);
      const double phi = 2.0 * kPi * c / kFinestColumns;
      ShadingPoint p = points_[0];
      p.normal = (std::sin(theta) * (std::cos(phi) * t_ + std::sin(phi) * b_) +
                  std::cos(theta) * wo_)
                     .cast<float>();
      waiting_.push_back(p);
    }
    return it->second;
  }

  bool RenderNodes() {
    if (waiting_.empty()) return true;
    const size_t first = radiance_.size();
    radiance_.resize(first + 3 * waiting_.size());
    const bool go_on = RenderPoints(waiting_, &radiance_[first]);
    waiting_.clear();
    return go_on;
  }

  double Log(double radiance, int channel) const {
    return std::log(std::max(radiance, 0.0) + dark_[channel]);
  }
  double NodeLog(int node, int channel) const {
    return Log(radiance_[size_t{3} * node + channel], channel);
  }

  // Sets dark_ from the nodes of the first cut. False: all radiance is zero.
  void FindDark();
  // Log radiance of a cell's quadratic.
  Eigen::Array3d Interpolate(const Cell& cell, const Place& place);
  // Asks for the nodes of the four parts of a cell.
  void AskForParts(const Cell& cell);
  // Error of a cell at the new nodes of its parts, mean of nodes and channels.
  double ErrorAtParts(const Cell& cell);
  void Cut(size_t cell, double error);
  // Whether cells of that error, cut as often as their points allow, are likely
  // to meet the tolerance.
  static bool WorthCutting(const Cell& cell, double tolerance) {
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
  // Cuts cells until all meet the tolerance or are not worth it.
  bool Refine(double tolerance);

  const std::vector<ShadingPoint>& points_;
  const RadianceRenderer& renderer_;
  const RadianceRenderer::Progress& progress_;
  const ReflectanceMapOptions& options_;
  Eigen::Vector3d wo_, t_, b_;
  std::vector<Place> places_;
  std::unordered_map<int, int> nodes_;
  std::vector<ShadingPoint> waiting_;
  std::vector<double> radiance_;  // [node, 3]
  Eigen::Array3d dark_ = Eigen::Array3d::Ones();
  std::vector<Cell> cells_;
  std::vector<char> done_;  // [points]
  ReflectanceMapReport report_;
};

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

Eigen::Array3d NormalGrid::Interpolate(const Cell& cell, const Place& place) {
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
      const int node = Node(cell.row + r * half, cell.column + k * half);
      for (int c = 0; c < 3; ++c) sum[c] += wr[r] * wc[k] * NodeLog(node, c);
    }
  }
  return sum;
}

void NormalGrid::AskForParts(const Cell& cell) {
  const int quarter = cell.steps() / 4;
  for (int r = 0; r <= 4; ++r) {
    for (int c = 0; c <= 4; ++c) {
      Node(cell.row + r * quarter, cell.column + c * quarter);
    }
  }
}

double NormalGrid::ErrorAtParts(const Cell& cell) {
  const int quarter = cell.steps() / 4;
  double sum = 0.0;
  int count = 0;
  for (int r = 0; r <= 4; ++r) {
    for (int c = 0; c <= 4; ++c) {
      const int row = cell.row + r * quarter;
      const int column = cell.column + c * quarter;
      if ((r % 2 == 0 && c % 2 == 0) || row == 0) continue;
      const int node = Node(row, column);
      const Eigen::Array3d guess = Interpolate(
          cell, {static_cast<double>(row), static_cast<double>(column)});
      for (int k = 0; k < 3; ++k) sum += std::abs(guess[k] - NodeLog(node, k));
      count += 3;
    }
  }
  return sum / count;
}

void NormalGrid::Cut(size_t index, double error) {
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
    const int k = (places_[i].row >= whole.row + half ? 2 : 0) +
                  (places_[i].column >= whole.column + half ? 1 : 0);
    parts[k].points.push_back(i);
  }
  for (Cell& part : parts) {
    if (!part.points.empty()) cells_.push_back(std::move(part));
  }
}

bool NormalGrid::Refine(double tolerance) {
  for (;;) {
    std::vector<size_t> to_cut;
    for (size_t k = 0; k < cells_.size(); ++k) {
      const Cell& cell = cells_[k];
      if (!cell.leaf || cell.error <= tolerance) continue;
      if (WorthCutting(cell, tolerance)) to_cut.push_back(k);
    }
    if (to_cut.empty()) return true;
    for (const size_t k : to_cut) AskForParts(cells_[k]);
    if (!RenderNodes()) return false;
    for (const size_t k : to_cut) Cut(k, ErrorAtParts(cells_[k]));
  }
}

bool NormalGrid::RenderHeldOut(HeldOut* held_out) {
  const size_t count = points_.size();
  const size_t tests =
      std::min(count, static_cast<size_t>(std::max(options_.held_out, 1)));
  held_out->place.assign(count, -1);
  std::vector<ShadingPoint> points;
  for (size_t k = 0; k < tests; ++k) {
    const size_t i = (2 * k + 1) * count / (2 * tests);
    held_out->index.push_back(static_cast<int>(i));
    held_out->place[i] = static_cast<int>(k);
    points.push_back(points_[i]);
  }
  held_out->truth.resize(3 * tests);
  report_.rendered = static_cast<int>(tests);
  return RenderPoints(points, held_out->truth.data());
}

bool NormalGrid::MakeCells(size_t num_held_out) {
  if (points_.size() <
      num_held_out + size_t{kRows} * kColumns * kWorthCutting) {
    return true;
  }
  std::vector<std::vector<int>> first(size_t{kRows} * kColumns);
  for (size_t i = 0; i < points_.size(); ++i) {
    const int r =
        std::min(static_cast<int>(places_[i].row / kCellSteps), kRows - 1);
    const int c = std::min(static_cast<int>(places_[i].column / kCellSteps),
                           kColumns - 1);
    first[size_t{kColumns} * r + c].push_back(static_cast<int>(i));
  }
  for (int k = 0; k < kRows * kColumns; ++k) {
    if (first[k].empty()) continue;
    // The error of a first cell is not known: as if a cut would just do.
    cells_.push_back({k / kColumns * kCellSteps, k % kColumns * kCellSteps, 0,
                      0.0, std::move(first[k])});
    AskForParts(cells_.back());
  }
  if (!RenderNodes()) return false;
  FindDark();
  for (size_t k = 0, end = cells_.size(); k < end; ++k) {
    Cut(k, ErrorAtParts(cells_[k]));
  }
  return true;
}

bool NormalGrid::FindTolerance(const HeldOut& held_out, double* tolerance) {
  double tried = kFirstTolerance * options_.log_error;
  for (int round = 0; !cells_.empty() && round < kRounds; ++round) {
    if (!Refine(tried)) return false;
    MeasureError(held_out, tried);
    if (report_.log_error + 2.0 * report_.standard_error <=
        options_.log_error) {
      *tolerance = tried;
      return true;
    }
    tried /= 2.0;
  }
  *tolerance = 0.0;
  return true;
}

void NormalGrid::MeasureError(const HeldOut& held_out, double tolerance) {
  double sum = 0.0, squares = 0.0;
  for (const Cell& cell : cells_) {
    if (!IsGood(cell, tolerance)) continue;
    for (const int i : cell.points) {
      if (held_out.place[i] < 0) continue;
      const Eigen::Array3d guess = Interpolate(cell, places_[i]);
      double error = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double truth = held_out.truth[3 * held_out.place[i] + c];
        error += std::abs(guess[c] - Log(truth, c)) / 3.0;
      }
      sum += error;
      squares += error * error;
    }
  }
  const auto n = static_cast<double>(held_out.index.size());
  report_.log_error = sum / n;
  report_.standard_error =
      std::sqrt(std::max(squares / n - std::pow(sum / n, 2), 0.0) / n);
}

void NormalGrid::InterpolateCells(double tolerance, double* L_o) {
  for (const Cell& cell : cells_) {
    if (tolerance == 0.0 || !IsGood(cell, tolerance)) continue;
    for (const int i : cell.points) {
      if (done_[i] != 0) continue;
      const Eigen::Array3d log_radiance = Interpolate(cell, places_[i]);
      for (int c = 0; c < 3; ++c) {
        L_o[size_t{3} * i + c] =
            std::max(std::exp(log_radiance[c]) - dark_[c], 0.0);
      }
      done_[i] = 1;
      ++report_.interpolated;
    }
  }
  if (report_.interpolated == 0) {
    report_.log_error = report_.standard_error = 0.0;
  }
}

bool NormalGrid::RenderRest(double* L_o) {
  std::vector<int> direct;
  std::vector<ShadingPoint> rest;
  for (size_t i = 0; i < points_.size(); ++i) {
    if (done_[i] != 0) continue;
    direct.push_back(static_cast<int>(i));
    rest.push_back(points_[i]);
  }
  std::vector<double> rendered(3 * rest.size());
  if (!rest.empty() && !RenderPoints(rest, rendered.data())) return false;
  for (size_t k = 0; k < rest.size(); ++k) {
    std::copy_n(&rendered[3 * k], 3, &L_o[size_t{3} * direct[k]]);
  }
  report_.rendered += static_cast<int>(rest.size());
  return true;
}

bool NormalGrid::Render(double* L_o) {
  HeldOut held_out;
  double tolerance = 0.0;
  if (!RenderHeldOut(&held_out) || !MakeCells(held_out.index.size()) ||
      !FindTolerance(held_out, &tolerance)) {
    return false;
  }
  done_.assign(points_.size(), 0);
  for (size_t k = 0; k < held_out.index.size(); ++k) {
    std::copy_n(&held_out.truth[3 * k], 3, &L_o[size_t{3} * held_out.index[k]]);
    done_[held_out.index[k]] = 1;
  }
  InterpolateCells(tolerance, L_o);
  report_.nodes = static_cast<int>(nodes_.size());
  report_.rendered += report_.nodes;
  return RenderRest(L_o);
}

}  // namespace

StatusOr<ReflectanceMapReport> RenderByNormal(
    const std::vector<ShadingPoint>& points, const RadianceRenderer& renderer,
    const RadianceRenderer::Progress& progress,
    const ReflectanceMapOptions& options, double* L_o) {
  CHECK_GT(options.log_error, 0.0);
  if (points.empty()) return ReflectanceMapReport();
  for (const ShadingPoint& p : points) {
    if (p.wo != points[0].wo) {
      return InvalidInput("reflectance map",
                          "expected one view direction for all points (an "
                          "orthographic camera)");
    }
  }
  NormalGrid grid(points, renderer, progress, options);
  if (!grid.Render(L_o)) return Status(StatusCode::kInterrupted, "interrupted");
  return grid.report();
}

}  // namespace ibrdf
