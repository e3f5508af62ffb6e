// Labelled materials in a result: their colours, files and pictures.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// What a material is drawn in where labels are shown, by
// ShadingPoint::material: kMostLabels different ones.
struct LabelColour {
  const char* name;
  uint8_t srgb[3];
};
const LabelColour& ColourOfMaterial(int material);

// The labels of an object's pixels in these colours; black elsewhere.
Rgb8Image LabelPicture(const InverseProblem& inverse);
// The same as radiance of which 1 is white.
Image LabelImage(const InverseProblem& inverse);

// "brdf_128", the name of a label's files without their ends.
std::string MaterialFile(const MaterialLabel& label);

// Names of the files in a folder that are called as those of labels are.
std::vector<std::string> FilesOfLabels(const std::string& folder);

// The solution as if the object were of one of its materials.
Solution OfMaterial(const Solution& solution, int material);

}  // namespace ibrdf
