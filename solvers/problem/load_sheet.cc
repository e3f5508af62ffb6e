#include "ibrdf/solvers/problem/load_sheet.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/solvers/problem/photographed_views.h"

namespace ibrdf {
namespace {

// A view's radiance and where it is bounded, in the sheet's.
void PlaceRadiance(const Photograph& photograph, const SheetView& view,
                   Photograph* sheet) {
  Place(photograph.radiance, view, &sheet->radiance);
  if (!sheet->bounds) return;
  const bool bounded = photograph.bounds.has_value();
  Place(bounded ? photograph.bounds->low : photograph.radiance, view,
        &sheet->bounds->low);
  Place(bounded ? photograph.bounds->high : photograph.radiance, view,
        &sheet->bounds->high);
}

// Codes of a curve that is to be found, of all views together.
Status PlaceCodes(const ViewPhotograph& photographed, const SheetView& view,
                  Photograph* sheet) {
  if (!sheet->unknown_curve) return OkStatus();
  const std::optional<UnknownCurve>& curve =
      photographed.photograph.unknown_curve;
  const CodeLevels& levels = sheet->unknown_curve->levels;
  if (!curve || curve->levels.bits != levels.bits ||
      curve->levels.black != levels.black ||
      curve->levels.white != levels.white ||
      curve->levels.clip != levels.clip || curve->levels.step != levels.step) {
    return InvalidInput(photographed.file,
                        "expected codes of one depth in all views, as their "
                        "curve is to be found");
  }
  Place(curve->codes, view, &sheet->unknown_curve->codes);
  return OkStatus();
}

// The sheet's photograph with nothing on it yet.
Photograph EmptySheet(const std::vector<ViewPhotograph>& views,
                      const ViewSheet& sheet) {
  Photograph out;
  out.radiance = Image(sheet.width, sheet.height);
  out.mask = Mask(sheet.width, sheet.height, uint8_t{0});
  for (const ViewPhotograph& view : views) {
    const Photograph& one = view.photograph;
    out.codes |= one.codes;
    out.missing += one.missing;
    if (one.bounds) out.bounds = {out.radiance, out.radiance};
    if (one.unknown_curve) {
      out.unknown_curve = {out.radiance, one.unknown_curve->levels,
                           one.unknown_curve->families};
    }
  }
  out.curve = views.front().photograph.curve;
  return out;
}

}  // namespace

StatusOr<PhotographSheet> LoadPhotographSheet(const Problem& problem) {
  std::vector<ViewPhotograph> views;
  std::vector<std::string> warnings;
  int64_t pixels = 0;
  // Too many are refused before they fill the memory.
  const auto take = [&](ViewPhotograph view) {
    const Image& radiance = view.photograph.radiance;
    pixels += int64_t{radiance.width} * radiance.height;
    if (pixels > kMaxImagePixels) {
      return InvalidInput(
          problem.path + ": views (all together)",
          "expected at most " + std::to_string(kMaxImagePixels) +
              " pixels, found " + std::to_string(pixels) + " up to view " +
              view.name + "; give fewer or smaller images");
    }
    views.push_back(std::move(view));
    return OkStatus();
  };
  IBRDF_RETURN_IF_ERROR(ReadViewPhotographs(problem, take, &warnings));
  std::vector<SheetView> placed;
  for (const ViewPhotograph& view : views) {
    const Image& radiance = view.photograph.radiance;
    placed.push_back({view.name, view.file, view.mask, view.camera, 0, 0,
                      radiance.width, radiance.height});
  }
  PhotographSheet out;
  out.sheet = LayOut(std::move(placed));
  IBRDF_RETURN_IF_ERROR(CheckImageSize(problem.path + ": views (all together)",
                                       out.sheet.width, out.sheet.height));
  out.photograph = EmptySheet(views, out.sheet);
  for (size_t v = 0; v < views.size(); ++v) {
    const SheetView& place = out.sheet.views[v];
    PlaceRadiance(views[v].photograph, place, &out.photograph);
    IBRDF_RETURN_IF_ERROR(PlaceCodes(views[v], place, &out.photograph));
    Place(views[v].photograph.mask, place, &out.photograph.mask);
    views[v].photograph = Photograph();  // the memory of one sheet
  }
  out.photograph.warnings = std::move(warnings);
  return out;
}

StatusOr<Image> LoadLabelSheet(const Problem& problem, const ViewSheet& sheet) {
  Image labels(sheet.width, sheet.height);
  for (size_t v = 0; v < sheet.views.size(); ++v) {
    const SheetView& view = sheet.views[v];
    const std::string& file = problem.views.list[v].labels;
    const StatusOr<Photo> photo = ReadPhoto(file);
    if (!photo.ok()) return photo.status();
    const Image& image = photo->image;
    if (image.width != view.width || image.height != view.height) {
      return InvalidInput(file + ": labels of view " + view.name,
                          "expected the image's size " +
                              SizeName(view.width, view.height) + ", found " +
                              SizeName(image.width, image.height));
    }
    Place(image, view, &labels);
  }
  return labels;
}

std::string PhotographsName(const Problem& problem) {
  const ViewsSpec& views = problem.views;
  if (!problem.image.file.empty()) return problem.image.file;
  if (!views.transforms.empty()) return views.transforms;
  return views.colmap.empty() ? problem.path + ": views" : views.colmap;
}

}  // namespace ibrdf
