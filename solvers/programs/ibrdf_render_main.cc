// Forward render of a scene file.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/progress_line.h"
#include "ibrdf/solvers/programs/render_outputs.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

// Render until SIGINT or SIGTERM.
RenderSceneOptions OptionsOf(bool explain, const CommonFlags& flags,
                             ProgressLine* progress) {
  RenderSceneOptions options;
  options.seed = flags.seed;
  options.num_threads = flags.threads;
  options.progress = [progress](double share) {
    progress->Show(share);
    return !stop_requested;
  };
  options.plan_only = explain;
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  return options;
}

Status RunOne(const Problem& problem, const RenderOutputs& out, bool explain,
              const CommonFlags& flags) {
  if (!explain) IBRDF_RETURN_IF_ERROR(CheckRenderOutputs(problem, out));
  ProgressLine progress("render", flags.quiet);
  const StatusOr<RenderedScene> rendered =
      RenderScene(problem, OptionsOf(explain, flags, &progress));
  if (!rendered.ok()) return rendered.status();
  PrintWarnings(rendered->warnings);
  if (explain || !flags.quiet) {
    std::printf("effects: %s\n", Describe(*rendered).c_str());
  }
  return explain ? OkStatus() : WriteRenderOutputs(problem, *rendered, out);
}

// What the views share, the map and the BRDF, is written with the first.
Status RunViews(const Problem& problem, const RenderOutputs& out, bool explain,
                const CommonFlags& flags) {
  if (!explain) IBRDF_RETURN_IF_ERROR(CheckRenderOutputs(problem, out));
  ProgressLine progress("render", flags.quiet);
  bool first = true;
  return RenderViews(
      problem, OptionsOf(explain, flags, &progress),
      [&](const ViewSpec& view, const RenderedScene& rendered) -> Status {
        if (first) PrintWarnings(rendered.warnings);
        if (explain || !flags.quiet) {
          std::printf("%s: effects: %s\n", view.name.c_str(),
                      Describe(rendered).c_str());
        }
        if (explain) return OkStatus();
        StatusOr<RenderOutputs> files =
            CheckViewOutputs(problem, out, view.name);
        if (!files.ok()) return files.status();
        if (!first) files->illumination = files->brdf = "";
        first = false;
        return WriteRenderOutputs(problem, rendered, *files);
      });
}

Status Run(const std::string& scene, const std::vector<std::string>& overrides,
           const RenderOutputs& out, bool explain, const CommonFlags& flags) {
  const StatusOr<Problem> problem = ReadProblem(scene, overrides);
  if (!problem.ok()) return problem.status();
  IBRDF_RETURN_IF_ERROR(CheckRenderable(*problem));
  return problem->views.given() ? RunViews(*problem, out, explain, flags)
                                : RunOne(*problem, out, explain, flags);
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Renders a scene file: known reflectance (1/sr) and illumination "
      "(W/(m^2 sr)) to radiance, with a tone-mapped PNG beside it. SIGINT ends "
      "it with nothing written (exit status 130).");
  CommonFlags flags;
  AddCommonFlags(&app, &flags);
  std::string scene, quality;
  std::vector<std::string> overrides;
  RenderOutputs out;
  app.add_option("--scene", scene, "scene file (YAML)")->required();
  app.add_option("--out", out.image,
                 "radiance to write, .exr; with `views` a folder, which gets "
                 "views/NAME/render.exr; needed without --explain");
  app.add_option("--mask", out.mask,
                 "mask of the object to write, .png; default: none; with "
                 "`views` each view has mask.png");
  app.add_option("--illumination-out", out.illumination,
                 "map used to write, .exr, in illumination.output_frame; "
                 "default: none");
  app.add_option("--brdf-out", out.brdf,
                 "BRDF as MERL table to write, .binary; default: none");
  app.add_option("--quality", quality,
                 "preview (one sample a pixel, coarse quadrature) or reference "
                 "(converged, 2x2 samples); default: the scene's, else "
                 "reference");
  app.add_option("--set", overrides,
                 "key.path=value overrides a key of the scene; repeatable; "
                 "e.g. --set noise=0.02 (standard deviation of log-normal "
                 "noise) --set image.width=256 (pixels)")
      ->expected(1)
      ->take_all();
  bool explain = false;
  app.add_flag("--explain", explain,
               "print what would be simulated, and how, and why; render "
               "nothing");
  return RunProgram(&app, argc, argv, [&]() -> Status {
    std::vector<std::string> all = overrides;
    if (!quality.empty()) all.push_back("quality=" + quality);
    return Run(scene, all, out, explain, flags);
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
