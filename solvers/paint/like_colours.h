// Pairs of points of one colour, which are of one paint, mostly.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

struct ColourPair {
  int first, second;  // indices of `chroma`
  double weight;      // (0, 1], by how alike they are
};

// Points whose log chromas differ by 1.5 `like` at most, weighted by a Gaussian
// of that deviation. Up to 5000 pairs, drawn at random with one seed; fewer
// where few of 400000 draws are alike.
std::vector<ColourPair> PairsOfLikeColour(
    const std::vector<Eigen::Array2d>& chroma, double like);

// Fewer pairs than this say nothing of a light.
inline constexpr size_t kFewestColourPairs = 200;

}  // namespace ibrdf
