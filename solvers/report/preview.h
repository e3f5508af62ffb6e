// Labelled pictures of radiance, residuals and maps.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"

namespace ibrdf {

struct PreviewPanel {
  enum class Kind {
    kRadiance,        // image times exposure, as sRGB
    kSignedResidual,  // mean of the channels, in DivergingColour
    kDeviation,       // the same of values >= 0: the colour bar begins at 0
    kMap,             // as kRadiance, in the frame camera, with the axes below
  };
  std::string label;  // printable ASCII, wrapped
  Image image;
  Kind kind = Kind::kRadiance;
  // Pixels outside are neutral grey, as are pixels that are NaN; empty: none.
  Mask mask;
  double exposure = 1.0;
  // Columns and rows of the image that make one pixel of its picture, by their
  // mean in linear light: > 1 smooths outlines. Then it is not enlarged.
  int samples = 1;
  // Where there is a colour bar: the value at its ends; 0: the 98th percentile
  // of the magnitude over the mask's pixels.
  double range = 0.0;
};

// The picture of one panel alone, without any text.
struct PanelPicture {
  Rgb8Image pixels;
  double range = 0.0;  // where there is a bar: value at the ends of the colours
};

// One pixel of the picture for one of the image, or fewer where a side would
// exceed max_side > 0: reduced by area in linear light.
PanelPicture DrawPanel(const PreviewPanel& panel, int max_side);

// Rows of panels on a light ground, the title above and the notes below, at
// most 1440 pixels wide where words allow. Small images are enlarged by the
// largest whole factor that fits, pixels staying squares; where that is below
// 3, to what fits, linear between pixels. Large ones are reduced by area in
// linear light. The size and factor stand below each. No text overlaps another.
// Panels have pixels, rows panels.
Rgb8Image ComposePanels(const std::vector<std::vector<PreviewPanel>>& rows,
                        const std::string& title,
                        const std::vector<std::string>& notes = {});

}  // namespace ibrdf
