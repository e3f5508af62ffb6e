// Measures every derivative of the library against long double; see README.md.
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/conditioning_study.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/solvers/problem/open_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

int Run(const std::string& csv, const std::string& only,
        const StudyOptions& options) {
  const StatusOr<OpenedModel> opened = OpenModel("default");
  if (!opened.ok()) {
    std::fprintf(stderr, "%s\n", opened.status().message().c_str());
    return opened.status().ExitCode();
  }
  const NeuralBrdfModel& model = opened->model;
  ErrorTable table;
  const std::vector<std::pair<std::string, std::function<void()>>> studies = {
      {"flows", [&] { StudyFlows(model, options, &table); }},
      {"lobes", [&] { StudyLobes(model, options, &table); }},
      {"unet", [&] { StudyUnet(options, &table); }},
      {"costs", [&] { StudyCosts(options, &table); }},
      {"baselines", [&] { StudyBaselines(options, &table); }},
      {"joint", [&] { StudyJoint(model, options, &table); }},
      {"marginal", [&] { StudyMarginal(model, options, &table); }},
      {"transport", [&] { StudyTransport(options, &table); }},
      {"harmonics", [&] { StudyHarmonics(options, &table); }},
      {"gaussians", [&] { StudyGaussians(options, &table); }},
  };
  for (const auto& [name, study] : studies) {
    if (!only.empty() && only != name) continue;
    std::fprintf(stderr, "%s\n", name.c_str());
    study();
  }
  std::printf("%-52s %-32s %5s %8s %8s %8s %8s %4s  %s\n", "derivative",
              "points", "count", "median", "99 %", "worst", "entry", "bad",
              "worst at");
  for (const ErrorRow& r : table.Rows()) {
    std::printf("%-52s %-32s %5d %8.1e %8.1e %8.1e %8.1e %4d  %s\n",
                r.derivative.c_str(), r.points.c_str(), r.count, r.median,
                r.p99, r.worst, r.worst_entry, r.not_finite,
                r.worst_point.c_str());
  }
  if (!csv.empty()) std::ofstream(csv) << ToCsv(table.Rows());
  if (!only.empty() && only != "conditioning") return 0;
  std::printf("\n%-14s %-16s %10s %10s %10s  %s\n", "material", "lobes",
              "image", "+ prior", "marginal",
              "std by Gauss-Newton over exact: least, median, most");
  for (const ConditioningRow& r : StudyConditioning(model, true)) {
    std::printf("%-14s %-16s %10.2g %10.2g %10.2g  %.2f %.2f %.2f\n",
                r.material.c_str(), r.lobes.c_str(), r.image, r.with_prior,
                r.marginal, r.smallest_ratio, r.median_ratio, r.largest_ratio);
  }
  return 0;
}

}  // namespace
}  // namespace derivatives
}  // namespace ibrdf

int main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  CLI::App app("Errors of all derivatives against long double references");
  std::string csv, only;
  ibrdf::derivatives::StudyOptions options;
  app.add_option("--csv", csv, "table to write");
  app.add_option("--only", only, "one study");
  app.add_option("--points", options.points, "random points per row")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of all random numbers")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return ibrdf::derivatives::Run(csv, only, options);
}
