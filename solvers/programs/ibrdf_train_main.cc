// The trainer of the flow and its embedding.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/training/analytic_materials.h"
#include "ibrdf/solvers/training/flow_trainer.h"
#include "ibrdf/solvers/training/material_lobes.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

struct TrainFlags {
  std::string data, refit, out, leave_out, note;
  int columns = 2048;
  int analytic = 48;
  bool fresh = false;
  std::string flow = "triangular";
  std::vector<int> bins = {32, 16, 16};
  std::vector<int> widths = {96, 96, 96};
};

void SetShape(const TrainFlags& flags, FlowShape* shape) {
  if (flags.flow == "coupling") {
    shape->architecture = FlowArchitecture::kCoupling;
    shape->coupling.bins = flags.bins[0];
    shape->coupling.widths = flags.widths;
  } else {
    std::copy(flags.bins.begin(), flags.bins.end(),
              shape->triangular.bins.begin());
    shape->triangular.widths = flags.widths;
  }
}

std::vector<std::string> SplitByComma(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

// Estimates of two lobes are what users ask for.
constexpr int kFitLobes = 2;

Status FitLobes(const CommonFlags& common, NeuralBrdfModel* model) {
  if (!common.quiet) {
    std::printf("fitting %d lobes to each of %d materials\n", kFitLobes,
                model->num_materials());
    std::fflush(stdout);
  }
  return FitMaterialLobes(kFitLobes, common.threads, &stop_requested, model);
}

// Before hours are spent.
Status PrepareFolderOf(const std::string& file) {
  const std::string folder = std::filesystem::path(file).parent_path();
  return PrepareFolder(folder.empty() ? "." : folder);
}

Status Refit(const TrainFlags& flags, const CommonFlags& common) {
  StatusOr<NeuralBrdfModel> model = ReadModel(flags.refit);
  if (!model.ok()) return model.status();
  if (model->num_materials() == 0) {
    return InvalidInput(flags.refit, "expected the codes of a material");
  }
  IBRDF_RETURN_IF_ERROR(PrepareFolderOf(flags.out));
  IBRDF_RETURN_IF_ERROR(FitLobes(common, &*model));
  return WriteModel(*model, flags.out);
}

Status Train(const TrainFlags& flags, const CommonFlags& common,
             TrainerOptions options) {
  if (flags.data.empty()) {
    return InvalidInput("command line: --data",
                        "expected a folder of MERL .binary files, or --refit");
  }
  SetShape(flags, &options.shape);
  const std::string wrong = options.shape.Validate();
  if (!wrong.empty()) return InvalidInput("command line", wrong);
  if (options.columns_per_code % 16 != 0) {
    return InvalidInput("command line: --columns-per-code",
                        "expected a multiple of 16");
  }
  if (options.points_per_column % 4 != 0) {
    return InvalidInput("command line: --points-per-column",
                        "expected a multiple of 4");
  }
  IBRDF_RETURN_IF_ERROR(PrepareFolderOf(flags.out));
  StatusOr<TrainingData> all = ReadTrainingData(
      flags.data, SplitByComma(flags.leave_out), flags.columns, common.seed);
  if (!all.ok()) return all.status();
  const size_t measured = all->names.size();
  AddAnalyticMaterials(flags.analytic, common.seed, &*all);
  // An eighth of the columns is never trained on.
  const int train_columns = all->num_columns() - all->num_columns() / 8;
  const TrainingData train = all->Slice(0, train_columns);
  const TrainingData held_out = all->Slice(train_columns, all->num_columns());
  options.checkpoint = flags.out + ".checkpoint";
  options.seed = common.seed;
  options.num_threads = common.threads;
  if (flags.fresh) std::remove(options.checkpoint.c_str());
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);

  const auto report = [&](const TrainerProgress& p) {
    if (common.quiet) return;
    std::printf(
        "step %6lld / %lld  %7.1f s  train log-RMSE %.4f  held-out columns "
        "%.4f\n",
        static_cast<long long>(p.step), static_cast<long long>(options.steps),
        p.seconds, p.training_rmse, p.held_out_rmse);
    std::fflush(stdout);
  };
  StatusOr<NeuralBrdfModel> model =
      TrainFlow(train, held_out, options, report, &stop_requested);
  if (!model.ok()) return model.status();
  // What was added comes last; the model keeps the measured codes.
  model->names.resize(measured);
  model->codes.resize(measured * model->shape.code_size());
  model->log_colours.resize(measured);

  const std::vector<double> scores =
      ScoreModel(*model, held_out, common.threads);
  std::vector<double> by_material;
  for (size_t m = 0; m + 2 < scores.size(); m += 3) {
    by_material.push_back(
        std::sqrt((scores[m] * scores[m] + scores[m + 1] * scores[m + 1] +
                   scores[m + 2] * scores[m + 2]) /
                  3));
    if (!common.quiet) {
      const std::string& name = model->names[m];
      std::printf("%-28s %.4f\n", name.substr(0, name.rfind('.')).c_str(),
                  by_material.back());
    }
  }
  const double mean =
      std::accumulate(by_material.begin(), by_material.end(), 0.0) /
      static_cast<double>(by_material.size());
  const std::string score = Format(
      "mean log-RMSE over %zu materials at columns not trained on, "
      "one code per channel: %.4f",
      by_material.size(), mean);
  std::printf("%s\n", score.c_str());
  model->note = flags.note + (flags.note.empty() ? "" : " ") + score + "; " +
                std::to_string(flags.analytic) +
                " analytic materials beside; " + std::to_string(options.steps) +
                " steps of " + std::to_string(options.codes_per_step) +
                " codes x " + std::to_string(options.columns_per_code) +
                " columns x " + std::to_string(options.points_per_column) +
                " points, seed " + std::to_string(options.seed) + ".";
  IBRDF_RETURN_IF_ERROR(FitLobes(common, &*model));
  IBRDF_RETURN_IF_ERROR(WriteModel(*model, flags.out));
  std::remove(options.checkpoint.c_str());
  return OkStatus();
}

int Main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  CLI::App app(
      "Trains the invertible BRDF and its embedding on a folder of MERL "
      ".binary tables. Stops at SIGINT with a checkpoint beside --out, from "
      "which the same command goes on.");
  CommonFlags common;
  TrainFlags flags;
  TrainerOptions options;
  AddCommonFlags(&app, &common);
  CLI::Option* data =
      app.add_option("--data", flags.data, "folder of MERL .binary files");
  app.add_option("--out", flags.out, "model file to write")->required();
  CLI::Option* refit = app.add_option(
      "--refit", flags.refit,
      "a trained model: trains nothing, fits the lobes of its materials (the "
      "prior of estimates) anew and writes it to --out");
  refit->excludes(data);
  app.add_option("--leave-out", flags.leave_out,
                 "comma-separated materials not to train on");
  app.add_option("--note", flags.note, "text kept in the model: data, licence");
  app.add_option("--columns", flags.columns,
                 "random columns (theta_d, phi_d) of each table to use; 1/8 of "
                 "them are held out")
      ->check(CLI::Range(64, 16200))
      ->capture_default_str();
  app.add_option("--analytic", flags.analytic,
                 "random analytic materials to train on beside the tables")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_flag("--fresh", flags.fresh, "ignore an existing checkpoint");
  app.add_option("--steps", options.steps, "Adam steps")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  app.add_option("--codes-per-step", options.codes_per_step,
                 "distributions in a step")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--columns-per-code", options.columns_per_code,
                 "columns of each, a multiple of 16")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  app.add_option("--points-per-column", options.points_per_column,
                 "theta_h of each column, a multiple of 4")
      ->check(CLI::Range(4, 1024))
      ->capture_default_str();
  app.add_option("--flow", flags.flow,
                 "triangular, or coupling: the alternating stack, for "
                 "comparison")
      ->check(CLI::IsMember({"triangular", "coupling"}))
      ->capture_default_str();
  app.add_option("--bins", flags.bins,
                 "bins of the splines of theta_h, theta_d and phi_d; of the "
                 "coupling stack the first counts")
      ->expected(3)
      ->capture_default_str();
  app.add_option("--widths", flags.widths,
                 "hidden layers of theta_h's conditioner; of the coupling "
                 "stack's, outermost first")
      ->capture_default_str();
  app.add_option("--marginal-widths", options.shape.triangular.marginal_widths,
                 "hidden layers of the other conditioners")
      ->capture_default_str();
  app.add_option("--layers", options.shape.coupling.layers,
                 "layers of the coupling stack")
      ->capture_default_str();
  app.add_option("--exponent", options.exponent,
                 "reflectance = colour * density ^ exponent")
      ->check(CLI::Range(0.1, 32.0))
      ->capture_default_str();
  app.add_option("--learning-rate", options.learning_rate, "of the weights")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--code-learning-rate", options.code_learning_rate,
                 "of the codes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--report-seconds", options.report_seconds,
                 "seconds between progress lines")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--checkpoint-seconds", options.checkpoint_seconds,
                 "seconds between checkpoints")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return RunProgram(&app, argc, argv, [&] {
    return flags.refit.empty() ? Train(flags, common, options)
                               : Refit(flags, common);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
