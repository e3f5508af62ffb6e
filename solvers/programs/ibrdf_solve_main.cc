// The estimate of reflectance and illumination from one image.
#include <glog/logging.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_reference.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/optim/blas_memory.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/report/write_results.h"
#include "ibrdf/solvers/solve/curve_search.h"
#include "ibrdf/solvers/solve/solve.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

void PrintKeys() {
  std::fputs(ProblemReference(ProblemFileSchema()).c_str(), stdout);
  throw CLI::Success();  // as --help does: nothing else is asked for
}

void PrintExample() {
  std::printf(
      "Estimates reflectance and light from a photograph of an object of known "
      "shape.\nSave this as problem.yaml, name your files in it, take out what "
      "you do not need,\nand run: ibrdf_solve --problem problem.yaml --out "
      "result\n\n%s\nibrdf_solve --keys explains every key, --help every "
      "option.\n",
      ExampleProblem(ProblemFileSchema()).c_str());
  std::fflush(stdout);
}

Status Solve(const std::string& file, const std::vector<std::string>& overrides,
             const std::string& folder, bool explain,
             const CommonFlags& flags) {
  const StatusOr<Problem> problem = ReadProblem(file, overrides);
  if (!problem.ok()) return problem.status();
  const Stopwatch clock;
  StatusOr<InverseProblem> inverse =
      LoadInverseProblem(*problem, flags.seed, flags.threads);
  if (!inverse.ok()) return inverse.status();
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  if (explain || !flags.quiet) {
    std::printf("%zu pixels of the object, map %dx%d; effects: %s\n",
                inverse->points.size(), inverse->map_width, inverse->map_height,
                Describe(inverse->effects).c_str());
  }
  if (explain) {
    PrintWarnings(inverse->warnings);
    return OkStatus();
  }
  // What the end needs, before time is spent.
  const StatusOr<Truth> truth =
      LoadTruth(problem->truth, inverse->map_width, inverse->map_height);
  if (!truth.ok()) return truth.status();
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
  IBRDF_RETURN_IF_ERROR(
      CheckNothingReplaced(*problem, ResultPaths(*problem, folder)));
  IBRDF_RETURN_IF_ERROR(ReserveBlasMemory(flags.threads));
  const SolveProgress progress = [&](const TraceEntry& e, double share) {
    if (flags.quiet) return;
    std::printf("%s%7.1f s  %3.0f %%  %-32s misfit %.4f  cost %.1f%s",
                terminal ? "\r\033[K" : "", e.seconds, 100 * share,
                e.stage.c_str(), e.misfit, e.cost,
                terminal && e.stage != "end" ? "" : "\n");
    std::fflush(stdout);
  };
  inverse->seconds_spent = clock.Seconds();
  inverse->seconds_reserved = PredictWriteSeconds(*inverse);
  const StatusOr<Solution> estimate =
      SolveInverseRendering(*inverse, progress, &stop_requested);
  if (!estimate.ok()) return estimate.status();
  if (!estimate->curves.empty()) {
    *inverse = WithCurve(*inverse, estimate->curves.front().curve);
  }
  const StatusOr<ResultMetrics> metrics =
      MeasureResult(*inverse, *truth, *estimate);
  if (!metrics.ok()) return metrics.status();
  const SolvedProblem solved{*problem, *inverse, *truth, *estimate, *metrics};
  IBRDF_RETURN_IF_ERROR(WriteResults(solved, folder));
  PrintWarnings(ResultWarnings(solved));
  if (!flags.quiet) {
    for (const std::string& line : MetricLines(*metrics)) {
      std::printf("  %s\n", line.c_str());
    }
    std::printf("results in %s; look at %s/report.html\n", folder.c_str(),
                folder.c_str());
  }
  return estimate->status;
}

int Main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  CLI::App app(
      "Estimates reflectance (MERL table) and illumination (equirectangular "
      "map, W/(m^2 sr)) from one HDR image of an object of known shape. "
      "SIGINT ends early and keeps the best estimate (exit status 130).");
  CommonFlags flags;
  AddCommonFlags(&app, &flags);
  std::string file, folder = "out";
  std::vector<std::string> overrides;
  app.add_option("--problem", file, "problem file (YAML)")->required();
  app.add_option("--out", folder, "folder of the results, made if need be")
      ->capture_default_str();
  app.add_option("--set", overrides,
                 "key.path=value overrides a key of the problem; repeatable; "
                 "e.g. --set solver.seconds=30")
      ->expected(1)
      ->take_all();
  bool verbose = false;
  app.add_flag("--verbose", verbose,
               "log steps and the conditioning of their normal equations, on "
               "standard error");
  bool explain = false;
  app.add_flag("--explain", explain,
               "print which effects would be simulated and why; solve nothing");
  app.add_flag_callback("--keys", PrintKeys,
                        "print every key of a problem file with its default, "
                        "range and meaning, in Markdown; solve nothing");
  // Somebody who looks what this is; the parser then says what is missing.
  if (argc == 1) PrintExample();
  return RunProgram(&app, argc, argv, [&] {
    if (verbose) {
      FLAGS_minloglevel = google::GLOG_INFO;
      FLAGS_v = 1;
    }
    return Solve(file, overrides, folder, explain, flags);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
