// Codes and colours of several lobes fitted to a measured table: what the
// embedding can represent.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

struct TableColumns;

struct LobeTableFitOptions {
  int lobes = 2;            // of the flow
  bool lambertian = false;  // a Lambertian lobe beside them
  int starts = 4;           // combinations of embedding codes that are refined
  int max_iterations = 60;
  // Relative decrease of the cost to stop at, and the stiffness of the wall at
  // the unit ball: a stiffer one holds up steps along it. A stiff wall and a
  // tolerance of 1e-4 score 0.1286 in place of 0.1263 (docs/notes,
  // reflectance_model).
  double tolerance = 1e-6;
  double wall = 60.0;
  // The prior of the codes is z ~ N(0, sigma^2), weighed against the table as
  // if it were this many independent measurements.
  double prior_sigma = 2.0;
  double independent_bins = 2000.0;
  int num_threads = 0;  // <= 0: all

  // kInvalidInput names the first option that is out of range.
  Status Check() const;
};

struct LobeTableFit {
  // As LobeModel's: per lobe the code, then log colours in raw units. Of a
  // table that has no matte part the Lambertian lobe's stay where the lobe is a
  // few per cent of the darkest bins: further down they would mean nothing.
  std::vector<double> parameters;
  double log_rmse = 0.0;  // over the bins that the fit saw
};

// The flow of a model with its embedding tabulated once, for fits to many
// tables. Fit() may be called from several threads.
class LobeTableFitter {
 public:
  // `model` is copied; it needs at least one code.
  explicit LobeTableFitter(const NeuralBrdfModel& model);

  // Least squares of log(f + 1e-6) - log(raw + 1e-6) (the log-RMSE of
  // CompareBrdfs) over columns of the table, by Levenberg-Marquardt from the
  // best combinations of embedding codes; lobes are added one by one. Bins of
  // negative raw values play no part. Codes stay in the unit ball. Fails on a
  // table without a positive red value and on non-finite values; the message
  // starts with "table".
  StatusOr<LobeTableFit> Fit(const MerlTable& table,
                             const LobeTableFitOptions& options) const;

  // The same from lobes that the caller knows to be near, of any number.
  StatusOr<LobeTableFit> FitFrom(const MerlTable& table,
                                 std::vector<double> parameters,
                                 const LobeTableFitOptions& options) const;

  // log(f + 1e-6) of lobes, raw units, at the bins that a fit sees, [3][bins]:
  // some thousands, each as likely to be among them as any other of a table.
  // They are the same of every model.
  std::vector<float> LogValues(const std::vector<double>& parameters,
                               const LobeTableFitOptions& options) const;

  // As FitFrom to a table with these LogValues.
  StatusOr<LobeTableFit> FitLogValues(std::vector<float> log_values,
                                      std::vector<double> parameters,
                                      const LobeTableFitOptions& options) const;

  // A Lambertian lobe beside the lobes of a table's fit without one, all of
  // them refined from there: near the same lobes of the flow, where Fit with
  // `lambertian` may find others that fit better.
  StatusOr<LobeTableFit> AddLambertian(
      const MerlTable& table, const LobeTableFit& fit,
      const LobeTableFitOptions& options) const;

  const NeuralBrdfModel& model() const { return model_; }

 private:
  class Search;
  struct Start {
    std::vector<double> parameters;  // empty where no cost is finite
    double cost = 0.0;
  };
  StatusOr<LobeTableFit> FitTo(const TableColumns& columns,
                               std::vector<double> parameters,
                               const LobeTableFitOptions& options) const;
  // What a fit sees of a table; refuses values that are not finite.
  StatusOr<TableColumns> ColumnsOf(const MerlTable& table) const;
  // Lobes of the flow added one by one to `base`, which may be empty, at the
  // few columns of the search.
  Start AddLobes(std::vector<double> base, const TableColumns& rough,
                 const Search& search,
                 const LobeTableFitOptions& options) const;
  // Refines a start at all columns of the fit.
  void Finish(const TableColumns& columns, const LobeTableFitOptions& options,
              Start* start) const;
  // The same with a faint Lambertian lobe beside the start's.
  void FinishWithLambertian(const TableColumns& columns,
                            const LobeTableFitOptions& options,
                            Start* start) const;
  LobeTableFit FitOf(const TableColumns& columns,
                     const LobeTableFitOptions& options,
                     std::vector<double> parameters) const;
  // Levenberg-Marquardt in place; returns the cost, infinite where it failed.
  double Refine(const TableColumns& columns, int iterations,
                const LobeTableFitOptions& options,
                std::vector<double>* parameters) const;
  // As many lobes as the parameters make.
  LobeLayout LayoutOf(const std::vector<double>& parameters) const;

  // Of lobes at the columns, [3][points].
  std::vector<double> Residuals(const TableColumns& columns,
                                const std::vector<double>& parameters,
                                const LobeTableFitOptions& options) const;
  // Root mean square of the residuals over the columns.
  double LogRmse(const TableColumns& columns,
                 const std::vector<double>& parameters,
                 const LobeTableFitOptions& options) const;

  NeuralBrdfModel model_;
  std::unique_ptr<BrdfFlow> flow_;
  std::vector<int> search_columns_, fit_columns_;
  FlowColumns search_points_;
  std::vector<float> embedding_;  // log q [codes][search points]
};

}  // namespace ibrdf
