// What several views leave unknown of a surface.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/progress_line.h"
#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"
#include "ibrdf/solvers/uncertainty_map/write_uncertainty.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

struct UncertaintyFlags {
  std::string problem, out = "out", candidates = "sphere:100";
  std::vector<std::string> overrides;
  int add = 0;
  CommonFlags common;
};

void PrintSummary(const UncertaintyResult& result) {
  const TexelEntropy& texels = result.texels;
  std::printf("texels: %zu, of which views see %d; mean entropy %.3f\n",
              texels.observed_views.size(), texels.CountObserved(),
              texels.MeanEntropy(/*observed_alone=*/false));
  if (!result.next) return;
  const NextViews& next = *result.next;
  for (size_t i = 0; i < next.chosen.size(); ++i) {
    std::printf("next view: %s, expected entropy %.3f\n",
                next.candidates[next.chosen[i]].name.c_str(),
                next.expected_entropy[i + 1]);
  }
}

Status Run(const UncertaintyFlags& flags) {
  const StatusOr<Problem> problem = ReadProblem(flags.problem, flags.overrides);
  if (!problem.ok()) return problem.status();
  IBRDF_RETURN_IF_ERROR(CheckTextures(*problem));
  IBRDF_RETURN_IF_ERROR(PrepareFolder(flags.out));
  ProgressLine progress("entropy", flags.common.quiet);
  UncertaintyOptions options;
  options.add = flags.add;
  options.candidates = flags.candidates;
  options.num_threads = flags.common.threads;
  options.progress = [&](double share) {
    progress.Show(share);
    return !stop_requested;
  };
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  StatusOr<UncertaintyResult> result = MapUncertainty(*problem, options);
  if (!result.ok()) return result.status();
  PrintWarnings(result->inputs.warnings);
  IBRDF_RETURN_IF_ERROR(
      WriteUncertainty(*problem, options, flags.out, &*result));
  if (!flags.common.quiet) PrintSummary(*result);
  return OkStatus();
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Maps what several views under known light leave unknown of a surface: "
      "the entropy, from 0 to 1, of roughness, gloss and albedo at every "
      "texel. Nothing is solved. SIGINT ends it with nothing written (exit "
      "status 130).");
  UncertaintyFlags flags;
  AddCommonFlags(&app, &flags.common);
  app.add_option("--problem", flags.problem,
                 "problem file (YAML) with problem: textures, views, a sphere "
                 "or mesh, and known light")
      ->required();
  app.add_option("--out", flags.out,
                 "folder of the results; it is made if need be")
      ->capture_default_str();
  app.add_option("--add", flags.add,
                 "number of further views to choose, into next_views.json")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option("--candidates", flags.candidates,
                 "what they are chosen from: sphere:N cameras about the "
                 "surface, a file of transforms (.json), or a folder of "
                 "COLMAP's model")
      ->capture_default_str();
  app.add_option("--set", flags.overrides,
                 "key.path=value overrides a key of the problem; repeatable; "
                 "e.g. --set texture.width=512 (texels)")
      ->expected(1)
      ->take_all();
  return RunProgram(&app, argc, argv, [&] { return Run(flags); });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
