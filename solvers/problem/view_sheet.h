// Several photographs as one image.
//
// A solve knows points, and of each the pixel that it fills. Photographs laid
// out on one sheet give every point a pixel of its own, whichever view it is
// of: what is done pixel by pixel, or among neighbours, needs to know no more.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// A photograph's place on the sheet.
struct SheetView {
  std::string name;        // ViewNameFault (io/calibrated_views.h)
  std::string file, mask;  // that were read; mask empty: none
  Camera camera;
  int x = 0, y = 0;           // of its top left pixel
  int width = 0, height = 0;  // pixels
};

struct ViewSheet {
  int width = 0, height = 0;
  std::vector<SheetView> views;  // empty: one photograph, which is no sheet

  bool empty() const { return views.empty(); }
};

// Views of these sizes, each given with its name and camera, in rows of as
// many: some pixels apart, so that no two of different views are neighbours.
ViewSheet LayOut(std::vector<SheetView> views);

// Copies a photograph [H, W, 3] to its place.
void Place(const Image& photograph, const SheetView& view, Image* sheet);
// The same of a mask; an empty one holds all of the photograph.
void Place(const Mask& mask, const SheetView& view, Mask* sheet);
// What the sheet has of a view.
Image CutOut(const Image& sheet, const SheetView& view);
Mask CutOut(const Mask& sheet, const SheetView& view);

// Points of a view, each of a pixel of its photograph, become points of the
// sheet; view: its number. `index` is left alone.
void MoveToSheet(const ViewSheet& sheet, int view,
                 std::vector<ShadingPoint>* points);

}  // namespace ibrdf
