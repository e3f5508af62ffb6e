#include "ibrdf/solvers/bench/neural_fitters.h"

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/training/flow_trainer.h"

namespace ibrdf {
namespace {

constexpr int kFreeColumns = 4096;

// The grid is not used.
constexpr BrdfGridShape kNoGrid{2, 2, 1};

class FlowTableFitter final : public TableFitter {
 public:
  FlowTableFitter(std::shared_ptr<const LobeTableFitter> fitter,
                  const std::string& model_name,
                  const LobeTableFitOptions& options)
      : fitter_(std::move(fitter)), name_(model_name), options_(options) {}

  std::string method() const override {
    return options_.lambertian ? "flow_lambertian" : "flow";
  }
  std::string lobes() const override { return std::to_string(options_.lobes); }
  std::string model() const override { return name_; }

  StatusOr<FittedTable> Fit(const MerlTable& table,
                            const TableFitContext& context) const override {
    const Stopwatch watch;
    LobeTableFitOptions options = options_;
    options.num_threads = context.num_threads;
    const StatusOr<LobeTableFit> fit = fitter_->Fit(table, options);
    if (!fit.ok()) return fit.status();
    FittedTable result;
    result.seconds = watch.Seconds();
    const FlowLobes lobes(
        fitter_->model(),
        LobeLayout::OfSize(fit->parameters.size(),
                           fitter_->model().shape.code_size()),
        kNoGrid, context.num_threads);
    result.table = lobes.ToMerl(fit->parameters.data());
    return result;
  }

 private:
  const std::shared_ptr<const LobeTableFitter> fitter_;
  const std::string name_;
  const LobeTableFitOptions options_;
};

class FreeFlowTableFitter final : public TableFitter {
 public:
  explicit FreeFlowTableFitter(const FreeFlowOptions& options)
      : options_(options) {}

  std::string method() const override { return "flow_free"; }
  std::string lobes() const override { return ""; }
  std::string model() const override { return ""; }

  StatusOr<FittedTable> Fit(const MerlTable& table,
                            const TableFitContext& context) const override {
    const Stopwatch watch;
    const std::vector<int> columns = DrawColumns(kFreeColumns, context.seed);
    TrainingData data = ColumnsOfTable(columns);
    AddTable(table, columns, context.material, &data);
    TrainerOptions training;
    training.shape = options_.shape;
    training.steps = options_.steps;
    training.codes_per_step = 3;
    training.columns_per_code = 32;
    training.points_per_column = 32;
    training.seed = context.seed;
    training.num_threads = context.num_threads;
    const StatusOr<NeuralBrdfModel> model =
        TrainFlow(data, data.Slice(0, 64), training, nullptr, context.stop);
    if (!model.ok()) return model.status();
    FittedTable result;
    result.seconds = watch.Seconds();
    // Each channel is a lobe of its own colour.
    const FlowLobes lobes(*model, 3, kNoGrid, context.num_threads);
    result.table = lobes.ToMerl(MaterialLobes(*model, 0).data());
    return result;
  }

 private:
  const FreeFlowOptions options_;
};

}  // namespace

std::shared_ptr<const TableFitter> FlowFitter(
    std::shared_ptr<const LobeTableFitter> fitter,
    const std::string& model_name, const LobeTableFitOptions& options) {
  return std::make_shared<FlowTableFitter>(std::move(fitter), model_name,
                                           options);
}

std::shared_ptr<const TableFitter> FreeFlowFitter(
    const FreeFlowOptions& options) {
  return std::make_shared<FreeFlowTableFitter>(options);
}

}  // namespace ibrdf
