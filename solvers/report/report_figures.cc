#include "ibrdf/solvers/report/report_figures.h"

#include "ibrdf/base/format.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/preview.h"
#include "ibrdf/solvers/report/result_images.h"

namespace ibrdf {
namespace {

constexpr int kMaxSide = 1024;  // the page stays small
// Wider pictures are smoothed by the browser, the pixels of others stay
// squares.
constexpr int kSmoothWidth = 500;

ReportFigure Figure(const PreviewPanel& panel) {
  PanelPicture picture = DrawPanel(panel, kMaxSide);
  ReportFigure figure;
  figure.caption = panel.label;
  figure.pixels = std::move(picture.pixels);
  figure.range = picture.range;
  figure.smooth = panel.samples > 1 || figure.pixels.width >= kSmoothWidth;
  figure.map = panel.kind == PreviewPanel::Kind::kMap;
  if (panel.kind == PreviewPanel::Kind::kSignedResidual) {
    figure.bar = ReportFigure::Bar::kSigned;
  } else if (panel.kind == PreviewPanel::Kind::kDeviation) {
    figure.bar = ReportFigure::Bar::kPositive;
  }
  return figure;
}

ReportFigure DeviationFigure(const Image& map_std) {
  PreviewPanel panel;
  panel.label = "Standard deviation of log radiance, mean of R, G, B (" +
                std::to_string(map_std.width) + "x" +
                std::to_string(map_std.height) +
                " texels). 0.1 is about 10 %, 0.7 a factor of two.";
  panel.image = MapForPicture(map_std);
  panel.kind = PreviewPanel::Kind::kDeviation;
  ReportFigure figure = Figure(panel);
  figure.map = true;
  return figure;
}

ReportGroup Group(std::string heading, std::string text,
                  const std::vector<PreviewPanel>& panels) {
  ReportGroup group{std::move(heading), std::move(text), {}};
  for (const PreviewPanel& panel : panels) {
    group.figures.push_back(Figure(panel));
  }
  return group;
}

std::string CssColour(double t) {
  uint8_t rgb[3];
  DivergingColour(t, rgb);
  return Format("rgb(%d %d %d)", rgb[0], rgb[1], rgb[2]);
}

std::string Labels(const std::vector<std::string>& labels) {
  std::string out = "<div class=\"labels\">";
  for (const std::string& label : labels) out += HtmlElement("span", label);
  return out + "</div>\n";
}

std::string ColourBar(const ReportFigure& figure) {
  if (figure.bar == ReportFigure::Bar::kNone) return "";
  const bool is_signed = figure.bar == ReportFigure::Bar::kSigned;
  const std::string high = Format(is_signed ? "+%.2g" : "%.2g", figure.range);
  const std::string low = Format("-%.2g", figure.range);
  std::string colours = CssColour(0.0) + "," + CssColour(1.0);
  if (is_signed) colours = CssColour(-1.0) + "," + colours;
  return "<div class=\"bar\" style=\"background:linear-gradient(to right," +
         colours + ")\"></div>\n" +
         (is_signed ? Labels({low, "0", high}) : Labels({"0", high}));
}

StatusOr<std::string> FigureMarkup(const ReportFigure& figure) {
  const StatusOr<std::string> png = EncodePng(figure.pixels);
  if (!png.ok()) return png.status();
  std::string out = figure.map ? "<figure class=\"wide\">\n" : "<figure>\n";
  out += std::string("<img ") + (figure.smooth ? "" : "class=\"pixels\" ") +
         "width=\"" + std::to_string(figure.pixels.width) + "\" height=\"" +
         std::to_string(figure.pixels.height) + "\" alt=\"" +
         EscapeHtml(figure.caption) + "\" src=\"" + PngDataUri(*png) +
         "\" />\n";
  if (figure.map) out += Labels({"+z", "-x", "-z", "+x", "+z"});
  out += ColourBar(figure);
  return out + HtmlElement("figcaption", figure.caption) + "\n</figure>\n";
}

constexpr char kImageNote[] =
    "The residual should look like noise: red is rendered too bright, blue too "
    "dark. Where it has structure, the estimate does not explain the image. "
    "Grey pixels took no part. The colours end at the 98th percentile of the "
    "residual's magnitude over the pixels that took part.";

constexpr char kMapNote[] =
    "Equirectangular maps of the light that arrives at the object, seen from "
    "the object, in the world frame. The columns look along the axes named "
    "below a map, the top row looks up (+y). The orthographic camera looks "
    "along -z: the middle is what it looks at, behind the object, the edges "
    "are behind the camera, and right in the map is right in the picture. "
    "These pictures are in the frame camera; result.json says under "
    "illumination_frame which frame the .exr files have.";

constexpr char kPaintNote[] =
    "What varies over the object, albedo.exr, how far to trust it, "
    "albedo_log_std.exr, and what lies over it, gloss.exr. "
    "The image does not tell the paint's colour from the light's: a change of "
    "hue over the object is taken for paint. In the grey render only shading "
    "and gloss should be left. Paint that shows there was taken for light.";

constexpr char kOtherLightsNote[] =
    "Photographs of one view share the paint and the reflectance, which was "
    "found from the first. Each map is drawn as the one above, at an exposure "
    "of its own. The folders images/2, images/3, ... have the maps and "
    "renders.";

constexpr char kDeviationNote[] =
    " The standard deviation is that of the light given the reflectance. Where "
    "it is large, the image says nothing and the map shows the prior.";

constexpr char kSphereNote[] =
    "Spheres of the material under three directional lights and under an "
    "artificial sky.";

constexpr char kRelitNote[] =
    "The estimated material on this shape, in the light of the spheres above. "
    "The light goes with the camera. Shadows and bounces are left out. Each "
    "picture has its own exposure.";

constexpr char kOthersNote[] =
    "Spheres of the local optima that differ from the estimate, the most "
    "probable first, under the directional lights. Where the evidence is "
    "within "
    "a factor of twenty, this image does not tell which one is right.";

// Explains the factor in an estimate's caption.
constexpr char kScaleNote[] =
    " An estimate beside its reference is shown times the factor in its "
    "caption. It is one factor for all channels, which brings the mean "
    "logarithm of the estimate to that of the reference.";

}  // namespace

std::vector<ReportGroup> MakeReportGroups(const ResultPanels& panels,
                                          const Image& map_std,
                                          const std::string& material) {
  std::vector<ReportGroup> groups;
  if (!panels.images.empty()) {
    groups.push_back(Group("Image", kImageNote, panels.images));
  }
  if (!panels.paint.empty()) {
    groups.push_back(Group("Paint", kPaintNote, panels.paint));
  }
  if (!panels.maps.empty()) {
    groups.push_back(Group("Light", kMapNote, panels.maps));
    if (panels.maps.size() > 1) groups.back().text += kScaleNote;
    if (!map_std.empty()) {
      groups.back().text += kDeviationNote;
      groups.back().figures.push_back(DeviationFigure(map_std));
    }
  }
  if (!panels.other_lights.empty()) {
    groups.push_back(Group("Light of the other photographs", kOtherLightsNote,
                           panels.other_lights));
  }
  if (!panels.spheres.empty()) {
    groups.push_back(Group("Reflectance", kSphereNote, panels.spheres));
    if (panels.spheres_compared) groups.back().text += kScaleNote;
    if (!material.empty()) groups.back().text += " " + material;
  }
  if (!panels.relit.empty()) {
    groups.push_back(
        Group("The object in other light", kRelitNote, panels.relit));
  }
  if (!panels.alternatives.empty()) {
    groups.push_back(Group("Other reflectances that were found", kOthersNote,
                           panels.alternatives));
  }
  return groups;
}

StatusOr<std::string> GroupSection(const ReportGroup& group) {
  std::string out = "<section>\n" + HtmlElement("h2", group.heading) + "\n" +
                    HtmlElement("p", group.text) +
                    "\n<div class=\"figures\">\n";
  for (const ReportFigure& figure : group.figures) {
    const StatusOr<std::string> markup = FigureMarkup(figure);
    if (!markup.ok()) return markup.status();
    out += *markup;
  }
  return out + "</div>\n</section>\n";
}

}  // namespace ibrdf
