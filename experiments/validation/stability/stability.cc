// Errors on stress axes, the library's and naive float code's; see README.md.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/validation/stability/naive_flow.h"
#include "experiments/validation/stability/sweeps.h"
#include "ibrdf/solvers/problem/open_model.h"

namespace ibrdf {
namespace stability {
namespace {

int Run(const std::string& only, const SweepOptions& options) {
  const StatusOr<OpenedModel> opened = OpenModel("default");
  if (!opened.ok()) {
    std::fprintf(stderr, "%s\n", opened.status().message().c_str());
    return opened.status().ExitCode();
  }
  const NeuralBrdfModel& model = opened->model;
  CHECK(model.shape.architecture == FlowArchitecture::kTriangular);
  CHECK_EQ(model.shape.code_size(), kCodeSize);
  SweepTable table;
  const std::vector<std::pair<std::string, std::function<void()>>> sweeps = {
      {"range", [&] { SweepRange(model, options, &table); }},
      {"units", [&] { SweepUnits(model, options, &table); }},
      {"noise", [&] { SweepNoise(model, options, &table); }},
      {"outliers", [&] { SweepOutliers(model, options, &table); }},
      {"roughness", [&] { SweepRoughness(options, &table); }},
      {"code norm", [&] { SweepCodeNorm(model, options, &table); }},
  };
  for (const auto& [name, sweep] : sweeps) {
    if (!only.empty() && only != name) continue;
    std::fprintf(stderr, "%s\n", name.c_str());
    sweep();
  }
  std::fputs(table.Csv().c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace stability
}  // namespace ibrdf

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  CLI::App app(
      "Errors on stress axes, the library's and naive float code's, as CSV");
  std::string only;
  ibrdf::stability::SweepOptions options;
  app.add_option("--only", only, "one sweep");
  app.add_option("--seeds", options.seeds, "images of each noise")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of all random numbers")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return ibrdf::stability::Run(only, options);
}
