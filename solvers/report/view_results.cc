#include "ibrdf/solvers/report/view_results.h"

#include <cmath>

#include "ibrdf/base/median.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/solvers/report/report_limits.h"

namespace ibrdf {
namespace {

Image CutOutOrEmpty(const Image& sheet, const SheetView& view) {
  return sheet.empty() ? Image() : CutOut(sheet, view);
}

// The part of all images that is the view's.
ResultPreviewInput OfView(const ResultPreviewInput& all,
                          const SheetView& view) {
  ResultPreviewInput one;
  one.title = all.title + ", view " + view.name;
  one.input = CutOut(all.input, view);
  one.mask = CutOut(all.mask, view);
  one.render = CutOutOrEmpty(all.render, view);
  one.residual = CutOutOrEmpty(all.residual, view);
  one.residual_mask = CutOut(all.residual_mask, view);
  one.albedo = CutOutOrEmpty(all.albedo, view);
  one.gloss = CutOutOrEmpty(all.gloss, view);
  one.albedo_log_std = CutOutOrEmpty(all.albedo_log_std, view);
  one.labels = CutOutOrEmpty(all.labels, view);
  one.num_threads = all.num_threads;
  return one;
}

}  // namespace

std::vector<ViewMisfit> OddViews(const std::vector<ViewMisfit>& views) {
  std::vector<double> misfits;
  for (const ViewMisfit& view : views) {
    if (std::isfinite(view.misfit)) misfits.push_back(view.misfit);
  }
  std::vector<ViewMisfit> odd;
  if (misfits.size() < 3) return odd;  // of two, either may be wrong
  const double usual = UpperMedian(std::move(misfits));
  for (const ViewMisfit& view : views) {
    if (view.misfit > kLargeMisfit && view.misfit > kOddView * usual) {
      odd.push_back(view);
    }
  }
  return odd;
}

const std::vector<std::string>& PaintFiles() {
  static const std::vector<std::string> names = {
      "albedo.exr", "gloss.exr", "albedo_log_std.exr",
      "albedo.png", "gloss.png", "albedo_certainty.png"};
  return names;
}

std::vector<std::string> ViewPaths(const ViewSheet& sheet,
                                   const std::string& folder) {
  std::vector<std::string> paths;
  for (const SheetView& view : sheet.views) {
    std::vector<std::string> names = {"input.png",    "render.exr",
                                      "render.png",   "residual.exr",
                                      "residual.png", "overview.png"};
    names.insert(names.end(), PaintFiles().begin(), PaintFiles().end());
    for (const std::string& name : names) {
      paths.push_back(ViewFolder(folder, view.name) + "/" + name);
    }
  }
  return paths;
}

Status WriteViews(const SolvedProblem& solved, const ResultPreviewInput& all,
                  const std::string& folder) {
  const ViewSheet& sheet = solved.inverse.sheet;
  for (const SheetView& view : sheet.views) {
    const std::string own = ViewFolder(folder, view.name);
    IBRDF_RETURN_IF_ERROR(PrepareFolder(own));
    if (!solved.solution.has_paint()) {
      RemoveEarlier(solved.problem, own, PaintFiles());
    }
    const ResultPreviewInput one = OfView(all, view);
    IBRDF_RETURN_IF_ERROR(WriteExr(one.render, own + "/render.exr"));
    IBRDF_RETURN_IF_ERROR(WriteExr(one.residual, own + "/residual.exr"));
    if (solved.solution.has_paint()) {
      IBRDF_RETURN_IF_ERROR(WriteExr(one.albedo, own + "/albedo.exr"));
      IBRDF_RETURN_IF_ERROR(WriteExr(one.gloss, own + "/gloss.exr"));
      IBRDF_RETURN_IF_ERROR(
          WriteExr(one.albedo_log_std, own + "/albedo_log_std.exr"));
    }
    IBRDF_RETURN_IF_ERROR(WriteResultPreviews(one, own));
  }
  return OkStatus();
}

}  // namespace ibrdf
