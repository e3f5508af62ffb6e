#include "ibrdf/solvers/report/view_results.h"

#include <cmath>

#include "ibrdf/base/median.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/report/result_images.h"
#include "ibrdf/solvers/report/result_preview.h"

namespace ibrdf {
namespace {

// What only painted objects have.
const std::vector<std::string>& PaintNames() {
  static const std::vector<std::string> names = {"albedo.exr", "gloss.exr",
                                                 "albedo.png", "gloss.png"};
  return names;
}

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
  one.labels = CutOutOrEmpty(all.labels, view);
  one.num_threads = all.num_threads;
  return one;
}

}  // namespace

std::vector<ViewMisfit> MisfitOfViews(const InverseProblem& inverse,
                                      const Solution& solution) {
  std::vector<ViewMisfit> views;
  if (inverse.sheet.empty()) return views;
  for (const SheetView& view : inverse.sheet.views) {
    views.push_back({view.name, 0});
  }
  const Image residual = LogResidual(inverse, solution);
  const Mask used = UsedMask(inverse);
  std::vector<double> sums(views.size(), 0.0);
  for (const ShadingPoint& point : inverse.points) {
    if (used.inside[point.pixel] == 0) continue;
    const auto v = static_cast<size_t>(point.view);
    ++views[v].pixels;
    for (int c = 0; c < 3; ++c) {
      sums[v] += std::abs(residual.rgb[size_t{3} * point.pixel + c]) / 3.0;
    }
  }
  for (size_t v = 0; v < views.size(); ++v) {
    if (views[v].pixels == 0) continue;
    views[v].misfit = sums[v] / static_cast<double>(views[v].pixels);
  }
  return views;
}

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

std::string ViewFolder(const std::string& folder, const std::string& name) {
  return folder + "/views/" + name;
}

std::vector<std::string> ViewPaths(const ViewSheet& sheet,
                                   const std::string& folder) {
  std::vector<std::string> paths;
  for (const SheetView& view : sheet.views) {
    std::vector<std::string> names = {"input.png",    "render.exr",
                                      "render.png",   "residual.exr",
                                      "residual.png", "overview.png"};
    names.insert(names.end(), PaintNames().begin(), PaintNames().end());
    for (const std::string& name : names) {
      paths.push_back(ViewFolder(folder, view.name) + "/" + name);
    }
  }
  return paths;
}

Status WriteViews(const SolvedProblem& solved, const std::string& folder) {
  const ViewSheet& sheet = solved.inverse.sheet;
  if (sheet.empty()) return OkStatus();
  const ResultPreviewInput all = PreviewInput(solved);
  for (const SheetView& view : sheet.views) {
    const std::string own = ViewFolder(folder, view.name);
    IBRDF_RETURN_IF_ERROR(PrepareFolder(own));
    if (!solved.solution.has_paint()) {
      RemoveEarlier(solved.problem, own, PaintNames());
    }
    const ResultPreviewInput one = OfView(all, view);
    IBRDF_RETURN_IF_ERROR(WriteExr(one.render, own + "/render.exr"));
    IBRDF_RETURN_IF_ERROR(WriteExr(one.residual, own + "/residual.exr"));
    if (solved.solution.has_paint()) {
      IBRDF_RETURN_IF_ERROR(WriteExr(one.albedo, own + "/albedo.exr"));
      IBRDF_RETURN_IF_ERROR(WriteExr(one.gloss, own + "/gloss.exr"));
    }
    IBRDF_RETURN_IF_ERROR(WriteResultPreviews(one, own));
  }
  return OkStatus();
}

}  // namespace ibrdf
