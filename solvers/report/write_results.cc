#include "ibrdf/solvers/report/write_results.h"

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/problem/with_labels.h"
#include "ibrdf/solvers/report/light_results.h"
#include "ibrdf/solvers/report/material_labels.h"
#include "ibrdf/solvers/report/material_summary.h"
#include "ibrdf/solvers/report/report_figures.h"
#include "ibrdf/solvers/report/report_page.h"
#include "ibrdf/solvers/report/result_images.h"
#include "ibrdf/solvers/report/result_json.h"
#include "ibrdf/solvers/report/result_preview.h"
#include "ibrdf/solvers/report/view_results.h"

namespace ibrdf {
namespace {

// Previews of reflectance and map, the table; and what grows with the image.
constexpr double kWriteSeconds = 1.5;
constexpr double kWriteSecondsPerMegapixel = 2.0;

// Left by an earlier run, the first would speak for what a run that is cut off
// leaves, and the others be taken for results of this one.
std::vector<std::string> EarlierNames(const SolvedProblem& solved,
                                      const std::string& folder) {
  const Solution& solution = solved.solution;
  std::vector<std::string> names = {"result.json", "report.html", "brdf.png"};
  if (solution.brdf.raw.empty()) {
    names.insert(names.end(), {"brdf.binary", "brdf.json"});
  }
  if (solution.map_std.rgb.empty()) {
    names.emplace_back("illumination_log_std.exr");
  }
  if (solution.map_variance_left.rgb.empty()) {
    names.emplace_back("illumination_variance_left.exr");
  }
  if (!solution.has_paint()) {
    names.insert(names.end(), PaintFiles().begin(), PaintFiles().end());
  }
  if (solution.materials.empty()) names.emplace_back("labels.png");
  const std::vector<std::string> of_labels = FilesOfLabels(folder);
  names.insert(names.end(), of_labels.begin(), of_labels.end());
  const std::vector<std::string> of_lights =
      OtherLightPaths(solution.other_lights.size(), kMaxOtherLights, "");
  names.insert(names.end(), of_lights.begin(), of_lights.end());
  if (solved.next_views == nullptr) names.emplace_back(kNextViewsFile);
  return names;
}

// Those of labelled materials beside the main one's.
Status WriteMaterials(const SolvedProblem& solved, const std::string& folder) {
  const std::vector<MaterialLabel>& labels = solved.inverse.materials;
  if (solved.solution.materials.empty()) return OkStatus();
  for (size_t m = 0; m < labels.size(); ++m) {
    const Solution one = OfMaterial(solved.solution, static_cast<int>(m));
    const std::string path = folder + "/" + MaterialFile(labels[m]);
    IBRDF_RETURN_IF_ERROR(WriteMerl(one.brdf, path + ".binary"));
    IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
        path + ".json", BrdfJson({solved.problem, solved.inverse, solved.truth,
                                  one, solved.metrics})));
  }
  return WritePng(LabelPicture(solved.inverse), folder + "/labels.png");
}

// In words, each of labelled materials by itself.
std::string WordsOf(const SolvedProblem& solved,
                    const MaterialSummary& material) {
  const Solution& solution = solved.solution;
  if (solution.materials.size() < 2) return MaterialWords(material);
  std::string words;
  for (size_t m = 0; m < solution.materials.size(); ++m) {
    words += (m == 0 ? "Label " : " Label ") +
             solved.inverse.materials[m].value + ": " +
             MaterialWords(SummariseMaterial(
                 solved.inverse, OfMaterial(solution, static_cast<int>(m))));
  }
  return words;
}

Status WriteReflectance(const SolvedProblem& solved,
                        const std::string& folder) {
  const MerlTable& brdf = solved.solution.brdf;
  if (brdf.raw.empty()) return OkStatus();
  IBRDF_RETURN_IF_ERROR(WriteMerl(brdf, folder + "/brdf.binary"));
  return WriteFileAtomically(folder + "/brdf.json", BrdfJson(solved));
}

Status WriteRadiance(const SolvedProblem& solved, const std::string& folder) {
  const Solution& solution = solved.solution;
  const MapFrame frame = solved.problem.illumination.output_frame;
  IBRDF_RETURN_IF_ERROR(
      WriteMap(solution.map, frame, folder + "/illumination.exr"));
  if (!solution.map_std.rgb.empty()) {
    IBRDF_RETURN_IF_ERROR(WriteMap(solution.map_std, frame,
                                   folder + "/illumination_log_std.exr"));
  }
  if (!solution.map_variance_left.rgb.empty()) {
    IBRDF_RETURN_IF_ERROR(WriteMap(solution.map_variance_left, frame,
                                   folder + "/illumination_variance_left.exr"));
  }
  IBRDF_RETURN_IF_ERROR(WriteExr(solution.render, folder + "/render.exr"));
  if (solution.has_paint()) {
    IBRDF_RETURN_IF_ERROR(WriteExr(solution.albedo, folder + "/albedo.exr"));
    IBRDF_RETURN_IF_ERROR(WriteExr(solution.gloss, folder + "/gloss.exr"));
    IBRDF_RETURN_IF_ERROR(
        WriteExr(solution.albedo_log_std, folder + "/albedo_log_std.exr"));
  }
  return WriteExr(LogResidual(solved.inverse, solution),
                  folder + "/residual.exr");
}

}  // namespace

double PredictWriteSeconds(const InverseProblem& inverse) {
  const double megapixels = 1e-6 * inverse.image.width * inverse.image.height;
  return kWriteSeconds + kWriteSecondsPerMegapixel * megapixels;
}

std::vector<std::string> ResultPaths(const Problem& problem,
                                     const PhotographedObject& object,
                                     const std::string& folder) {
  std::vector<std::string> paths = {
      "result.json",  "report.html", "illumination.exr", "render.exr",
      "residual.exr", "input.png",   "render.png",       "residual.png",
      "overview.png", "brdf.png",    "illumination.png"};
  if (!problem.reflectance.known()) {
    paths.insert(paths.end(), {"brdf.binary", "brdf.json"});
  }
  if (!problem.illumination.known()) {
    paths.insert(paths.end(), {"illumination_log_std.exr",
                               "illumination_variance_left.exr"});
  }
  if (problem.reflectance.variation == ReflectanceVariation::kAuto ||
      problem.reflectance.variation == ReflectanceVariation::kAlbedo) {
    paths.insert(paths.end(), PaintFiles().begin(), PaintFiles().end());
  }
  const std::vector<MaterialLabel> labels =
      problem.reflectance.finds_labels() ? LabelsToBeFound() : object.materials;
  for (const MaterialLabel& label : labels) {
    for (const char* end : {".binary", ".json"}) {
      paths.push_back(MaterialFile(label) + end);
    }
  }
  if (!labels.empty()) paths.emplace_back("labels.png");
  for (std::string& path : paths) path.insert(0, folder + "/");
  const std::vector<std::string> of_views = ViewPaths(object.sheet, folder);
  paths.insert(paths.end(), of_views.begin(), of_views.end());
  const std::vector<std::string> of_lights =
      OtherLightPaths(0, problem.image.other_lights.size(), folder);
  paths.insert(paths.end(), of_lights.begin(), of_lights.end());
  return paths;
}

Status WriteResults(const SolvedProblem& solved, const std::string& folder) {
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
  RemoveEarlier(solved.problem, folder, EarlierNames(solved, folder));
  IBRDF_RETURN_IF_ERROR(WriteReflectance(solved, folder));
  IBRDF_RETURN_IF_ERROR(WriteMaterials(solved, folder));
  IBRDF_RETURN_IF_ERROR(WriteRadiance(solved, folder));
  if (solved.next_views != nullptr) {
    IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
        folder + "/" + kNextViewsFile,
        NextViewsText(solved.next_views->candidates, solved.next_views->chosen,
                      solved.problem.geometry.up)));
  }
  const ResultPreviewInput preview = PreviewInput(solved);
  const StatusOr<ResultPanels> panels = MakeResultPanels(preview);
  if (!panels.ok()) return panels.status();
  IBRDF_RETURN_IF_ERROR(WriteResultPreviews(*panels, preview, folder));
  IBRDF_RETURN_IF_ERROR(WriteViews(solved, preview, folder));
  IBRDF_RETURN_IF_ERROR(WriteOtherLights(solved, folder));
  const MaterialSummary material =
      SummariseMaterial(solved.inverse, solved.solution);
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(folder + "/result.json",
                                            ResultJson(solved, material)));
  const StatusOr<std::string> page =
      ReportPage(solved, MakeReportGroups(*panels, solved.solution.map_std,
                                          WordsOf(solved, material)));
  if (!page.ok()) return page.status();
  return WriteFileAtomically(folder + "/report.html", *page);
}

}  // namespace ibrdf
