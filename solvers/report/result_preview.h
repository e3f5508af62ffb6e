// The pictures of a result.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/report/preview.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// What there is to show; what is empty is left out.
struct ResultPreviewInput {
  std::string title;  // printable ASCII
  Image input;
  Mask mask;     // of the object, of the input's size; empty: all pixels
  Image render;  // of the input's size
  // log(render / input) where the pixel took part, else 0, of their size; and
  // which did (empty: as `mask`).
  Image residual;
  Mask residual_mask;
  // What Solution has of a painted object, of their size; empty: unpainted.
  Image albedo, gloss, albedo_log_std;
  Image illumination;               // in the library's frame
  bool illumination_known = false;  // nothing to compare with a reference
  Image reference_illumination;
  // The lights of other photographs of the object, each with its label.
  std::vector<std::pair<std::string, Image>> other_lights;
  std::string middle_of_map = "-z";  // of the pictures of maps, in words
  MerlTable brdf;
  MerlTable reference_brdf;
  // Labelled materials, by ShadingPoint::material, each with its label in
  // words; and the labels in colours, of the input's size. Both empty: one
  // material. Two or more are drawn in the place of `brdf`.
  std::vector<std::pair<std::string, MerlTable>> materials;
  Image labels;
  // Other reflectances that explain the image too, each with its label.
  std::vector<std::pair<std::string, BrdfGrid>> alternatives;
  // The object's points, to relight it with `brdf`; null: not drawn.
  const std::vector<ShadingPoint>* points = nullptr;
  std::vector<std::string> metrics;  // one line each, printable ASCII
  int num_threads = 0;               // <= 0: all
};

// Borrows the solved problem's points.
ResultPreviewInput PreviewInput(const SolvedProblem& solved);

// The overview: input, render and residual, cropped to the object; the maps;
// the BRDFs on spheres under the lights of report/brdf_sphere.h, the estimate's
// beside the reference's; the object relit under the same two lights, and
// spheres of other reflectances beside the estimate's. Input and render share
// an exposure, and so do each estimate and its reference; an estimate with a
// reference is first brought to the reference's scale by one factor for all
// channels, which its label states.
Rgb8Image MakeOverview(const ResultPreviewInput& input);

// The overview's rows of panels; empty where there is nothing to show.
struct ResultPanels {
  std::vector<PreviewPanel> images;  // input, render, residual, labels
  // Albedo, its standard deviation, gloss, repainted grey.
  std::vector<PreviewPanel> paint;
  std::vector<PreviewPanel> maps;  // estimate, reference; or known
  std::vector<PreviewPanel> other_lights;
  // Estimate and reference under each light; or each material.
  std::vector<PreviewPanel> spheres;
  bool spheres_compared = false;           // with references
  std::vector<PreviewPanel> relit;         // the object, under each light
  std::vector<PreviewPanel> alternatives;  // estimate, then the others
};

// Refuses an empty input and sizes that disagree.
StatusOr<ResultPanels> MakeResultPanels(const ResultPreviewInput& input);

// Writes overview.png, input.png, render.png, residual.png, albedo.png,
// albedo_certainty.png, gloss.png, illumination.png and brdf.png into
// `out_dir`, which exists; each whole or absent, and none for what is empty. Of
// the input, title and metrics are read.
Status WriteResultPreviews(const ResultPanels& panels,
                           const ResultPreviewInput& input,
                           const std::string& out_dir);

// The same of the input's panels; refuses what MakeResultPanels does.
Status WriteResultPreviews(const ResultPreviewInput& input,
                           const std::string& out_dir);

}  // namespace ibrdf
