// The reader of the section `image`.
#include <cstdint>
#include <string>

#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {

void ReadImageSpec(ProblemReader reader, bool others, ImageSpec* image) {
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
  if (others && !reader.Has("file") && !sized) return;
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

void ReadOtherLights(ProblemReader* root, Problem* problem) {
  if (!root->Has("images")) return;
  std::vector<std::string> files;
  root->Read("images", &files);
  ImageSpec* const image = &problem->image;
  ReflectanceVariation* const variation = &problem->reflectance.variation;
  if (files.empty()) return;  // the reader has told
  if (files.size() > kMaxOtherLights + 1) {
    return root->FailExpected(
        "images", "at most " + std::to_string(kMaxOtherLights + 1) + " files");
  }
  if (!image->file.empty() || image->width > 0 || !image->brackets.empty()) {
    return root->Fail("images",
                      "expected without image.file, brackets or a size");
  }
  if (problem->views.given()) {
    return root->Fail("images", "expected without views");
  }
  image->file = files.front();
  image->other_lights.assign(files.begin() + 1, files.end());
  if (files.size() == 1) return;
  if (problem->kind != ProblemKind::kJoint) {
    return root->Fail("images", "several need problem: joint");
  }
  if (image->response >= ResponseChoice::kUnknown) {
    return root->Fail("images", "several need a known image.response");
  }
  if (*variation == ReflectanceVariation::kAuto) {
    *variation = ReflectanceVariation::kAlbedo;
  }
  if (*variation != ReflectanceVariation::kAlbedo) {
    root->Fail("images", "several need reflectance.variation: albedo");
  }
}

}  // namespace ibrdf
