#include "ibrdf/solvers/programs/render_outputs.h"

#include <filesystem>
#include <vector>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/problem/load_scene.h"

namespace ibrdf {
namespace {

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
std::string PreviewPath(const RenderOutputs& out) {
  return std::filesystem::path(out.image).replace_extension(".png").string();
}

// A scene's truth may be what this makes.
Status CheckOnlyTruthReplaced(const Problem& problem,
                              const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    IBRDF_RETURN_IF_ERROR(PreparePath(path));
  }
  Problem read = problem;
  read.truth = {};
  return CheckNothingReplaced(read, paths);
}

// Checks --out and --mask.
Status CheckImagePaths(const Problem& problem, const RenderOutputs& out) {
  if (!problem.views.given()) {
    if (out.image.empty()) {
      return InvalidInput("command line: --out",
                          "expected an .exr file, found nothing");
    }
    IBRDF_RETURN_IF_ERROR(RequireExtension(out.image, "exr", "--out"));
    return RequireExtension(out.mask, "png", "--mask");
  }
  if (out.image.empty() || FileExtension(out.image) == "exr") {
    return InvalidInput(
        "command line: --out",
        "expected a folder for several views, found '" + out.image + "'");
  }
  if (!out.mask.empty()) {
    return InvalidInput("command line: --mask",
                        "expected without views, which have mask.png each");
  }
  return PrepareFolder(out.image);
}

}  // namespace

Status CheckRenderOutputs(const Problem& problem, const RenderOutputs& out) {
  IBRDF_RETURN_IF_ERROR(CheckImagePaths(problem, out));
  IBRDF_RETURN_IF_ERROR(
      RequireExtension(out.illumination, "exr", "--illumination-out"));
  IBRDF_RETURN_IF_ERROR(RequireExtension(out.brdf, "binary", "--brdf-out"));
  std::vector<std::string> paths = {out.illumination, out.brdf};
  if (!problem.views.given()) {
    paths.insert(paths.end(), {out.image, PreviewPath(out), out.mask});
  }
  return CheckOnlyTruthReplaced(problem, paths);
}

StatusOr<RenderOutputs> CheckViewOutputs(const Problem& problem,
                                         const RenderOutputs& out,
                                         const std::string& view) {
  const std::filesystem::path folder = ViewFolder(out.image, view);
  RenderOutputs files = out;
  files.image = (folder / "render.exr").string();
  files.mask = (folder / "mask.png").string();
  IBRDF_RETURN_IF_ERROR(CheckOnlyTruthReplaced(
      problem, {files.image, PreviewPath(files), files.mask}));
  return files;
}

Status WriteRenderOutputs(const Problem& problem, const RenderedScene& rendered,
                          const RenderOutputs& out) {
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

}  // namespace ibrdf
