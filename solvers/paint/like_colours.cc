#include "ibrdf/solvers/paint/like_colours.h"

#include <cmath>
#include <random>

namespace ibrdf {
namespace {

constexpr size_t kPairs = 5000, kTries = 400000;
constexpr double kMostLengths = 1.5;

}  // namespace

std::vector<ColourPair> PairsOfLikeColour(
    const std::vector<Eigen::Array2d>& chroma, double like) {
  std::vector<ColourPair> pairs;
  if (chroma.empty()) return pairs;
  std::mt19937_64 bits(1);
  for (size_t k = 0; k < kTries && pairs.size() < kPairs; ++k) {
    const size_t first = bits() % chroma.size();
    const size_t second = bits() % chroma.size();
    const double lengths =
        (chroma[first] - chroma[second]).matrix().norm() / like;
    if (first == second || lengths > kMostLengths) continue;
    pairs.push_back({static_cast<int>(first), static_cast<int>(second),
                     std::exp(-0.5 * lengths * lengths)});
  }
  return pairs;
}

}  // namespace ibrdf
