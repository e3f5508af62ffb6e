// The reader of the section `image`.
#include <cstdint>
#include <string>

#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {

void ReadImageSpec(ProblemReader reader, bool views, ImageSpec* image) {
  reader.Read("file", &image->file);
  reader.Read("mask", &image->mask);
  reader.Read("layer", &image->layer);
  reader.Read("response", &image->response);
  reader.Read("response_parameter", &image->response_parameter);
  reader.Read("white", &image->white);
  reader.Read("black", &image->black);
  reader.Read("exposure", &image->exposure);
  reader.Read("brackets", &image->brackets);
  reader.Read("bracket_exposures", &image->bracket_exposures);
  reader.Read("width", &image->width);
  reader.Read("height", &image->height);
  const bool sized = reader.Has("width") || reader.Has("height");
  if (views && !reader.Has("file") && !sized) return;
  if (reader.Has("file") == sized) {
    reader.Fail(reader.Has("file")
                    ? "expected either file or width and height, found both"
                    : "expected file or width and height");
  } else if (reader.Has("width") != reader.Has("height")) {
    reader.Fail("expected both width and height");
  } else if (int64_t{image->width} * image->height > kMaxImagePixels) {
    reader.Fail("expected at most " + std::to_string(kMaxImagePixels) +
                " pixels");
  }
}

}  // namespace ibrdf
