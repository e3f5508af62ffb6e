// Which material each pixel of an object is of, from an image of labels.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// More values than these are smoothed edges, and no materials.
inline constexpr size_t kMostLabels = 16;

struct MaterialLabel {
  // The pixels' value as the file has it: "128", or "255_0_0" of a coloured
  // one.
  std::string value;
  size_t pixels = 0;  // of the object
};

struct MaterialLabels {
  std::vector<MaterialLabel> labels;  // by ShadingPoint::material
  std::vector<std::string> warnings;  // sentences that name the file
};

// Reads the file reflectance.labels and sets the points' materials: the values
// of their pixels, in order of red, then green, then blue. Points of a label of
// which no pixel can be used (finite and positive in all channels, away from
// the limb) are removed with a warning, unless those are all.
//
// Fails, naming file and key, where the file has another size than `radiance`,
// a value that is not finite, or more than kMostLabels values at the points.
StatusOr<MaterialLabels> LoadLabels(const std::string& path,
                                    const Image& radiance,
                                    std::vector<ShadingPoint>* points);

// The same of an image that is read.
StatusOr<MaterialLabels> LabelPoints(const std::string& path,
                                     const Image& labels, const Image& radiance,
                                     std::vector<ShadingPoint>* points);

// Index of the label of most pixels.
int MainMaterial(const std::vector<MaterialLabel>& labels);

}  // namespace ibrdf
