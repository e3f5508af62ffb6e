#include "ibrdf/solvers/programs/bench_merl_fit.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/solvers/bench/baseline_fitters.h"
#include "ibrdf/solvers/bench/merl_fit_sweep.h"
#include "ibrdf/solvers/bench/neural_fitters.h"
#include "ibrdf/solvers/problem/open_model.h"

namespace ibrdf {
namespace {

// Flags of the methods that are flows.
struct NeuralFitFlags {
  std::string model = "default";
  std::vector<int> lobes = {1, 2, 3};
  FreeFlowOptions free;
  LobeTableFitOptions fit;
};

struct MerlFitFlags {
  MerlFitSweepOptions options;
  NeuralFitFlags neural;
  std::vector<int> dsbrdf_lobes = {3, 5};
  OnlyFlag only;
  bool dry_run = false;

  Status Check() const { return neural.fit.Check(); }
};

// Adds `flow` and `flow_lambertian` with each number of lobes, for a model that
// it reads.
Status AddFlowFitters(const NeuralFitFlags& flags, TableFitters* fitters) {
  const StatusOr<OpenedModel> opened = OpenModel(flags.model);
  if (!opened.ok()) return opened.status();
  const std::string name = std::filesystem::path(flags.model).stem().string();
  const auto fitter = std::make_shared<const LobeTableFitter>(opened->model);
  for (const bool lambertian : {false, true}) {
    for (const int count : flags.lobes) {
      LobeTableFitOptions options = flags.fit;
      options.lobes = count;
      options.lambertian = lambertian;
      fitters->push_back(FlowFitter(fitter, name, options));
    }
  }
  return OkStatus();
}

// All methods, in the order of the results. A model that cannot be read is an
// error only where a method needs it.
Status ListFitters(const MerlFitFlags& flags, TableFitters* fitters) {
  *fitters = BaselineFitters(flags.dsbrdf_lobes);
  fitters->push_back(FreeFlowFitter(flags.neural.free));
  const std::vector<std::string>& methods = flags.options.methods;
  const bool wanted =
      methods.empty() ||
      std::any_of(methods.begin(), methods.end(), [](const std::string& m) {
        return m == "flow" || m == "flow_lambertian";
      });
  return wanted ? AddFlowFitters(flags.neural, fitters) : OkStatus();
}

Status PrintCases(const MerlFitSweepOptions& options) {
  const StatusOr<std::vector<MerlFitCase>> cases = ListMerlFitCases(options);
  if (!cases.ok()) return cases.status();
  for (const MerlFitCase& c : *cases) {
    std::printf("%s\t%s\t%s\n", c.name.c_str(), c.table_path.c_str(),
                c.score_path.c_str());
  }
  return OkStatus();
}

Status RunMerlFit(const BenchSession& session, MerlFitFlags* flags) {
  IBRDF_RETURN_IF_ERROR(flags->only.Parse());
  IBRDF_RETURN_IF_ERROR(flags->Check());
  MerlFitSweepOptions& options = flags->options;
  options.only_index = flags->only.index;
  options.only_count = flags->only.count;
  options.seed = session.common.seed;
  options.num_threads = session.common.threads;
  options.command = session.command;
  IBRDF_RETURN_IF_ERROR(ListFitters(*flags, &options.fitters));
  if (flags->dry_run) return PrintCases(options);
  options.report = session.Report();
  options.stop = session.stop;
  return RunMerlFitSweep(options);
}

// Names of --methods, each once.
std::string MethodNames() {
  std::string methods = "flow; flow_lambertian; flow_free; ";
  for (const auto& fitter : BaselineFitters()) {
    const std::string name = fitter->method();
    // Not as the end of a longer name.
    if ((" " + methods).find(" " + name + ";") == std::string::npos) {
      methods += name + "; ";
    }
  }
  return methods;
}

void AddTableFlags(CLI::App* fit, MerlFitSweepOptions* options) {
  fit->add_option("--data", options->data,
                  "folder of MERL .binary tables, fitted and scored")
      ->required();
  fit->add_option("--out", options->out, "folder of results")->required();
  fit->add_option("--materials", options->materials,
                  "comma-separated tables, without extension; default: all")
      ->delimiter(',');
  fit->add_option("--methods", options->methods,
                  "comma-separated, of: " + MethodNames() + "default: all")
      ->delimiter(',');
  fit->add_option("--void-beyond", options->void_beyond,
                  "bins with a direction further from the normal than this, "
                  "degrees, are neither fitted nor scored")
      ->check(CLI::Range(1.0, 90.0))
      ->capture_default_str();
}

void AddNeuralFitFlags(CLI::App* fit, NeuralFitFlags* flags) {
  fit->add_option(
         "--model", flags->model,
         "of the methods flow and flow_lambertian: default, or a model file")
      ->capture_default_str();
  fit->add_option(
         "--lobes", flags->lobes,
         "of these methods: comma-separated numbers of the flow's lobes")
      ->delimiter(',')
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  fit->add_option("--starts", flags->fit.starts,
                  "of these methods: starts from the embedding, per lobe")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  fit->add_option("--prior-sigma", flags->fit.prior_sigma,
                  "of these methods: standard deviation of the codes' prior")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  fit->add_option("--free-steps", flags->free.steps,
                  "of the method flow_free: Adam steps per table")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
}

}  // namespace

void AddMerlFitExperiment(CLI::App* app, BenchSession* session) {
  const auto flags = std::make_shared<MerlFitFlags>();
  CLI::App* fit = AddExperiment(
      app, "merl-fit",
      "How well models fit measured tables: fits each method to each table, "
      "and a row of DIR/results.csv as each fit finishes. The same command "
      "goes on where it was stopped.",
      session, [flags, session] { return RunMerlFit(*session, flags.get()); });
  AddTableFlags(fit, &flags->options);
  AddNeuralFitFlags(fit, &flags->neural);
  fit->add_option("--dsbrdf-lobes", flags->dsbrdf_lobes,
                  "of the method dsbrdf: comma-separated numbers of lobes")
      ->delimiter(',')
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  fit->add_option("--score-data", flags->options.score_data,
                  "another folder of tables of the same names: each fit is "
                  "scored on these too, without scaling");
  fit->add_option("--only", flags->only.text,
                  "i/n: every n-th material from the i-th")
      ->capture_default_str();
  fit->add_flag("--dry-run", flags->dry_run, "print the cases and stop");
}

}  // namespace ibrdf
