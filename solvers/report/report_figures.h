// The pictures of a report.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/solvers/report/result_preview.h"

namespace ibrdf {

struct ReportFigure {
  enum class Bar {
    kNone,
    kSigned,    // colours from -range to range
    kPositive,  // from 0 to range
  };
  std::string caption;
  Rgb8Image pixels;
  Bar bar = Bar::kNone;
  double range = 0.0;
  bool smooth = false;  // may be blurred to be enlarged, as by a browser
  bool map = false;     // equirectangular: directions are named below it
};

// Pictures that belong together, and what to look for.
struct ReportGroup {
  std::string heading, text;
  std::vector<ReportFigure> figures;  // not empty
};

// Image, illumination with the standard deviation of its logarithm (empty:
// none), reflectance with `material` in words (may be empty), the object relit,
// other reflectances. Pictures have at most 1024 pixels a side.
std::vector<ReportGroup> MakeReportGroups(const ResultPanels& panels,
                                          const Image& map_std,
                                          const std::string& material = "");

// The group as a <section>. Fails on a picture that no PNG can hold.
StatusOr<std::string> GroupSection(const ReportGroup& group);

}  // namespace ibrdf
