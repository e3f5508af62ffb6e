// The small flow with materials: a model file for what reads one.
#pragma once
#include <cmath>
#include <random>
#include <string>

#include "tests/support/small_flow.h"

namespace ibrdf {

// Materials m0, m1 ... of random codes in the unit ball.
inline NeuralBrdfModel SmallEmbedding(int materials, uint64_t seed = 7) {
  NeuralBrdfModel model = SmallFlowModel(5.0f);
  std::mt19937_64 rng(seed);
  const auto uniform = [&rng] {
    return static_cast<float>(static_cast<double>(rng() >> 11) * 0x1p-53);
  };
  for (int m = 0; m < materials; ++m) {
    for (const char* channel : {".red", ".green", ".blue"}) {
      model.names.push_back("m" + std::to_string(m) + channel);
      for (int k = 0; k < 3; ++k) model.codes.push_back(uniform() - 0.5f);
      model.log_colours.push_back(4.0f + uniform());
    }
  }
  model.note = "random";
  return model;
}

}  // namespace ibrdf
