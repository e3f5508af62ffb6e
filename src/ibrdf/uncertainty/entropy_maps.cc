#include "ibrdf/uncertainty/entropy_maps.h"

#include <algorithm>

namespace ibrdf {

void EntropyMaps::Resize(int texels) {
  num_texels = texels;
  for (std::vector<float>* v :
       {&entropy, &alpha, &Ks, &Kd, &misfit, &deviations}) {
    v->assign(3 * static_cast<size_t>(texels), 0.0f);
  }
}

std::vector<float> EntropyMaps::MinimumEntropy() const {
  std::vector<float> out(num_texels);
  for (int texel = 0; texel < num_texels; ++texel) {
    const float* const H = &entropy[3 * static_cast<size_t>(texel)];
    out[texel] = std::min({H[0], H[1], H[2]});
  }
  return out;
}

std::vector<float> EntropyMaps::MeanEntropy() const {
  std::vector<float> out(num_texels);
  for (int texel = 0; texel < num_texels; ++texel) {
    const float* const H = &entropy[3 * static_cast<size_t>(texel)];
    out[texel] = (H[0] + H[1] + H[2]) / 3.0f;
  }
  return out;
}

}  // namespace ibrdf
