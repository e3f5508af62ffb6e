#include "ibrdf/solvers/problem/with_labels.h"

#include <glog/logging.h>

#include <string>
#include <unordered_map>

namespace ibrdf {
namespace {

MaterialLabel LabelOf(size_t material) {
  return {std::to_string(material + 1), 0};
}

}  // namespace

std::vector<bool> BesideOtherLabels(const std::vector<ShadingPoint>& points,
                                    int image_width,
                                    const std::vector<int>& labels) {
  CHECK_GT(image_width, 0);
  CHECK_EQ(points.size(), labels.size());
  std::unordered_map<int, int> label_at;
  for (size_t i = 0; i < points.size(); ++i) {
    label_at[points[i].pixel] = labels[i];
  }
  std::vector<bool> beside(points.size(), false);
  for (size_t i = 0; i < points.size(); ++i) {
    const int x = points[i].pixel % image_width;
    const int left = x > 0 ? -1 : 0, right = x + 1 < image_width ? 1 : 0;
    for (int down = -1; down <= 1; ++down) {
      for (int across = left; across <= right; ++across) {
        const auto at =
            label_at.find(points[i].pixel + down * image_width + across);
        if (at != label_at.end() && at->second != labels[i]) beside[i] = true;
      }
    }
  }
  return beside;
}

InverseProblem WithLabels(InverseProblem problem,
                          const std::vector<int>& labels) {
  CHECK_EQ(labels.size(), problem.points.size());
  problem.materials.clear();
  const std::vector<bool> beside =
      BesideOtherLabels(problem.points, problem.image.width, labels);
  std::vector<size_t> inside;  // points of each label that no other is beside
  for (size_t i = 0; i < labels.size(); ++i) {
    CHECK_GE(labels[i], 0);
    const auto label = static_cast<size_t>(labels[i]);
    while (problem.materials.size() <= label) {
      problem.materials.push_back(LabelOf(problem.materials.size()));
      inside.push_back(0);
    }
    problem.points[i].material = labels[i];
    ++problem.materials[label].pixels;
    inside[label] += beside[i] ? 0 : 1;
  }
  for (size_t i = 0; i < labels.size(); ++i) {
    problem.points[i].mixed = beside[i] && inside[labels[i]] > 0;
  }
  return problem;
}

std::vector<MaterialLabel> LabelsToBeFound() {
  std::vector<MaterialLabel> labels;
  while (labels.size() < kMostFoundLabels) {
    labels.push_back(LabelOf(labels.size()));
  }
  return labels;
}

}  // namespace ibrdf
