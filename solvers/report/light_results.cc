#include "ibrdf/solvers/report/light_results.h"

#include <algorithm>
#include <filesystem>

#include "ibrdf/base/format.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/solvers/problem/of_photograph.h"
#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/report/result_images.h"
#include "ibrdf/solvers/report/result_preview.h"
#include "ibrdf/solvers/report/view_results.h"

namespace ibrdf {
namespace {

std::string NameOf(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

Status WriteOne(const SolvedProblem& solved, size_t k,
                const std::string& folder) {
  const InverseProblem inverse = OfPhotograph(solved.inverse, k);
  const OtherLight& light = solved.solution.other_lights[k];
  Solution solution;
  solution.render = light.render;
  solution.epsilon = solved.solution.epsilon;
  const Image residual = LogResidual(inverse, solution);
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
  IBRDF_RETURN_IF_ERROR(WriteMap(light.map,
                                 solved.problem.illumination.output_frame,
                                 folder + "/illumination.exr"));
  IBRDF_RETURN_IF_ERROR(WriteExr(light.render, folder + "/render.exr"));
  IBRDF_RETURN_IF_ERROR(WriteExr(residual, folder + "/residual.exr"));
  ResultPreviewInput preview;
  preview.title = NameOf(solved.problem.path) + ": " +
                  NameOf(solved.inverse.other_photographs[k]->file);
  preview.input = inverse.image;
  preview.mask = ObjectMask(inverse);
  preview.render = light.render;
  preview.residual = residual;
  preview.residual_mask = UsedMask(inverse);
  preview.illumination = light.map;
  preview.middle_of_map = MiddleOfMapPicture(solved.problem.camera);
  preview.metrics = {"misfit " + Format("%.4g", light.misfit)};
  return WriteResultPreviews(preview, folder);
}

}  // namespace

std::string PhotographFolder(const std::string& folder, size_t k) {
  return (std::filesystem::path(folder) / "images" / std::to_string(k + 2))
      .string();
}

std::vector<std::string> OtherLightPaths(size_t begin, size_t end,
                                         const std::string& folder) {
  std::vector<std::string> paths;
  for (size_t k = begin; k < end; ++k) {
    for (const char* name :
         {"illumination.exr", "illumination.png", "render.exr", "render.png",
          "residual.exr", "residual.png", "input.png", "overview.png"}) {
      paths.push_back(PhotographFolder(folder, k) + "/" + name);
    }
  }
  return paths;
}

Status WriteOtherLights(const SolvedProblem& solved,
                        const std::string& folder) {
  for (size_t k = 0; k < solved.solution.other_lights.size(); ++k) {
    IBRDF_RETURN_IF_ERROR(WriteOne(solved, k, PhotographFolder(folder, k)));
  }
  return OkStatus();
}

std::string OddPhotographs(const SolvedProblem& solved) {
  const double usual = std::max(kLargeMisfit, kOddView * solved.metrics.misfit);
  const std::vector<OtherLight>& lights = solved.solution.other_lights;
  std::string names;
  for (size_t k = 0; k < lights.size(); ++k) {
    if (!(lights[k].misfit > usual)) continue;
    names += (names.empty() ? "" : ", ") +
             solved.inverse.other_photographs[k]->file + " (misfit " +
             Format("%.2g", lights[k].misfit) + ")";
  }
  return names;
}

}  // namespace ibrdf
