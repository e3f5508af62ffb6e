// The estimate of reflectance and illumination from one image.
#include <glog/logging.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_reference.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/next_view/informative_views.h"
#include "ibrdf/solvers/next_view/next_view_candidates.h"
#include "ibrdf/solvers/optim/blas_memory.h"
#include "ibrdf/solvers/photograph_check/check_words.h"
#include "ibrdf/solvers/problem/load_object.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "ibrdf/solvers/problem/with_labels.h"
#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/problem_from_flags.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/report/verdict.h"
#include "ibrdf/solvers/report/write_check.h"
#include "ibrdf/solvers/report/write_results.h"
#include "ibrdf/solvers/solve/curve_search.h"
#include "ibrdf/solvers/solve/joint.h"
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
      "shape.\nWith a normal map and a mask, one command does it; --check "
      "looks at them and solves nothing:\n\n"
      "  ibrdf_solve photo.exr --normals normals.npy --mask mask.png --out "
      "result --check\n"
      "  ibrdf_solve photo.exr --normals normals.npy --mask mask.png --out "
      "result\n\n"
      "For a mesh and its camera, and all settings, write a problem file. Save "
      "this as problem.yaml,\nname your files in it, take out what you do not "
      "need,\nand run: ibrdf_solve --problem problem.yaml --out "
      "result\n\n%s\nibrdf_solve --keys explains every key, --help every "
      "option.\n",
      ExampleProblem(ProblemFileSchema()).c_str());
  std::fflush(stdout);
}

// The command line.
struct SolveFlags {
  CommonFlags common;
  std::string problem_file;
  ProblemFlags problem;  // its `out` and `overrides` in either case
  bool explain = false;  // print the effects, solve nothing
  bool check = false;    // print and draw the look before, solve nothing
  int add = 0;           // further views to choose
  std::string candidates = "sphere:100";  // LoadCandidates

  const std::string& folder() const { return problem.out; }
};

// The problem, of a file or of flags, and the text that the latter make.
struct AskedProblem {
  Problem problem;
  std::optional<FlagProblem> made;
};

StatusOr<AskedProblem> ReadAskedProblem(const SolveFlags& flags) {
  AskedProblem asked;
  if (flags.problem_file.empty()) {
    StatusOr<FlagProblem> made = ProblemFromFlags(flags.problem);
    if (!made.ok()) return made.status();
    asked.problem = made->problem;
    asked.made = *std::move(made);
    return asked;
  }
  if (flags.problem.Any()) {
    return InvalidInput(
        "command line: --problem",
        "expected either a problem file or a photograph with its options, "
        "found both; --set changes keys of the file, as --set image.mask=...");
  }
  StatusOr<Problem> problem =
      ReadProblem(flags.problem_file, flags.problem.overrides);
  if (!problem.ok()) return problem.status();
  asked.problem = *std::move(problem);
  return asked;
}

// The folder of the results, and what is known before a solve in it.
Status WriteBefore(const AskedProblem& asked, const PhotographedObject& object,
                   const SolveFlags& flags) {
  const std::string& folder = flags.folder();
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
  std::vector<std::string> paths = CheckPaths(folder);
  if (!flags.check) {
    const std::vector<std::string> results =
        ResultPaths(asked.problem, object, folder);
    paths.insert(paths.end(), results.begin(), results.end());
    if (flags.add > 0) paths.push_back(folder + "/" + kNextViewsFile);
  }
  std::vector<NamedFile> photographs;
  for (const SheetView& view : object.sheet.views) {
    for (const std::string& file : {view.file, view.mask}) {
      if (!file.empty()) photographs.push_back({"view " + view.name, file});
    }
  }
  IBRDF_RETURN_IF_ERROR(
      CheckNothingReplaced(asked.problem, paths, photographs));
  if (asked.made.has_value()) {
    IBRDF_RETURN_IF_ERROR(WriteFlagProblem(*asked.made, folder));
  }
  return WriteCheck(asked.problem, object, folder);
}

void PrintLook(const AskedProblem& asked, const PhotographedObject& object) {
  if (asked.made.has_value()) {
    for (const std::string& note : asked.made->notes) {
      std::printf("%s\n", note.c_str());
    }
  }
  for (const CheckFinding& finding : CheckFindings(object.look->check)) {
    std::printf("  %-12s  %s\n", finding.subject.c_str(), finding.text.c_str());
  }
  std::fflush(stdout);
}

SolveProgress PrintedProgress(bool quiet) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  return [quiet, terminal](const TraceEntry& e, double share) {
    if (quiet) return;
    std::printf("%s%7.1f s  %3.0f %%  %-32s misfit %.4f  cost %.1f%s",
                terminal ? "\r\033[K" : "", e.seconds, 100 * share,
                e.stage.c_str(), e.misfit, e.cost,
                terminal && e.stage != "end" ? "" : "\n");
    std::fflush(stdout);
  };
}

// The views that were asked for; unset where nobody asked. What keeps them from
// being chosen is a warning of the problem.
StatusOr<std::optional<InformativeViews>> ChooseViews(
    const std::optional<NextViewCandidates>& candidates,
    const Solution& solution, int count, InverseProblem* inverse) {
  std::optional<InformativeViews> out;
  if (!candidates.has_value()) return out;
  StatusOr<InformativeViews> next =
      ChooseInformativeViews(*inverse, solution, *candidates, count);
  if (next.ok()) {
    out = *std::move(next);
  } else if (next.status().code() == StatusCode::kNoImprovement) {
    inverse->warnings.push_back(next.status().message());
  } else {
    return next.status();
  }
  return out;
}

void PrintNextViews(const InformativeViews& next) {
  for (size_t k = 0; k < next.chosen.size(); ++k) {
    std::printf("next view: %s, adds %.2f nats to %.1f\n",
                next.candidates[next.chosen[k]].name.c_str(), next.gains[k],
                next.information);
  }
}

// Solves, writes the results and prints their metrics.
Status SolveAndWrite(const Problem& problem, const Truth& truth,
                     const std::optional<NextViewCandidates>& candidates,
                     InverseProblem inverse, const SolveFlags& flags) {
  const std::string& folder = flags.folder();
  const StatusOr<Solution> estimate = SolveInverseRendering(
      inverse, PrintedProgress(flags.common.quiet), &stop_requested);
  if (estimate.status().code() == StatusCode::kInvalidInput) {
    return InvalidInput(problem.path, estimate.status().message());
  }
  if (!estimate.ok()) return estimate.status();
  if (!estimate->curves.empty()) {
    inverse = WithCurve(inverse, estimate->curves.front().curve);
  }
  if (!estimate->found_labels.labels.empty()) {
    inverse = WithLabels(std::move(inverse), estimate->found_labels.labels);
  }
  inverse = WithModelOf(*estimate, std::move(inverse));
  const StatusOr<std::optional<InformativeViews>> next =
      ChooseViews(candidates, *estimate, flags.add, &inverse);
  if (!next.ok()) return next.status();
  const StatusOr<ResultMetrics> metrics =
      MeasureResult(inverse, truth, *estimate);
  if (!metrics.ok()) return metrics.status();
  const SolvedProblem solved{problem,  inverse,
                             truth,    *estimate,
                             *metrics, next->has_value() ? &**next : nullptr};
  IBRDF_RETURN_IF_ERROR(WriteResults(solved, folder));
  PrintWarnings(ResultWarnings(solved));
  if (!flags.common.quiet) {
    for (const std::string& line : MetricLines(*metrics)) {
      std::printf("  %s\n", line.c_str());
    }
    for (const std::string& sentence : MakeVerdict(solved).Sentences()) {
      std::printf("%s\n", sentence.c_str());
    }
    if (next->has_value()) PrintNextViews(**next);
    std::printf("results in %s; look at %s/report.html\n", folder.c_str(),
                folder.c_str());
  }
  return estimate->status;
}

Status Solve(const SolveFlags& flags) {
  const StatusOr<AskedProblem> asked = ReadAskedProblem(flags);
  if (!asked.ok()) return asked.status();
  const Problem& problem = asked->problem;
  const Stopwatch clock;
  StatusOr<PhotographedObject> object =
      LoadPhotographedObject(problem, flags.common.threads);
  if (!object.ok()) return object.status();
  // Before a file is written or time is spent.
  std::optional<NextViewCandidates> candidates;
  if (flags.add > 0) {
    StatusOr<NextViewCandidates> loaded = LoadNextViewCandidates(
        problem, *object, flags.candidates, flags.common.threads);
    if (!loaded.ok()) return loaded.status();
    candidates = *std::move(loaded);
  }
  if (flags.check || !flags.common.quiet) PrintLook(*asked, *object);
  if (!flags.explain) {
    IBRDF_RETURN_IF_ERROR(WriteBefore(*asked, *object, flags));
  }
  if (flags.check) {
    PrintWarnings(object->warnings);
    std::printf("look at %s/check.png\n", flags.folder().c_str());
    return OkStatus();
  }
  StatusOr<InverseProblem> inverse = LoadInverseProblem(
      problem, *std::move(object), flags.common.seed, flags.common.threads);
  if (!inverse.ok()) return inverse.status();
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  if (flags.explain || !flags.common.quiet) {
    std::printf("%zu pixels of the object, map %dx%d; effects: %s\n",
                inverse->points.size(), inverse->map_width, inverse->map_height,
                Describe(inverse->effects).c_str());
  }
  if (flags.explain) {
    PrintWarnings(inverse->warnings);
    return OkStatus();
  }
  // What the end needs, before time is spent.
  const StatusOr<Truth> truth =
      LoadTruth(problem.truth, inverse->map_width, inverse->map_height);
  if (!truth.ok()) return truth.status();
  IBRDF_RETURN_IF_ERROR(ReserveBlasMemory(flags.common.threads));
  inverse->seconds_spent = clock.Seconds();
  inverse->seconds_reserved = PredictWriteSeconds(*inverse);
  return SolveAndWrite(problem, *truth, candidates, *std::move(inverse), flags);
}

void AddProblemFlags(CLI::App* app, SolveFlags* flags) {
  ProblemFlags* const problem = &flags->problem;
  app->add_option("photo", problem->photos,
                  "the photograph, in place of a problem file; several: of "
                  "one view, each under a light of its own");
  app->add_option("--normals", problem->normals,
                  "its normal map (x right, y up, z to the camera)");
  app->add_option(
      "--mesh", problem->mesh,
      "its mesh, in place of normals; the camera by --set camera...");
  app->add_option("--mask", problem->mask, "its mask: white is the object");
  app->add_option("--known-light", problem->known_light,
                  "the environment map, where it is known");
  app->add_option("--response", problem->response,
                  "the curve of its values: auto, linear, srgb, ...");
  app->add_option("--problem", flags->problem_file, "problem file (YAML)");
  app->add_option("--out", problem->out,
                  "folder of the results, made if need be")
      ->capture_default_str();
  app->add_option("--set", problem->overrides,
                  "key.path=value overrides a key of the problem; repeatable; "
                  "e.g. --set solver.seconds=30")
      ->expected(1)
      ->take_all();
  app->add_option("--add", flags->add,
                  "joint problems: number of further views to choose, into "
                  "next_views.json")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app->add_option("--candidates", flags->candidates,
                  "what they are chosen from: sphere:N cameras about the "
                  "object, a file of transforms (.json), or a folder of "
                  "COLMAP's model")
      ->capture_default_str();
  app->add_flag("--check", flags->check,
                "look at photograph, mask and shape: numbers, warnings and "
                "check.png; solve nothing");
  app->add_flag(
      "--explain", flags->explain,
      "print which effects would be simulated and why; solve nothing");
}

int Main(int argc, char** argv) {
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  CLI::App app(
      "Estimates reflectance (MERL table) and illumination (equirectangular "
      "map, W/(m^2 sr)) from one image of an object of known shape:\n"
      "  ibrdf_solve photo.exr --normals normals.npy --mask mask.png --out "
      "result\n"
      "  ibrdf_solve --problem problem.yaml --out result\n"
      "SIGINT ends early and keeps the best estimate (exit status 130).");
  SolveFlags flags;
  flags.problem.command = ShellCommand({argv, argv + argc});
  AddProblemFlags(&app, &flags);
  AddCommonFlags(&app, &flags.common);
  app.get_option("--seed")->description(
      "seed of random numbers. In a solve they are the samples behind the "
      "expected error, and the first weights of a network's map (prior: unet): "
      "another seed mostly changes nothing and is no test of robustness");
  bool verbose = false;
  app.add_flag("--verbose", verbose,
               "log steps and the conditioning of their normal equations, on "
               "standard error");
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
    return Solve(flags);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
