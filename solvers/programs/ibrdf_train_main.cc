// The trainer of the flow and its embedding.
#include <glog/logging.h>

#include <CLI/CLI.hpp>

#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/train_model.h"

namespace ibrdf {
namespace {

// What is read and written.
void AddDataFlags(CLI::App* app, TrainFlags* flags) {
  CLI::Option* data =
      app->add_option("--data", flags->data, "folder of MERL .binary files");
  CLI::Option* more =
      app->add_option("--more-data", flags->more_data,
                      "another folder of MERL .binary files to train on")
          ->needs(data);
  app->add_option("--void-beyond", flags->void_beyond,
                  "bins of --more-data with a direction further from the "
                  "normal than this, degrees, count as not measured")
      ->needs(more)
      ->check(CLI::Range(1.0, 90.0))
      ->capture_default_str();
  app->add_option("--out", flags->out, "model file to write")->required();
  CLI::Option* refit = app->add_option(
      "--refit", flags->refit,
      "a trained model: trains nothing, fits the lobes of its materials (the "
      "prior of estimates) anew and writes it to --out");
  refit->excludes(data);
  app->add_option("--leave-out", flags->leave_out,
                  "comma-separated materials not to train on");
  app->add_option("--note", flags->note,
                  "text kept in the model: data, licence");
  app->add_option(
         "--columns", flags->columns,
         "random columns (theta_d, phi_d) of each table to use; 1/8 of "
         "them are held out")
      ->check(CLI::Range(64, 16200))
      ->capture_default_str();
  app->add_option("--analytic", flags->analytic,
                  "random analytic materials to train on beside the tables")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app->add_flag("--lambertian", flags->lambertian,
                "fits the materials with a Lambertian lobe beside the flow's; "
                "estimates with the model then have one too");
  app->add_flag("--skip-lobes", flags->skip_lobes,
                "does not fit the lobes of materials, which fits to tables "
                "(merl-fit) do without; --refit fits them later")
      ->excludes(refit);
  app->add_flag("--fresh", flags->fresh, "ignore an existing checkpoint");
}

// What a step takes.
void AddStepFlags(CLI::App* app, TrainerOptions* options) {
  app->add_option("--steps", options->steps, "Adam steps")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  app->add_option("--codes-per-step", options->codes_per_step,
                  "distributions in a step")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app->add_option("--columns-per-code", options->columns_per_code,
                  "columns of each, a multiple of 16")
      ->check(CLI::Range(16, 16384))
      ->capture_default_str();
  app->add_option("--points-per-column", options->points_per_column,
                  "theta_h of each column, a multiple of 4")
      ->check(CLI::Range(4, 1024))
      ->capture_default_str();
}

void AddFlowFlags(CLI::App* app, TrainFlags* flags) {
  app->add_option("--flow", flags->flow,
                  "triangular, or coupling: the alternating stack, for "
                  "comparison")
      ->check(CLI::IsMember({"triangular", "coupling"}))
      ->capture_default_str();
  app->add_option("--bins", flags->bins,
                  "bins of the splines of theta_h, theta_d and phi_d; of the "
                  "coupling stack the first counts")
      ->expected(3)
      ->capture_default_str();
  app->add_option("--widths", flags->widths,
                  "hidden layers of theta_h's conditioner; of the coupling "
                  "stack's, outermost first")
      ->capture_default_str();
  app->add_option("--marginal-widths",
                  flags->trainer.shape.triangular.marginal_widths,
                  "hidden layers of the other conditioners")
      ->capture_default_str();
  app->add_option("--layers", flags->trainer.shape.coupling.layers,
                  "layers of the coupling stack")
      ->capture_default_str();
  app->add_option("--exponent", flags->trainer.exponent,
                  "reflectance = colour * density ^ exponent")
      ->check(CLI::Range(0.1, 32.0))
      ->capture_default_str();
}

void AddRateFlags(CLI::App* app, TrainerOptions* options) {
  app->add_option("--learning-rate", options->learning_rate, "of the weights")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--code-learning-rate", options->code_learning_rate,
                  "of the codes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--report-seconds", options->report_seconds,
                  "seconds between progress lines")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--checkpoint-seconds", options->checkpoint_seconds,
                  "seconds between checkpoints")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
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
  AddCommonFlags(&app, &common);
  AddDataFlags(&app, &flags);
  AddStepFlags(&app, &flags.trainer);
  AddFlowFlags(&app, &flags);
  AddRateFlags(&app, &flags.trainer);
  return RunProgram(&app, argc, argv, [&] {
    return flags.refit.empty() ? TrainModel(flags, common)
                               : RefitModel(flags, common);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
