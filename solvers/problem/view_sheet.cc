#include "ibrdf/solvers/problem/view_sheet.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ibrdf {
namespace {

// Pixels: more than anything that compares neighbours looks across.
constexpr int kGap = 4;

void CheckOnSheet(const SheetView& view, int width, int height) {
  CHECK(view.x + view.width <= width && view.y + view.height <= height);
}

// Where a view's row begins among values of the sheet, `channels` per pixel.
ptrdiff_t RowOf(const SheetView& view, int y, int sheet_width, int channels) {
  return (static_cast<ptrdiff_t>(view.y + y) * sheet_width + view.x) * channels;
}

// Rows of `channels` values per pixel of a photograph, to the sheet.
template <typename T>
void PlaceRows(const SheetView& view, int sheet_width, int channels,
               const T* photograph, T* sheet) {
  const auto length = static_cast<ptrdiff_t>(view.width) * channels;
  for (int y = 0; y < view.height; ++y) {
    std::copy_n(photograph + y * length, length,
                sheet + RowOf(view, y, sheet_width, channels));
  }
}

// The way back.
template <typename T>
void CutRows(const SheetView& view, int sheet_width, int channels,
             const T* sheet, T* photograph) {
  const auto length = static_cast<ptrdiff_t>(view.width) * channels;
  for (int y = 0; y < view.height; ++y) {
    std::copy_n(sheet + RowOf(view, y, sheet_width, channels), length,
                photograph + y * length);
  }
}

}  // namespace

ViewSheet LayOut(std::vector<SheetView> views) {
  ViewSheet sheet;
  const auto columns = static_cast<size_t>(
      std::ceil(std::sqrt(static_cast<double>(views.size()))));
  int x = 0, y = 0, row_height = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    if (i > 0 && i % columns == 0) {
      y += row_height + kGap;
      x = row_height = 0;
    }
    views[i].x = x;
    views[i].y = y;
    x += views[i].width + kGap;
    row_height = std::max(row_height, views[i].height);
    sheet.width = std::max(sheet.width, x - kGap);
    sheet.height = y + row_height;
  }
  sheet.views = std::move(views);
  return sheet;
}

void Place(const Image& photograph, const SheetView& view, Image* sheet) {
  CHECK(photograph.width == view.width && photograph.height == view.height);
  CheckOnSheet(view, sheet->width, sheet->height);
  PlaceRows(view, sheet->width, 3, photograph.rgb.data(), sheet->rgb.data());
}

void Place(const Mask& mask, const SheetView& view, Mask* sheet) {
  if (mask.empty()) {
    Place(Mask(view.width, view.height, uint8_t{1}), view, sheet);
    return;
  }
  CHECK(mask.width == view.width && mask.height == view.height);
  CheckOnSheet(view, sheet->width, sheet->height);
  PlaceRows(view, sheet->width, 1, mask.inside.data(), sheet->inside.data());
}

Image CutOut(const Image& sheet, const SheetView& view) {
  CheckOnSheet(view, sheet.width, sheet.height);
  Image out(view.width, view.height);
  CutRows(view, sheet.width, 3, sheet.rgb.data(), out.rgb.data());
  return out;
}

Mask CutOut(const Mask& sheet, const SheetView& view) {
  CheckOnSheet(view, sheet.width, sheet.height);
  Mask out(view.width, view.height, uint8_t{0});
  CutRows(view, sheet.width, 1, sheet.inside.data(), out.inside.data());
  return out;
}

void MoveToSheet(const ViewSheet& sheet, int view,
                 std::vector<ShadingPoint>* points) {
  const SheetView& place = sheet.views[static_cast<size_t>(view)];
  for (ShadingPoint& point : *points) {
    const int x = point.pixel % place.width, y = point.pixel / place.width;
    point.pixel = (place.y + y) * sheet.width + place.x + x;
    point.view = view;
  }
}

}  // namespace ibrdf
