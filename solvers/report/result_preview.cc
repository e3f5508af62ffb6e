#include "ibrdf/solvers/report/result_preview.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/io/png.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/brdf_sphere.h"
#include "ibrdf/solvers/report/preview.h"
#include "ibrdf/solvers/report/result_images.h"

namespace ibrdf {
namespace {

// Percentile of the reference that is shown as white.
constexpr double kImageWhite = 99.0;
constexpr double kMapWhite = 97.0;  // bright lights and the sun may burn out
constexpr int kSphereSize = 96;
constexpr int kSkyHeight = 64;

using Row = std::vector<PreviewPanel>;

std::string White(double exposure) {
  return Format("white = %.3g", 1.0 / exposure);
}

PreviewPanel Picture(std::string label, const Image& image, const Mask& mask,
                     double exposure,
                     PreviewPanel::Kind kind = PreviewPanel::Kind::kRadiance) {
  PreviewPanel panel;
  panel.label = std::move(label);
  panel.image = image;
  panel.mask = mask;
  panel.exposure = exposure;
  panel.kind = kind;
  return panel;
}

Row ImagePanels(const ResultPreviewInput& input) {
  const double exposure = ExposureOf(input.input, input.mask, kImageWhite);
  Row row = {Picture("Input (" + White(exposure) + ", its 99th percentile)",
                     input.input, input.mask, exposure)};
  if (input.render.empty()) return row;
  row.push_back(Picture("Render of the estimate (same exposure)", input.render,
                        input.mask, exposure));
  if (input.residual.empty()) return row;
  row.push_back(Picture("Residual log(render / input), mean of R, G, B",
                        input.residual, input.mask, 1.0,
                        PreviewPanel::Kind::kSignedResidual));
  return row;
}

// Factor that brings the estimate to the reference's mean logarithm, over the
// values of both that are > 0; 1 where there is none.
class MeanLogRatio {
 public:
  void Add(double estimate, double reference, double weight) {
    if (!(estimate > 0.0 && reference > 0.0)) return;
    if (!std::isfinite(estimate) || !std::isfinite(reference)) return;
    sum_ += weight * std::log(reference / estimate);
    weight_ += weight;
  }
  double Factor() const {
    return weight_ > 0.0 ? std::exp(sum_ / weight_) : 1.0;
  }

 private:
  double sum_ = 0.0, weight_ = 0.0;
};

// Maps of one size.
double MapScale(const Image& estimate, const Image& reference) {
  MeanLogRatio ratio;
  for (size_t k = 0; k < estimate.rgb.size(); ++k) {
    const int row = static_cast<int>(k / 3 / estimate.width);
    ratio.Add(estimate.rgb[k], reference.rgb[k],
              TexelSolidAngle(row, estimate.height, estimate.width));
  }
  return ratio.Factor();
}

double BrdfScale(const MerlTable& estimate, const MerlTable& reference) {
  MeanLogRatio ratio;
  for (size_t k = 0; k < reference.raw.size(); ++k) {
    ratio.Add(estimate.raw[k], reference.raw[k], 1.0);
  }
  return ratio.Factor();
}

// Explained by kScaleFootnote.
std::string Times(double scale) { return Format(", times %.3g", scale); }
constexpr char kScaleFootnote[] =
    "An estimate beside its reference is shown times the factor in its label: "
    "one for all channels, which brings its mean logarithm to the reference's.";

Row MapPanels(const ResultPreviewInput& input) {
  if (input.illumination.empty()) return {};
  const auto kind = PreviewPanel::Kind::kMap;
  const std::string seen =
      "seen from the object: the middle is " + input.middle_of_map;
  if (input.illumination_known || input.reference_illumination.empty()) {
    const double exposure = ExposureOf(input.illumination, Mask(), kMapWhite);
    return {
        Picture(std::string(input.illumination_known ? "Known" : "Estimated") +
                    " illumination (" + White(exposure) +
                    ", its 97th percentile), " + seen,
                MapForPicture(input.illumination), Mask(), exposure, kind)};
  }
  const Image reference =
      ResizeMap(input.reference_illumination, input.illumination.height,
                input.illumination.width);
  const double exposure = ExposureOf(reference, Mask(), kMapWhite);
  const double scale = MapScale(input.illumination, reference);
  return {Picture("Estimated illumination" + Times(scale) + ", " + seen,
                  MapForPicture(input.illumination), Mask(), scale * exposure,
                  kind),
          Picture("Reference illumination (" + White(exposure) +
                      ", its 97th percentile), " + seen,
                  MapForPicture(reference), Mask(), exposure, kind)};
}

struct Spheres {
  Image directional, sky;
};

Spheres RenderSpheres(const MerlTable& table, int num_threads) {
  const BrdfFunction brdf = [&table](double theta_h, double theta_d,
                                     double phi_d) {
    return InterpolateMerl(table, theta_h, theta_d, phi_d);
  };
  return {RenderBrdfSphere(brdf, StudioLights(), kSphereSize),
          RenderBrdfSphere(table, ProceduralSky(kSkyHeight, 2 * kSkyHeight),
                           kSphereSize, num_threads)};
}

Row BrdfPanels(const ResultPreviewInput& input) {
  if (input.brdf.raw.empty()) return {};
  const Mask mask = BrdfSphereMask(kSphereSize);
  const Spheres estimate = RenderSpheres(input.brdf, input.num_threads);
  const bool compare = !input.reference_brdf.raw.empty();
  const Spheres reference =
      compare ? RenderSpheres(input.reference_brdf, input.num_threads)
              : estimate;
  const double scale =
      compare ? BrdfScale(input.brdf, input.reference_brdf) : 1.0;
  const std::string name =
      "BRDF estimate" + (compare ? Times(scale) : std::string());
  Row row;
  const auto add = [&](const Image& estimated, const Image& known,
                       const std::string& light) {
    const double exposure = ExposureOf(known, mask, kImageWhite);
    row.push_back(
        Picture(name + ", " + light, estimated, mask, scale * exposure));
    if (compare) {
      row.push_back(Picture("BRDF reference, " + light, known, mask, exposure));
    }
  };
  add(estimate.directional, reference.directional, "directional lights");
  add(estimate.sky, reference.sky, "sky");
  return row;
}

Status CheckInput(const ResultPreviewInput& input) {
  const auto differs = [&](int width, int height) {
    return width != input.input.width || height != input.input.height;
  };
  if (input.input.empty()) return InvalidInput("preview: input", "no pixels");
  if (!input.mask.empty() && differs(input.mask.width, input.mask.height)) {
    return InvalidInput("preview: mask", "expected the size of the input");
  }
  if (!input.render.empty() &&
      differs(input.render.width, input.render.height)) {
    return InvalidInput("preview: render", "expected the size of the input");
  }
  if (!input.residual.empty() &&
      differs(input.residual.width, input.residual.height)) {
    return InvalidInput("preview: residual", "expected the size of the input");
  }
  const size_t entries = size_t{3} * kMerlBins;
  for (const MerlTable* table : {&input.brdf, &input.reference_brdf}) {
    if (!table->raw.empty() && table->raw.size() != entries) {
      return InvalidInput("preview: brdf", "expected a whole MERL table");
    }
  }
  return OkStatus();
}

ResultPanels MakeRows(const ResultPreviewInput& input) {
  return {ImagePanels(input), MapPanels(input), BrdfPanels(input)};
}

Rgb8Image ComposeOverview(const ResultPanels& rows,
                          const ResultPreviewInput& input) {
  std::vector<Row> shown;
  for (const Row* row : {&rows.images, &rows.maps, &rows.spheres}) {
    if (!row->empty()) shown.push_back(*row);
  }
  std::vector<std::string> notes = input.metrics;
  if (rows.maps.size() > 1 || rows.spheres.size() > 2) {
    notes.push_back(kScaleFootnote);
  }
  return ComposePanels(shown, input.title, notes);
}

}  // namespace

ResultPreviewInput PreviewInput(const SolvedProblem& solved) {
  ResultPreviewInput input;
  input.title = std::filesystem::path(solved.problem.path).filename().string();
  input.input = solved.inverse.image;
  input.mask = ObjectMask(solved.inverse);
  input.render = solved.solution.render;
  input.residual = LogResidual(solved.inverse, solved.solution);
  input.illumination = solved.solution.map;
  input.illumination_known = solved.inverse.known_map.has_value();
  input.reference_illumination = solved.truth.illumination;
  input.middle_of_map = MiddleOfMapPicture(solved.problem.camera);
  input.brdf = solved.solution.brdf;
  input.reference_brdf = solved.truth.brdf;
  input.metrics = MetricLines(solved.metrics);
  input.num_threads = solved.inverse.num_threads;
  return input;
}

Rgb8Image MakeOverview(const ResultPreviewInput& input) {
  return ComposeOverview(MakeRows(input), input);
}

StatusOr<ResultPanels> MakeResultPanels(const ResultPreviewInput& input) {
  IBRDF_RETURN_IF_ERROR(CheckInput(input));
  return MakeRows(input);
}

Status WriteResultPreviews(const ResultPanels& rows,
                           const ResultPreviewInput& input,
                           const std::string& out_dir) {
  IBRDF_RETURN_IF_ERROR(
      WritePng(ComposeOverview(rows, input), out_dir + "/overview.png"));
  const char* const names[] = {"input.png", "render.png", "residual.png"};
  for (size_t i = 0; i < rows.images.size(); ++i) {
    IBRDF_RETURN_IF_ERROR(WritePng(ComposePanels({{rows.images[i]}}, ""),
                                   out_dir + "/" + names[i]));
  }
  if (!rows.maps.empty()) {
    std::vector<Row> below;  // the maps one below the other
    for (const PreviewPanel& map : rows.maps) below.push_back({map});
    IBRDF_RETURN_IF_ERROR(
        WritePng(ComposePanels(below, ""), out_dir + "/illumination.png"));
  }
  if (!rows.spheres.empty()) {
    IBRDF_RETURN_IF_ERROR(
        WritePng(ComposePanels({rows.spheres}, ""), out_dir + "/brdf.png"));
  }
  return OkStatus();
}

Status WriteResultPreviews(const ResultPreviewInput& input,
                           const std::string& out_dir) {
  const StatusOr<ResultPanels> panels = MakeResultPanels(input);
  if (!panels.ok()) return panels.status();
  return WriteResultPreviews(*panels, input, out_dir);
}

}  // namespace ibrdf
