// Forward render of a scene file.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/programs/common_flags.h"

namespace ibrdf {
namespace {

std::atomic<bool> stop_requested{false};
void RequestStop(int) { stop_requested = true; }

struct Outputs {
  std::string image, mask, illumination, brdf;
};

// Lines "render 40 %" on stderr: rewritten in place on a terminal, one for
// every tenth in a file; none in the first two seconds.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet)
      : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0) {}

  void Show(double share) {
    const std::chrono::duration<double> elapsed = Clock::now() - start_;
    const int percent = static_cast<int>(100.0 * share);
    if (quiet_ || percent == shown_) return;
    if (share < 1.0 && elapsed.count() < kSilentSeconds) return;
    if (shown_ < 0 && share >= 1.0) return;
    if (!terminal_ && percent / 10 == shown_ / 10 && shown_ >= 0) return;
    shown_ = percent;
    std::fprintf(
        stderr,
        terminal_ ? "\rrender %3d %%, %.0f s" : "render %d %%, %.0f s\n",
        percent, elapsed.count());
    if (terminal_ && share >= 1.0) std::fputc('\n', stderr);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kSilentSeconds = 2.0;
  const bool quiet_;
  const bool terminal_;
  const Clock::time_point start_ = Clock::now();
  int shown_ = -1;
};

// The brightest but one percent of the object's pixels reach white.
Rgb8Image Preview(const Image& image, const Mask& mask) {
  const double exposure = ExposureOf(image, mask, 99.0);
  Rgb8Image out(image.width, image.height);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    out.rgb[k] = EncodeSrgb(exposure * image.rgb[k]);
  }
  return out;
}

Status RequireExtension(const std::string& path, const std::string& wanted,
                        const std::string& option) {
  if (path.empty() || FileExtension(path) == wanted) return OkStatus();
  return InvalidInput("command line: " + option,
                      "expected a ." + wanted + " file, found '" + path + "'");
}

// Makes the folder of an output, which may be empty.
Status PreparePath(const std::string& path) {
  if (path.empty()) return OkStatus();
  const std::string folder = std::filesystem::path(path).parent_path().string();
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder.empty() ? "." : folder));
  if (std::filesystem::is_directory(path)) {
    return InvalidInput(path, "expected a file, found a folder");
  }
  return OkStatus();
}

// What is written beside the radiance.
std::string PreviewPath(const Outputs& out) {
  return std::filesystem::path(out.image).replace_extension(".png").string();
}

// Before time is spent.
Status CheckOutputs(const Problem& problem, const Outputs& out) {
  IBRDF_RETURN_IF_ERROR(RequireExtension(out.image, "exr", "--out"));
  IBRDF_RETURN_IF_ERROR(RequireExtension(out.mask, "png", "--mask"));
  IBRDF_RETURN_IF_ERROR(
      RequireExtension(out.illumination, "exr", "--illumination-out"));
  IBRDF_RETURN_IF_ERROR(RequireExtension(out.brdf, "binary", "--brdf-out"));
  const std::vector<std::string> paths = {out.image, PreviewPath(out), out.mask,
                                          out.illumination, out.brdf};
  for (const std::string& path : paths) {
    IBRDF_RETURN_IF_ERROR(PreparePath(path));
  }
  // A scene's truth may be what this makes.
  Problem read = problem;
  read.truth = {};
  return CheckNothingReplaced(read, paths);
}

Status WriteOutputs(const Problem& problem, const RenderedScene& rendered,
                    const Outputs& out) {
  IBRDF_RETURN_IF_ERROR(WriteExr(rendered.image, out.image));
  const std::string preview = PreviewPath(out);
  if (preview != out.mask) {
    IBRDF_RETURN_IF_ERROR(
        WritePng(Preview(rendered.image, rendered.mask), preview));
  }
  if (!out.mask.empty()) {
    IBRDF_RETURN_IF_ERROR(WriteMask(rendered.mask, out.mask));
  }
  if (!out.illumination.empty()) {
    IBRDF_RETURN_IF_ERROR(WriteMap(rendered.illumination,
                                   problem.illumination.output_frame,
                                   out.illumination));
  }
  if (out.brdf.empty()) return OkStatus();
  if (rendered.painted_brdf) return WriteMerl(*rendered.painted_brdf, out.brdf);
  const StatusOr<MerlTable> table = LoadKnownReflectance(problem.reflectance);
  if (!table.ok()) return table.status();
  return WriteMerl(*table, out.brdf);
}

// Until SIGINT or SIGTERM.
StatusOr<RenderedScene> RenderWithProgress(const Problem& problem, bool explain,
                                           const CommonFlags& flags) {
  ProgressLine progress(flags.quiet);
  RenderSceneOptions options;
  options.seed = flags.seed;
  options.num_threads = flags.threads;
  options.progress = [&](double share) {
    progress.Show(share);
    return !stop_requested;
  };
  options.plan_only = explain;
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  return RenderScene(problem, options);
}

Status Run(const std::string& scene, const std::vector<std::string>& overrides,
           const Outputs& out, bool explain, const CommonFlags& flags) {
  const StatusOr<Problem> problem = ReadProblem(scene, overrides);
  if (!problem.ok()) return problem.status();
  IBRDF_RETURN_IF_ERROR(CheckRenderable(*problem));
  if (!explain) {
    if (out.image.empty()) {
      return InvalidInput("command line: --out",
                          "expected an .exr file, found nothing");
    }
    IBRDF_RETURN_IF_ERROR(CheckOutputs(*problem, out));
  }
  const StatusOr<RenderedScene> rendered =
      RenderWithProgress(*problem, explain, flags);
  if (!rendered.ok()) return rendered.status();
  PrintWarnings(rendered->warnings);
  if (explain || !flags.quiet) {
    std::printf("effects: %s\n", Describe(*rendered).c_str());
  }
  return explain ? OkStatus() : WriteOutputs(*problem, *rendered, out);
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
  Outputs out;
  app.add_option("--scene", scene, "scene file (YAML)")->required();
  app.add_option("--out", out.image,
                 "radiance to write, .exr; needed without --explain");
  app.add_option("--mask", out.mask,
                 "mask of the object to write, .png; default: none");
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
