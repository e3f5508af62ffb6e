#include "ibrdf/solvers/report/result_preview.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/io/png.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/drawing/crop.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/brdf_sphere.h"
#include "ibrdf/solvers/report/material_labels.h"
#include "ibrdf/solvers/report/preview.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/report/report_limits.h"
#include "ibrdf/solvers/report/result_images.h"
#include "ibrdf/solvers/report/sphere_lookup.h"

namespace ibrdf {
namespace {

// Percentile of the reference that is shown as white.
constexpr double kImageWhite = 99.0;
constexpr double kMapWhite = 97.0;  // bright lights and the sun may burn out
// A sphere is drawn from kSphereSamples^2 values a pixel, so that its outline
// is smooth. In the sky it is rendered smaller, which takes most of the time,
// and looked up.
constexpr int kSphereSize = 288, kSphereSamples = 2;
constexpr int kSkySphereSize = 128;
constexpr int kSkyHeight = 64;
constexpr size_t kMostInRow = 4;  // panels

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
  const PixelBox box =
      BoxAround(input.mask, input.input.width, input.input.height);
  const Mask mask = Crop(input.mask, box);
  Row row = {Picture("Input (" + White(exposure) + ", its 99th percentile)",
                     Crop(input.input, box), mask, exposure)};
  if (input.render.empty()) return row;
  row.push_back(Picture("Render of the estimate (same exposure)",
                        Crop(input.render, box), mask, exposure));
  if (input.residual.empty()) return row;
  const Mask& used =
      input.residual_mask.empty() ? input.mask : input.residual_mask;
  row.push_back(
      Picture("Residual log(render / input), mean of R, G, B; the colours end "
              "at the 98th percentile of its magnitude",
              Crop(input.residual, box), Crop(used, box), 1.0,
              PreviewPanel::Kind::kSignedResidual));
  if (!input.labels.empty()) {
    row.push_back(Picture("Materials", Crop(input.labels, box), mask, 1.0));
  }
  return row;
}

// The render with its matte part in the paint's mean colour, grey.
Image RepaintedGrey(const ResultPreviewInput& input) {
  double sum = 0.0, count = 0.0;
  for (const float a : input.albedo.rgb) {
    if (!(a > 0.0f)) continue;
    sum += a;
    count += 1.0;
  }
  const double grey = count > 0.0 ? sum / count : 0.0;
  Image out = input.gloss;
  for (size_t i = 0; i < out.rgb.size(); ++i) {
    const double albedo = input.albedo.rgb[i];
    if (!(albedo > 0.0)) continue;
    const double matte =
        std::max(input.render.rgb[i] - input.gloss.rgb[i], 0.f);
    out.rgb[i] += static_cast<float>(matte * grey / albedo);
  }
  return out;
}

Row PaintPanels(const ResultPreviewInput& input) {
  if (input.albedo.empty() || input.render.empty()) return {};
  const PixelBox box =
      BoxAround(input.mask, input.input.width, input.input.height);
  const Mask mask = Crop(input.mask, box);
  const double of_albedo = ExposureOf(input.albedo, input.mask, kImageWhite);
  const double of_input = ExposureOf(input.input, input.mask, kImageWhite);
  return {Picture("Albedo of the paint (" + White(of_albedo) +
                      ", its 99th percentile)",
                  Crop(input.albedo, box), mask, of_albedo),
          Picture("Standard deviation of log albedo, its scale left out: 0.1 "
                  "is about 10 %, 0.7 a factor of two. The colours end at the "
                  "98th percentile",
                  Crop(input.albedo_log_std, box), mask, 1.0,
                  PreviewPanel::Kind::kDeviation),
          Picture("Gloss over it (the input's exposure)",
                  Crop(input.gloss, box), mask, of_input),
          Picture("Render repainted grey (the input's exposure)",
                  Crop(RepaintedGrey(input), box), mask, of_input)};
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
    return {Picture(
        std::string(input.illumination_known ? "Known" : "Estimated") +
            " light (" + White(exposure) + ", its 97th percentile), " + seen,
        MapForPicture(input.illumination), Mask(), exposure, kind)};
  }
  const Image reference =
      ResizeMap(input.reference_illumination, input.illumination.height,
                input.illumination.width);
  const double exposure = ExposureOf(reference, Mask(), kMapWhite);
  const double scale = MapScale(input.illumination, reference);
  return {Picture("Estimated light" + Times(scale) + ", " + seen,
                  MapForPicture(input.illumination), Mask(), scale * exposure,
                  kind),
          Picture("Reference light (" + White(exposure) +
                      ", its 97th percentile), " + seen,
                  MapForPicture(reference), Mask(), exposure, kind)};
}

// Each at an exposure of its own.
Row OtherLightPanels(const ResultPreviewInput& input) {
  Row row;
  for (const auto& [label, map] : input.other_lights) {
    row.push_back(Picture(label, MapForPicture(map), Mask(),
                          ExposureOf(map, Mask(), kMapWhite),
                          PreviewPanel::Kind::kMap));
  }
  return row;
}

// Pictures of a sphere, kSphereSamples values a pixel; the one in the sky as it
// was rendered, too.
struct Spheres {
  Image directional, sky, small_sky;
};

Image DirectionalSphere(const BrdfFunction& brdf, int num_threads) {
  return RenderBrdfSphere(brdf, StudioLights(), kSphereSamples * kSphereSize,
                          /*samples_per_side=*/1, num_threads);
}

std::vector<Spheres> RenderSpheres(const std::vector<const MerlTable*>& tables,
                                   int num_threads) {
  std::vector<Spheres> spheres(tables.size());
  std::vector<BrdfGrid> grids;
  for (size_t k = 0; k < tables.size(); ++k) {
    const MerlTable& table = *tables[k];
    spheres[k].directional = DirectionalSphere(
        [&table](double theta_h, double theta_d, double phi_d) {
          return InterpolateMerl(table, theta_h, theta_d, phi_d);
        },
        num_threads);
    grids.push_back(BrdfGrid::FromMerl(table, BrdfGridShape()));
  }
  std::vector<Image> in_sky =
      RenderBrdfSpheres(grids, ProceduralSky(kSkyHeight, 2 * kSkyHeight),
                        kSkySphereSize, num_threads);
  for (size_t k = 0; k < tables.size(); ++k) {
    spheres[k].small_sky = std::move(in_sky[k]);
    spheres[k].sky =
        ResizeSphere(spheres[k].small_sky, kSphereSamples * kSphereSize);
  }
  return spheres;
}

PreviewPanel SpherePanel(std::string label, const Image& sphere,
                         double exposure) {
  PreviewPanel panel =
      Picture(std::move(label), sphere, BrdfSphereMask(sphere.width), exposure);
  panel.samples = kSphereSamples;
  return panel;
}

double SphereExposure(const Image& sphere) {
  return ExposureOf(sphere, BrdfSphereMask(sphere.width), kImageWhite);
}

// `reference` is the estimate's where there is none.
Row SpherePanels(const ResultPreviewInput& input, const Spheres& estimate,
                 const Spheres& reference) {
  const bool compare = !input.reference_brdf.raw.empty();
  const double scale =
      compare ? BrdfScale(input.brdf, input.reference_brdf) : 1.0;
  const std::string name =
      "BRDF estimate" + (compare ? Times(scale) : std::string());
  Row row;
  const auto add = [&](const Image& estimated, const Image& known,
                       const std::string& light) {
    const double exposure = SphereExposure(known);
    row.push_back(
        SpherePanel(name + ", " + light, estimated, scale * exposure));
    if (compare) {
      row.push_back(SpherePanel("BRDF reference, " + light, known, exposure));
    }
  };
  add(estimate.directional, reference.directional, "directional lights");
  add(estimate.sky, reference.sky, "sky");
  return row;
}

// A sphere of each material, at an exposure of its own.
Row MaterialPanels(const ResultPreviewInput& input,
                   const std::vector<Spheres>& materials) {
  Row row;
  for (size_t m = 0; m < materials.size(); ++m) {
    const Image& sphere = materials[m].directional;
    row.push_back(SpherePanel("BRDF of " + input.materials[m].first +
                                  ", directional lights, at its own exposure",
                              sphere, SphereExposure(sphere)));
  }
  return row;
}

// RelitObject, each point in the light of its material's sphere.
Image RelitMaterials(const std::vector<const Image*>& spheres,
                     const std::vector<ShadingPoint>& points, int width,
                     int height) {
  if (spheres.size() == 1) {
    return RelitObject(*spheres[0], points, width, height);
  }
  Image all(width, height);
  for (size_t m = 0; m < spheres.size(); ++m) {
    std::vector<ShadingPoint> of_material;
    for (const ShadingPoint& point : points) {
      if (point.material == static_cast<int>(m)) of_material.push_back(point);
    }
    const Image one = RelitObject(*spheres[m], of_material, width, height);
    for (size_t i = 0; i < all.rgb.size(); ++i) all.rgb[i] += one.rgb[i];
  }
  return all;
}

// spheres: of each material.
Row RelitPanels(const ResultPreviewInput& input,
                const std::vector<Spheres>& spheres) {
  if (input.points == nullptr || input.points->empty()) return {};
  const int width = input.input.width, height = input.input.height;
  const PixelBox box = BoxAround(input.mask, width, height);
  const Mask mask = Crop(input.mask, box);
  const std::string what =
      input.albedo.empty() ? "The object" : "The object, unpainted,";
  Row row;
  const auto add = [&](Image Spheres::*of, const std::string& light) {
    std::vector<const Image*> lit;
    for (const Spheres& material : spheres) lit.push_back(&(material.*of));
    const Image relit =
        Crop(RelitMaterials(lit, *input.points, width, height), box);
    row.push_back(Picture(what + " relit: " + light + ", without shadows",
                          relit, mask, ExposureOf(relit, mask, kImageWhite)));
  };
  add(&Spheres::directional, "directional lights");
  add(&Spheres::small_sky, "sky");
  return row;
}

Row AlternativePanels(const ResultPreviewInput& input,
                      const Spheres& estimate) {
  if (input.alternatives.empty()) return {};
  Row row = {SpherePanel("The estimate", estimate.directional,
                         SphereExposure(estimate.directional))};
  for (const auto& [label, brdf] : input.alternatives) {
    const BrdfGrid& grid = brdf;
    const Image sphere = DirectionalSphere(
        [&grid](double theta_h, double theta_d, double phi_d) {
          return grid.Evaluate(theta_h, theta_d, phi_d);
        },
        input.num_threads);
    row.push_back(SpherePanel(label, sphere, SphereExposure(sphere)));
  }
  return row;
}

// How probable an alternative is, and how far off.
std::string AlternativeLabel(const Alternative& other) {
  return "Found from " + other.start + ": " + ProbabilityInWords(other.cost) +
         ", log differs by " + Format("%.2g", other.brdf_log_difference);
}

// The most probable reflectances that differ from the estimate, at most three.
std::vector<std::pair<std::string, BrdfGrid>> DrawnAlternatives(
    const SolvedProblem& solved) {
  constexpr size_t kMost = 3;
  const InverseProblem& inverse = solved.inverse;
  std::vector<std::pair<std::string, BrdfGrid>> drawn;
  for (const Alternative& other : solved.solution.alternatives) {
    if (drawn.size() == kMost) break;
    if (!(other.brdf_log_difference > kRivalDifference) ||
        !std::isfinite(other.cost) || other.lobe_parameters.empty()) {
      continue;
    }
    const FlowLobes lobes(*inverse.model,
                          LobeLayout::OfSize(other.lobe_parameters.size(),
                                             inverse.model->shape.code_size()),
                          BrdfGridShape(), inverse.num_threads);
    drawn.emplace_back(AlternativeLabel(other),
                       lobes.Grid(other.lobe_parameters.data()));
  }
  return drawn;
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
  if (!input.residual_mask.empty() &&
      differs(input.residual_mask.width, input.residual_mask.height)) {
    return InvalidInput("preview: residual mask",
                        "expected the size of the input");
  }
  for (const Image* of_paint :
       {&input.albedo, &input.gloss, &input.albedo_log_std}) {
    if (!input.albedo.empty() && differs(of_paint->width, of_paint->height)) {
      return InvalidInput("preview: paint", "expected the size of the input");
    }
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
  ResultPanels panels;
  panels.images = ImagePanels(input);
  panels.paint = PaintPanels(input);
  panels.maps = MapPanels(input);
  panels.other_lights = OtherLightPanels(input);
  if (input.brdf.raw.empty()) return panels;
  if (input.materials.size() > 1) {
    std::vector<const MerlTable*> tables;
    for (const auto& [label, brdf] : input.materials) tables.push_back(&brdf);
    const std::vector<Spheres> materials =
        RenderSpheres(tables, input.num_threads);
    panels.spheres = MaterialPanels(input, materials);
    panels.relit = RelitPanels(input, materials);
    return panels;
  }
  panels.spheres_compared = !input.reference_brdf.raw.empty();
  std::vector<const MerlTable*> tables = {&input.brdf};
  if (panels.spheres_compared) tables.push_back(&input.reference_brdf);
  const std::vector<Spheres> spheres = RenderSpheres(tables, input.num_threads);
  panels.spheres = SpherePanels(input, spheres.front(), spheres.back());
  panels.relit = RelitPanels(input, {spheres.front()});
  panels.alternatives = AlternativePanels(input, spheres.front());
  return panels;
}

Rgb8Image ComposeOverview(const ResultPanels& rows,
                          const ResultPreviewInput& input) {
  std::vector<Row> shown;
  size_t of_spheres = 0;
  for (const Row* row : {&rows.images, &rows.paint, &rows.maps, &rows.spheres,
                         &rows.alternatives}) {
    if (row == &rows.spheres) of_spheres = shown.size();
    // Materials may be more than fit in a row.
    for (size_t k = 0; k < row->size(); k += kMostInRow) {
      shown.emplace_back(row->begin() + k,
                         row->begin() + std::min(k + kMostInRow, row->size()));
    }
  }
  // Two spheres leave room for the object in their lights.
  if (rows.spheres.size() == 2) {
    Row& spheres = shown[of_spheres];
    spheres.insert(spheres.end(), rows.relit.begin(), rows.relit.end());
  } else if (!rows.relit.empty()) {
    shown.push_back(rows.relit);
  }
  std::vector<std::string> notes = input.metrics;
  if (rows.maps.size() > 1 || rows.spheres_compared) {
    notes.push_back(kScaleFootnote);
  }
  return ComposePanels(shown, input.title, notes);
}

}  // namespace

ResultPreviewInput PreviewInput(const SolvedProblem& solved) {
  ResultPreviewInput input;
  const auto name_of = [](const std::string& path) {
    return std::filesystem::path(path).filename().string();
  };
  const size_t others = solved.inverse.other_photographs.size();
  input.title =
      name_of(solved.problem.path) + ": " +
      (solved.inverse.sheet.empty()
           ? name_of(solved.problem.image.file)
           : std::to_string(solved.inverse.sheet.views.size()) + " views") +
      (others > 0 ? " and " + std::to_string(others) + " other lights" : "");
  input.input = solved.inverse.image;
  input.mask = ObjectMask(solved.inverse);
  input.render = solved.solution.render;
  input.residual = LogResidual(solved.inverse, solved.solution);
  input.residual_mask = UsedMask(solved.inverse);
  input.albedo = solved.solution.albedo;
  input.gloss = solved.solution.gloss;
  input.albedo_log_std = solved.solution.albedo_log_std;
  input.illumination = solved.solution.map;
  for (size_t k = 0; k < solved.solution.other_lights.size(); ++k) {
    const OtherLight& other = solved.solution.other_lights[k];
    input.other_lights.emplace_back(
        name_of(solved.inverse.other_photographs[k]->file) +
            Format(", misfit %.2g", other.misfit),
        other.map);
  }
  input.illumination_known = solved.inverse.known_map.has_value();
  input.reference_illumination = solved.truth.illumination;
  // Each of several views looks another way.
  if (solved.inverse.sheet.empty()) {
    input.middle_of_map = MiddleOfMapPicture(solved.problem.camera);
  }
  input.brdf = solved.solution.brdf;
  input.reference_brdf = solved.truth.brdf;
  input.alternatives = DrawnAlternatives(solved);
  if (solved.inverse.materials.size() > 1) {
    input.labels = LabelImage(solved.inverse);
    for (size_t m = 0; m < solved.solution.materials.size(); ++m) {
      input.materials.emplace_back(
          "label " + solved.inverse.materials[m].value + " (" +
              ColourOfMaterial(static_cast<int>(m)).name + ")",
          solved.solution.materials[m].brdf);
    }
  }
  input.points = &solved.inverse.points;
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
  for (size_t i = 0; i < std::min<size_t>(rows.images.size(), 3); ++i) {
    IBRDF_RETURN_IF_ERROR(WritePng(ComposePanels({{rows.images[i]}}, ""),
                                   out_dir + "/" + names[i]));
  }
  const char* const of_paint[] = {"albedo.png", "albedo_certainty.png",
                                  "gloss.png"};
  for (size_t i = 0; i < std::min<size_t>(rows.paint.size(), 3); ++i) {
    IBRDF_RETURN_IF_ERROR(WritePng(ComposePanels({{rows.paint[i]}}, ""),
                                   out_dir + "/" + of_paint[i]));
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
