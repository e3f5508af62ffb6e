#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "ibrdf/solvers/costs/log_table_cost.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "ibrdf/solvers/table_fit/table_columns.h"

namespace ibrdf {
namespace {

constexpr int kSearchColumns = 64, kSearchPoints = 12;
constexpr int kFitColumns = 128, kFitPoints = 24;
constexpr uint64_t kColumnSeed = 17;
constexpr int kRoughIterations = 20;
constexpr double kFreeColours = 1e3;  // standard deviation of log colours: none
// Log colours tried for a further lobe, relative to the one that would make it
// fit alone, go down to this.
constexpr double kFaintest = -5.0;
// A Lambertian lobe starts at this share of the table's values in order, and
// is held there by a Gaussian of its log colours: a table without a matte part
// would drive them to minus infinity. The deviation leaves it less than a
// twentieth of the darkest tenth of the bins.
constexpr double kDarkShare = 0.1;
constexpr double kLambertianDeviation = 5.0;
// Beside a finished fit it starts so much fainter, and hardly spoils it.
constexpr double kFaintLambertian = -2.0;

// Which theta_h of a column of `count` stands for stratum i of n.
int Stratum(int i, int n, int count) {
  return std::min(count - 1, static_cast<int>((i + 0.5) * count / n));
}

FlowColumns ThinColumns(const std::vector<int>& columns, int points) {
  const TrainingData all = ColumnsOfTable(columns);
  const int n = all.num_columns();
  FlowColumns thin(n, points);
  for (int c = 0; c < n; ++c) {
    thin.CopyColumn(c, all.columns, c);
    for (int i = 0; i < points; ++i) {
      const int at = Stratum(i, points, all.count[c]);
      thin.x_h[i * n + c] = all.columns.x_h[at * n + c];
    }
  }
  return thin;
}

// The measured ones of channel c's log raw values, of [channels][n].
std::vector<float> Measured(const std::vector<float>& log_raw, int c,
                            int channels = 3) {
  const size_t n = log_raw.size() / channels;
  std::vector<float> values;
  std::copy_if(log_raw.begin() + c * n, log_raw.begin() + (c + 1) * n,
               std::back_inserter(values),
               [](float v) { return v != kNotMeasured; });
  return values;
}

// log raw [3][points][columns] of the same bins.
StatusOr<std::vector<float>> ThinTable(const MerlTable& table,
                                       const std::vector<int>& columns,
                                       int points) {
  TrainingData all = ColumnsOfTable(columns);
  AddTable(table, columns, "table", &all);
  const int n = all.num_columns();
  std::vector<float> log_raw;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < points; ++i) {
      for (int k = 0; k < n; ++k) {
        const float v = all.LogRaw(c, k)[Stratum(i, points, all.count[k])];
        if (!std::isfinite(v) && v != kNotMeasured) {
          return InvalidInput("table", "expected finite values");
        }
        log_raw.push_back(v);
      }
    }
    if (Measured(log_raw, c, c + 1).empty()) {
      return InvalidInput("table", "expected more bins that have values");
    }
  }
  return log_raw;
}

// Puts codes beyond the unit ball on its sphere.
void ProjectCodes(const LobeLayout& layout, std::vector<double>* parameters) {
  const MutableLobeMixture mixture(layout, parameters->data());
  for (int k = 0; k < layout.num_coded(); ++k) {
    // As ClampCodes, but the squares are summed in their order: the bits of
    // trained models.
    const auto z = mixture.code(k);
    const double norm =
        std::sqrt(std::inner_product(z.begin(), z.end(), z.begin(), 0.0));
    for (double& value : mixture.code(k)) value /= std::max(norm, 1.0);
  }
}

double CountMeasured(const std::vector<float>& log_raw) {
  return static_cast<double>(log_raw.size() - std::count(log_raw.begin(),
                                                         log_raw.end(),
                                                         kNotMeasured));
}

// The log colours at which a Lambertian lobe starts, for log raw values [3][n].
std::vector<double> DarkColours(const std::vector<float>& log_raw) {
  std::vector<double> colours;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> values = Measured(log_raw, c);
    const auto dark =
        values.begin() + static_cast<size_t>(kDarkShare * values.size());
    std::nth_element(values.begin(), dark, values.end());
    colours.push_back(*dark);
  }
  return colours;
}

// (a - mean) / kLambertianDeviation for the last log colours of a mixture.
ceres::CostFunction* HoldLambertian(const LobeLayout& layout,
                                    const std::vector<double>& mean) {
  const int n = layout.num_parameters();
  ceres::Matrix A = ceres::Matrix::Zero(3, n);
  A.rightCols(3).diagonal().setConstant(1.0 / kLambertianDeviation);
  ceres::Vector b = ceres::Vector::Zero(n);
  for (int c = 0; c < 3; ++c) b[n - 3 + c] = mean[c];
  return new ceres::NormalPrior(A, b);
}

}  // namespace

LobeTableFitter::LobeTableFitter(const NeuralBrdfModel& model)
    : model_(model), flow_(BrdfFlow::Create(model.shape, model.weights)) {
  CHECK_GE(model.num_codes(), 1);
  search_columns_ = DrawColumns(kSearchColumns, kColumnSeed);
  fit_columns_ = DrawColumns(kFitColumns, kColumnSeed + 1);
  search_points_ = ThinColumns(search_columns_, kSearchPoints);
  const size_t n = search_points_.num_points();
  embedding_.resize(n * model.num_codes());
  for (int m = 0; m < model.num_codes(); ++m) {
    flow_->LogDensityOnColumns(search_points_,
                               model.codes.data() + m * model.shape.code_size(),
                               0, embedding_.data() + m * n, nullptr);
  }
  for (float& v : embedding_) v *= static_cast<float>(model_.exponent);
}

// Starts from the embedding for one table.
class LobeTableFitter::Search {
 public:
  Search(const LobeTableFitter& fitter, std::vector<float> log_raw)
      : fitter_(fitter),
        log_raw_(std::move(log_raw)),
        n_(fitter.search_points_.num_points()),
        codes_(fitter.model_.num_codes()) {}

  // The `count` best starts with one lobe of the flow more than `base` (which
  // may be empty), no two with the same new material.
  std::vector<std::vector<double>> Extend(const std::vector<double>& base,
                                          int count) const {
    const LobeLayout of_base = fitter_.LayoutOf(base);
    const LobeLayout layout = {of_base.num_lobes + 1, of_base.code_size,
                               of_base.lambertian};
    const int added = of_base.num_coded();
    const std::vector<float> log_base = LogSum(base);
    std::vector<std::pair<double, int>> order;
    std::vector<Eigen::Array3d> colours(codes_);
    for (int m = 0; m < codes_; ++m) {
      double score = 0.0;
      for (int c = 0; c < 3; ++c) {
        const auto [colour, error] = BestColour(log_base, m, c);
        colours[m][c] = colour;
        score += error;
      }
      order.emplace_back(score, m);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::vector<double>> starts;
    std::vector<std::string> taken;
    for (const auto& [score, m] : order) {
      const std::string& name = fitter_.model_.names[m];
      const std::string material = name.substr(0, name.rfind('.'));
      if (std::find(taken.begin(), taken.end(), material) != taken.end()) {
        continue;
      }
      taken.push_back(material);
      std::vector<double> start = base;
      start.insert(start.begin() + of_base.code(added), layout.lobe_size(),
                   0.0);
      const MutableLobeMixture lobes(layout, start.data());
      lobes.code(added) =
          Eigen::Map<const Eigen::VectorXf>(
              fitter_.model_.codes.data() + m * layout.code_size,
              layout.code_size)
              .cast<double>();
      lobes.log_colour(added) = colours[m];
      starts.push_back(start);
      if (static_cast<int>(starts.size()) == count) break;
    }
    return starts;
  }

 private:
  // log of the sum of lobes [3][n]; -inf where there are none.
  std::vector<float> LogSum(const std::vector<double>& parameters) const {
    std::vector<float> sum(3 * n_, -std::numeric_limits<float>::infinity());
    const LobeMixture lobes(fitter_.LayoutOf(parameters), parameters.data());
    std::vector<float> value(n_);
    for (int k = 0; k < lobes.num_lobes(); ++k) {
      if (k < lobes.layout().num_coded()) {
        const Eigen::VectorXf code = lobes.code(k).cast<float>();
        fitter_.flow_->LogDensityOnColumns(fitter_.search_points_, code.data(),
                                           1, value.data(), nullptr);
      } else {
        std::fill(value.begin(), value.end(), 0.0f);
      }
      for (int c = 0; c < 3; ++c) {
        for (size_t i = 0; i < n_; ++i) {
          const double v =
              lobes.log_colour(k)[c] + fitter_.model_.exponent * value[i];
          float& s = sum[c * n_ + i];
          const double top = std::max<double>(s, v);
          s = static_cast<float>(
              top + std::log(std::exp(s - top) + std::exp(v - top)));
        }
      }
    }
    return sum;
  }

  struct Colour {
    double log_colour, error;
  };

  // Log colour of code m beside the base, and the squared error it leaves in
  // channel c. Alone: the mean. Beside others: the best of a ladder.
  Colour BestColour(const std::vector<float>& base, int m, int c) const {
    const float* q = fitter_.embedding_.data() + m * n_;
    const float* target = log_raw_.data() + c * n_;
    const float* b = base.data() + c * n_;
    double mean = 0.0, measured = 0.0;
    for (size_t i = 0; i < n_; ++i) {
      if (target[i] == kNotMeasured) continue;
      mean += target[i] - q[i];
      measured += 1.0;
    }
    mean /= measured;
    if (std::isinf(b[0])) {
      double error = 0.0;
      for (size_t i = 0; i < n_; ++i) {
        if (target[i] == kNotMeasured) continue;
        const double r = mean + q[i] - target[i];
        error += r * r;
      }
      return {mean, error};
    }
    Colour best{mean, std::numeric_limits<double>::infinity()};
    for (double shift = 1.0; shift >= kFaintest; shift -= 1.0) {
      double error = 0.0;
      for (size_t i = 0; i < n_; i += 2) {
        if (target[i] == kNotMeasured) continue;
        const double v = mean + shift + q[i];
        const double top = std::max<double>(b[i], v);
        const double r =
            top + std::log1p(std::exp(-std::abs(b[i] - v))) - target[i];
        error += r * r;
      }
      if (error < best.error) best = {mean + shift, error};
    }
    return best;
  }

  const LobeTableFitter& fitter_;
  const std::vector<float> log_raw_;  // [3][n]
  const size_t n_;
  const int codes_;
};

Status LobeTableFitOptions::Check() const {
  const auto fault = [](const std::string& field, const std::string& expected) {
    return InvalidInput("options of the fit: " + field, "expected " + expected);
  };
  if (lobes < 1) return fault("lobes", "at least 1");
  if (starts < 1) return fault("starts", "at least 1");
  if (max_iterations < 0) return fault("max_iterations", "at least 0");
  if (!(tolerance >= 0.0)) return fault("tolerance", "at least 0");
  if (!(wall >= 0.0)) return fault("wall", "at least 0");
  if (!(prior_sigma > 0.0)) return fault("prior_sigma", "more than 0");
  if (!(independent_bins > 0.0))
    return fault("independent_bins", "more than 0");
  return OkStatus();
}

StatusOr<TableColumns> LobeTableFitter::ColumnsOf(
    const MerlTable& table) const {
  StatusOr<std::vector<float>> log_raw =
      ThinTable(table, fit_columns_, kFitPoints);
  if (!log_raw.ok()) return log_raw.status();
  return TableColumns{ThinColumns(fit_columns_, kFitPoints),
                      *std::move(log_raw)};
}

StatusOr<LobeTableFit> LobeTableFitter::Fit(
    const MerlTable& table, const LobeTableFitOptions& options) const {
  IBRDF_RETURN_IF_ERROR(options.Check());
  const double* red = table.raw.data();
  if (std::none_of(red, red + kMerlBins, [](double v) { return v > 0.0; })) {
    return InvalidInput("table", "expected a positive red value");
  }
  StatusOr<std::vector<float>> seen =
      ThinTable(table, search_columns_, kSearchPoints);
  if (!seen.ok()) return seen.status();
  const StatusOr<TableColumns> columns = ColumnsOf(table);
  if (!columns.ok()) return columns.status();
  const TableColumns rough{search_points_, *seen};

  const Search search(*this, std::move(*seen));
  // All starts are refined roughly, the best one to the end.
  Start best = AddLobes({}, rough, search, options);
  if (best.parameters.empty()) {
    return InvalidInput("table", "no start of the fit has a finite cost");
  }
  Finish(*columns, options, &best);
  if (options.lambertian) {
    FinishWithLambertian(*columns, options, &best);
    // The lobe from the start leads to other lobes of the flow, often to better
    // ones.
    Start matte = AddLobes(DarkColours(rough.log_raw), rough, search, options);
    if (!matte.parameters.empty()) {
      Finish(*columns, options, &matte);
      if (matte.cost < best.cost) best = std::move(matte);
    }
  }
  return FitOf(*columns, options, std::move(best.parameters));
}

StatusOr<LobeTableFit> LobeTableFitter::FitFrom(
    const MerlTable& table, std::vector<double> parameters,
    const LobeTableFitOptions& options) const {
  IBRDF_RETURN_IF_ERROR(options.Check());
  const StatusOr<TableColumns> columns = ColumnsOf(table);
  if (!columns.ok()) return columns.status();
  return FitTo(*columns, std::move(parameters), options);
}

std::vector<float> LobeTableFitter::LogValues(
    const std::vector<double>& parameters,
    const LobeTableFitOptions& options) const {
  TableColumns columns{ThinColumns(fit_columns_, kFitPoints), {}};
  columns.log_raw.assign(3 * columns.points.num_points(), 0.0f);
  const std::vector<double> values = Residuals(columns, parameters, options);
  return {values.begin(), values.end()};
}

StatusOr<LobeTableFit> LobeTableFitter::FitLogValues(
    std::vector<float> log_values, std::vector<double> parameters,
    const LobeTableFitOptions& options) const {
  IBRDF_RETURN_IF_ERROR(options.Check());
  const TableColumns columns{ThinColumns(fit_columns_, kFitPoints),
                             std::move(log_values)};
  CHECK_EQ(columns.log_raw.size(), size_t{3} * columns.points.num_points());
  return FitTo(columns, std::move(parameters), options);
}

StatusOr<LobeTableFit> LobeTableFitter::FitTo(
    const TableColumns& columns, std::vector<double> parameters,
    const LobeTableFitOptions& options) const {
  Start start = {std::move(parameters), 0.0};
  Finish(columns, options, &start);
  if (!std::isfinite(start.cost)) {
    return Status(StatusCode::kNoImprovement, "no lobes near the start fit");
  }
  return FitOf(columns, options, std::move(start.parameters));
}

StatusOr<LobeTableFit> LobeTableFitter::AddLambertian(
    const MerlTable& table, const LobeTableFit& fit,
    const LobeTableFitOptions& options) const {
  IBRDF_RETURN_IF_ERROR(options.Check());
  const StatusOr<TableColumns> columns = ColumnsOf(table);
  if (!columns.ok()) return columns.status();
  Start start = {fit.parameters, fit.log_rmse};
  FinishWithLambertian(*columns, options, &start);
  return FitOf(*columns, options, std::move(start.parameters));
}

LobeTableFit LobeTableFitter::FitOf(const TableColumns& columns,
                                    const LobeTableFitOptions& options,
                                    std::vector<double> parameters) const {
  ProjectCodes(LayoutOf(parameters), &parameters);
  const double log_rmse = LogRmse(columns, parameters, options);
  return LobeTableFit{std::move(parameters), log_rmse};
}

void LobeTableFitter::Finish(const TableColumns& columns,
                             const LobeTableFitOptions& options,
                             Start* start) const {
  start->cost =
      Refine(columns, options.max_iterations, options, &start->parameters);
}

void LobeTableFitter::FinishWithLambertian(const TableColumns& columns,
                                           const LobeTableFitOptions& options,
                                           Start* start) const {
  for (const double colour : DarkColours(columns.log_raw)) {
    start->parameters.push_back(colour + kFaintLambertian);
  }
  Finish(columns, options, start);
}

LobeTableFitter::Start LobeTableFitter::AddLobes(
    std::vector<double> base, const TableColumns& rough, const Search& search,
    const LobeTableFitOptions& options) const {
  Start best = {std::move(base), 0.0};
  for (int lobes = 1; lobes <= options.lobes; ++lobes) {
    Start winner = {{}, std::numeric_limits<double>::infinity()};
    for (std::vector<double>& start :
         search.Extend(best.parameters, options.starts)) {
      const double cost = Refine(rough, kRoughIterations, options, &start);
      if (cost < winner.cost) winner = {start, cost};
    }
    if (winner.parameters.empty()) return winner;
    best = winner;
  }
  return best;
}

std::vector<double> LobeTableFitter::Residuals(
    const TableColumns& columns, const std::vector<double>& parameters,
    const LobeTableFitOptions& options) const {
  const LogTableCost cost(*flow_, LayoutOf(parameters), model_.exponent,
                          columns, kLogFloor, 1.0, options.num_threads);
  std::vector<double> residuals(columns.log_raw.size());
  const double* block = parameters.data();
  cost.Evaluate(&block, residuals.data(), nullptr);
  return residuals;
}

double LobeTableFitter::LogRmse(const TableColumns& columns,
                                const std::vector<double>& parameters,
                                const LobeTableFitOptions& options) const {
  const std::vector<double> residuals = Residuals(columns, parameters, options);
  const double square = std::inner_product(residuals.begin(), residuals.end(),
                                           residuals.begin(), 0.0);
  return std::sqrt(square / CountMeasured(columns.log_raw));
}

LobeLayout LobeTableFitter::LayoutOf(
    const std::vector<double>& parameters) const {
  return LobeLayout::OfSize(parameters.size(), model_.shape.code_size());
}

double LobeTableFitter::Refine(const TableColumns& columns, int iterations,
                               const LobeTableFitOptions& options,
                               std::vector<double>* parameters) const {
  const LobeLayout layout = LayoutOf(*parameters);
  LobePrior prior;
  prior.sigma = options.prior_sigma;
  prior.wall = options.wall;
  prior.colour_sigma = kFreeColours;
  ceres::Problem problem;
  problem.AddResidualBlock(
      new LogTableCost(
          *flow_, layout, model_.exponent, columns, kLogFloor,
          options.independent_bins / CountMeasured(columns.log_raw),
          options.num_threads),
      nullptr, parameters->data());
  problem.AddResidualBlock(new LobePriorCost(layout, prior), nullptr,
                           parameters->data());
  if (layout.lambertian) {
    problem.AddResidualBlock(
        HoldLambertian(layout, DarkColours(columns.log_raw)), nullptr,
        parameters->data());
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = iterations;
  solver.function_tolerance = options.tolerance;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.IsSolutionUsable() ? summary.final_cost
                                    : std::numeric_limits<double>::infinity();
}

}  // namespace ibrdf
