#include "ibrdf/solvers/bench/baseline_fitters.h"

#include <functional>
#include <utility>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/brdf/bivariate.h"
#include "ibrdf/solvers/baselines/dsbrdf_fit.h"
#include "ibrdf/solvers/baselines/table_fit.h"
#include "ibrdf/solvers/baselines/table_samples.h"

namespace ibrdf {
namespace {

using FitFunction =
    std::function<StatusOr<BrdfFunction>(const MerlTable&, uint64_t seed)>;

class BaselineFitter final : public TableFitter {
 public:
  BaselineFitter(std::string method, std::string lobes, bool depends_on_phi_d,
                 FitFunction fit)
      : method_(std::move(method)),
        lobes_(std::move(lobes)),
        depends_on_phi_d_(depends_on_phi_d),
        fit_(std::move(fit)) {}

  std::string method() const override { return method_; }
  std::string lobes() const override { return lobes_; }
  std::string model() const override { return ""; }

  // Takes seconds: not stopped.
  StatusOr<FittedTable> Fit(const MerlTable& table,
                            const TableFitContext& context) const override {
    const Stopwatch watch;
    const StatusOr<BrdfFunction> brdf = fit_(table, context.seed);
    if (!brdf.ok()) return brdf.status();
    const double seconds = watch.Seconds();
    return FittedTable{SampleBrdf(*brdf, depends_on_phi_d_, table), seconds};
  }

 private:
  const std::string method_, lobes_;
  const bool depends_on_phi_d_;
  const FitFunction fit_;
};

// The function of a model, or why there is none.
template <typename Model>
StatusOr<BrdfFunction> FunctionOf(const StatusOr<Model>& model) {
  if (!model.ok()) return model.status();
  return model->Function();
}

TableFitOptions OptionsOf(uint64_t seed) {
  TableFitOptions options;
  options.seed = seed;
  return options;
}

}  // namespace

TableFitters BaselineFitters(const std::vector<int>& dsbrdf_lobes) {
  TableFitters fitters;
  const auto add = [&](const std::string& method, const std::string& lobes,
                       bool depends_on_phi_d, FitFunction fit) {
    fitters.push_back(std::make_shared<BaselineFitter>(
        method, lobes, depends_on_phi_d, std::move(fit)));
  };
  add("bivariate", "", false, [](const MerlTable& table, uint64_t) {
    return FunctionOf(FitBivariate(table, BivariateMean::kGeometric));
  });
  add("bivariate_arithmetic", "", false, [](const MerlTable& table, uint64_t) {
    return FunctionOf(FitBivariate(table, BivariateMean::kArithmetic));
  });
  add("lambertian", "", false, [](const MerlTable& table, uint64_t) {
    return FunctionOf(FitLambertian(table));
  });
  add("cook_torrance", "1", true, [](const MerlTable& table, uint64_t seed) {
    return FunctionOf(FitCookTorranceToTable(table, OptionsOf(seed)));
  });
  add("disney", "1", true, [](const MerlTable& table, uint64_t seed) {
    return FunctionOf(FitDisney(table, OptionsOf(seed)));
  });
  for (const int lobes : dsbrdf_lobes) {
    add("dsbrdf", std::to_string(lobes), false,
        [lobes](const MerlTable& table, uint64_t) {
          DsbrdfFitOptions options;
          options.shape.lobes = lobes;
          return FunctionOf(FitDsbrdf(table, options));
        });
  }
  return fitters;
}

}  // namespace ibrdf
