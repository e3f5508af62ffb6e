#include "ibrdf/solvers/programs/train_model.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "ibrdf/base/format.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/solvers/training/analytic_materials.h"
#include "ibrdf/solvers/training/material_lobes.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

// Estimates of two lobes are what users ask for.
constexpr int kFitLobes = 2;

std::vector<std::string> SplitByComma(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

// Before hours are spent.
Status PrepareFolderOf(const std::string& file) {
  const std::string folder = std::filesystem::path(file).parent_path();
  return PrepareFolder(folder.empty() ? "." : folder);
}

TrainerOptions TrainerOptionsOf(const TrainFlags& flags,
                                const CommonFlags& common) {
  TrainerOptions options = flags.trainer;
  FlowShape* shape = &options.shape;
  if (flags.flow == "coupling") {
    shape->architecture = FlowArchitecture::kCoupling;
    shape->coupling.bins = flags.bins[0];
    shape->coupling.widths = flags.widths;
  } else {
    std::copy(flags.bins.begin(), flags.bins.end(),
              shape->triangular.bins.begin());
    shape->triangular.widths = flags.widths;
  }
  options.checkpoint = flags.out + ".checkpoint";
  options.seed = common.seed;
  options.num_threads = common.threads;
  return options;
}

struct TrainingTables {
  TrainingData train, held_out;  // columns
  size_t measured = 0;           // distributions; analytic ones come after
};

StatusOr<TrainingTables> ReadTables(const TrainFlags& flags, uint64_t seed) {
  std::vector<TableFolder> folders = {{flags.data}};
  if (!flags.more_data.empty()) {
    folders.push_back({flags.more_data, flags.void_beyond});
  }
  StatusOr<TrainingData> all = ReadTrainingData(
      folders, SplitByComma(flags.leave_out), flags.columns, seed);
  if (!all.ok()) return all.status();
  TrainingTables tables;
  tables.measured = all->names.size();
  AddAnalyticMaterials(flags.analytic, seed, &*all);
  const int train_columns = all->num_columns() - all->num_columns() / 8;
  tables.train = all->Slice(0, train_columns);
  tables.held_out = all->Slice(train_columns, all->num_columns());
  return tables;
}

void PrintProgress(const TrainerProgress& p, int64_t steps) {
  std::printf(
      "step %6lld / %lld  %7.1f s  train log-RMSE %.4f  held-out columns "
      "%.4f\n",
      static_cast<long long>(p.step), static_cast<long long>(steps), p.seconds,
      p.training_rmse, p.held_out_rmse);
  std::fflush(stdout);
}

// The codes of analytic materials are not kept.
void KeepMeasured(size_t measured, NeuralBrdfModel* model) {
  model->names.resize(measured);
  model->codes.resize(measured * model->shape.code_size());
  model->log_colours.resize(measured);
}

// Prints the score of each material, unless it is to be quiet, and their mean,
// which it returns as a sentence.
std::string PrintScores(const NeuralBrdfModel& model,
                        const TrainingData& held_out,
                        const CommonFlags& common) {
  const std::vector<double> scores =
      ScoreModel(model, held_out, common.threads);
  std::vector<double> by_material;
  for (size_t m = 0; m + 2 < scores.size(); m += 3) {
    by_material.push_back(
        std::sqrt((scores[m] * scores[m] + scores[m + 1] * scores[m + 1] +
                   scores[m + 2] * scores[m + 2]) /
                  3));
    if (!common.quiet) {
      const std::string& name = model.names[m];
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
  return score;
}

// What the model tells of its training.
std::string Note(const TrainFlags& flags, const TrainerOptions& options,
                 const std::string& score) {
  return flags.note + (flags.note.empty() ? "" : " ") + score + "; " +
         std::to_string(flags.analytic) + " analytic materials beside; " +
         std::to_string(options.steps) + " steps of " +
         std::to_string(options.codes_per_step) + " codes x " +
         std::to_string(options.columns_per_code) + " columns x " +
         std::to_string(options.points_per_column) + " points, seed " +
         std::to_string(options.seed) + ".";
}

Status FitLobes(const TrainFlags& flags, const CommonFlags& common,
                NeuralBrdfModel* model) {
  if (!common.quiet) {
    std::printf("fitting %d lobes%s to each of %d materials\n", kFitLobes,
                flags.lambertian ? " and a Lambertian one" : "",
                model->num_materials());
    std::fflush(stdout);
  }
  return FitMaterialLobes(kFitLobes, flags.lambertian, common.threads,
                          &stop_requested, model);
}

}  // namespace

Status TrainFlags::Check() const {
  if (!data.empty()) return OkStatus();
  return InvalidInput("command line: --data",
                      "expected a folder of MERL .binary files, or --refit");
}

Status TrainModel(const TrainFlags& flags, const CommonFlags& common) {
  IBRDF_RETURN_IF_ERROR(flags.Check());
  const TrainerOptions options = TrainerOptionsOf(flags, common);
  IBRDF_RETURN_IF_ERROR(options.Check());
  IBRDF_RETURN_IF_ERROR(PrepareFolderOf(flags.out));
  const StatusOr<TrainingTables> tables = ReadTables(flags, common.seed);
  if (!tables.ok()) return tables.status();
  if (flags.fresh) std::remove(options.checkpoint.c_str());
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  const auto report = [&](const TrainerProgress& p) {
    if (!common.quiet) PrintProgress(p, options.steps);
  };
  StatusOr<NeuralBrdfModel> model = TrainFlow(tables->train, tables->held_out,
                                              options, report, &stop_requested);
  if (!model.ok()) return model.status();
  KeepMeasured(tables->measured, &*model);
  model->note =
      Note(flags, options, PrintScores(*model, tables->held_out, common));
  if (!flags.skip_lobes) {
    IBRDF_RETURN_IF_ERROR(FitLobes(flags, common, &*model));
  }
  IBRDF_RETURN_IF_ERROR(WriteModel(*model, flags.out));
  std::remove(options.checkpoint.c_str());
  return OkStatus();
}

Status RefitModel(const TrainFlags& flags, const CommonFlags& common) {
  StatusOr<NeuralBrdfModel> model = ReadModel(flags.refit);
  if (!model.ok()) return model.status();
  if (model->num_materials() == 0) {
    return InvalidInput(flags.refit, "expected the codes of a material");
  }
  IBRDF_RETURN_IF_ERROR(PrepareFolderOf(flags.out));
  IBRDF_RETURN_IF_ERROR(FitLobes(flags, common, &*model));
  return WriteModel(*model, flags.out);
}

}  // namespace ibrdf
