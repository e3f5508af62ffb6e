#include "ibrdf/solvers/photograph_check/colour_steps.h"

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "ibrdf/scene/num_views.h"

namespace ibrdf {
namespace {

// Pixels from one side of a step to the other: beyond an edge's blur and what
// JPEG makes of colour.
constexpr int kSpan = 3;
// Where the normal turns by more between them the surface has an edge itself.
constexpr double kMostTurn = 0.25;

// Means of two by two pixels, which noise changes little.
class Blocks {
 public:
  struct Block {
    Eigen::Vector2d colour, normal;
  };

  Blocks(const std::vector<NormalSample>& samples, int width, int height)
      : samples_(samples),
        width_(width),
        height_(height),
        at_(static_cast<size_t>(width) * height, -1) {
    for (size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector2i p = samples[i].position.cast<int>();
      at_[static_cast<size_t>(p.y()) * width + p.x()] = static_cast<int>(i);
    }
  }

  // The pixel and those right of and below it; empty where one is not seen.
  std::optional<Block> At(int x, int y) const {
    if (x + 1 >= width_ || y + 1 >= height_) return std::nullopt;
    Block mean = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    for (int k = 0; k < 4; ++k) {
      const int i = at_[static_cast<size_t>(y + k / 2) * width_ + x + k % 2];
      if (i < 0) return std::nullopt;
      mean.colour += samples_[i].LogColour() / 4.0;
      mean.normal += samples_[i].normal / 4.0;
    }
    return mean;
  }

 private:
  const std::vector<NormalSample>& samples_;
  const int width_, height_;
  std::vector<int> at_;  // places in samples_, -1: none
};

bool IsStep(const Blocks::Block& a, const std::optional<Blocks::Block>& b) {
  return b && (a.colour - b->colour).norm() >= kSharpStep &&
         (a.normal - b->normal).norm() <= kMostTurn;
}

}  // namespace

double SharpColourSteps(const std::vector<NormalSample>& samples,
                        int image_width, int image_height) {
  if (samples.empty()) return 0.0;
  const Blocks blocks(samples, image_width, image_height);
  size_t across = 0, down = 0;
  for (const NormalSample& sample : samples) {
    const Eigen::Vector2i p = sample.position.cast<int>();
    const std::optional<Blocks::Block> here = blocks.At(p.x(), p.y());
    if (!here) continue;
    if (IsStep(*here, blocks.At(p.x() + kSpan, p.y()))) ++across;
    if (IsStep(*here, blocks.At(p.x(), p.y() + kSpan))) ++down;
  }
  // A line's extents down and across; blocks of two meet each part of it once
  // more than kSpan.
  return std::hypot(static_cast<double>(across), static_cast<double>(down)) /
         ((kSpan + 1) * NumViews(samples) * ObjectSize(samples));
}

}  // namespace ibrdf
