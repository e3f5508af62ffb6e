#include "ibrdf/solvers/uncertainty_map/write_uncertainty.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/uncertainty_map/surface_pictures.h"
#include "ibrdf/solvers/uncertainty_map/uncertainty_json.h"
#include "ibrdf/solvers/uncertainty_map/uncertainty_page.h"

namespace ibrdf {
namespace {
namespace fs = std::filesystem;

constexpr int kLargestPicture = 8192;
// Views with photograph and entropy on the page.
constexpr size_t kShownViews = 6;

std::string InFolder(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

// The files that a transforms file or a model names are inputs, too.
Status CheckInputsStay(const Problem& problem, const UncertaintyResult& result,
                       const std::string& out_dir) {
  std::vector<std::string> paths;
  for (const char* name : {"entropy.exr", "entropy.png", "alpha.exr", "ks.exr",
                           "below_band_limit.png", "observed_views.exr",
                           kNextViewsFile, "result.json", "report.html"}) {
    paths.push_back(InFolder(out_dir, name));
  }
  std::vector<NamedFile> photographs;
  for (const PhotographedView& view : result.inputs.views) {
    const std::string folder = ViewFolder(out_dir, view.name);
    paths.push_back(InFolder(folder, "entropy.exr"));
    paths.push_back(InFolder(folder, "entropy.png"));
    photographs.push_back({"view " + view.name, view.file});
  }
  return CheckNothingReplaced(problem, paths, photographs);
}

Status WriteEntropy(const EntropyMaps& maps, const TexelRows& rows,
                    const std::string& folder) {
  IBRDF_RETURN_IF_ERROR(WriteExr(PictureOf(rows, maps.entropy, 3),
                                 InFolder(folder, "entropy.exr")));
  return WritePng(DrawTexels(rows, maps.MinimumEntropy(), 1.0, kLargestPicture),
                  InFolder(folder, "entropy.png"));
}

Status WriteTextures(const TexelEntropy& texels, const TexelRows& rows,
                     const std::string& out_dir) {
  IBRDF_RETURN_IF_ERROR(WriteEntropy(texels.maps, rows, out_dir));
  IBRDF_RETURN_IF_ERROR(WriteExr(PictureOf(rows, texels.maps.alpha, 3),
                                 InFolder(out_dir, "alpha.exr")));
  IBRDF_RETURN_IF_ERROR(WriteExr(PictureOf(rows, texels.maps.Ks, 3),
                                 InFolder(out_dir, "ks.exr")));
  const std::vector<float> seen(texels.observed_views.begin(),
                                texels.observed_views.end());
  IBRDF_RETURN_IF_ERROR(WriteExr(PictureOf(rows, seen, 1),
                                 InFolder(out_dir, "observed_views.exr")));
  Mask below(rows.width, rows.height, 0);
  for (size_t i = 0; i < rows.row.size(); ++i) {
    below.inside[i] =
        rows.row[i] >= 0 ? texels.below_band_limit[rows.row[i]] : 0;
  }
  return WriteMask(below, InFolder(out_dir, "below_band_limit.png"));
}

// Returns the rows of the first views, which the page shows.
StatusOr<std::vector<TexelRows>> WriteViews(const UncertaintyResult& result,
                                            const TexelRows& texture,
                                            int num_threads,
                                            const std::string& out_dir) {
  std::vector<TexelRows> shown;
  for (const PhotographedView& view : result.inputs.views) {
    TexelRows rows =
        RowsOfView(result.inputs.surface.scene, texture, view.camera,
                   view.radiance.width, view.radiance.height, num_threads);
    const std::string folder = ViewFolder(out_dir, view.name);
    IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
    IBRDF_RETURN_IF_ERROR(WriteEntropy(result.texels.maps, rows, folder));
    if (shown.size() < kShownViews) shown.push_back(std::move(rows));
  }
  return shown;
}

}  // namespace

Status WriteUncertainty(const Problem& problem,
                        const UncertaintyOptions& options,
                        const std::string& out_dir, UncertaintyResult* result) {
  const Stopwatch watch;
  IBRDF_RETURN_IF_ERROR(CheckInputsStay(problem, *result, out_dir));
  const TexelRows texture = RowsOfTexture(result->inputs.surface.atlas);
  IBRDF_RETURN_IF_ERROR(WriteTextures(result->texels, texture, out_dir));
  const StatusOr<std::vector<TexelRows>> views =
      WriteViews(*result, texture, options.num_threads, out_dir);
  if (!views.ok()) return views.status();
  RemoveEarlier(problem, out_dir, {kNextViewsFile});
  if (result->next) {
    IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
        InFolder(out_dir, kNextViewsFile),
        NextViewsText(result->next->candidates, result->next->chosen,
                      problem.geometry.up)));
  }
  result->stages.push_back({"pictures", watch.Seconds()});
  IBRDF_RETURN_IF_ERROR(
      WriteFileAtomically(InFolder(out_dir, "result.json"),
                          UncertaintyJsonText(problem, options, *result)));
  const StatusOr<std::string> page =
      UncertaintyPage(problem, *result, texture, *views);
  if (!page.ok()) return page.status();
  return WriteFileAtomically(InFolder(out_dir, "report.html"), *page);
}

}  // namespace ibrdf
