#include "solvers/natural_noise.h"

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "ibrdf/base/normal_source.h"
#include "solvers/marginal/light_process.h"
#include "solvers/process_illumination.h"

namespace ibrdf {

std::vector<float> NaturalNoise(const IlluminationUnetOptions& options) {
  const int width = options.width, height = options.height;
  const std::unique_ptr<IlluminationModel> process = MakeProcessIllumination(
      width, height, LightProcess(), LightScales::Average());
  std::vector<float> white(process->num_parameters());
  std::vector<float> draw(process->num_outputs()), noise;
  NormalSource normal(options.seed);
  const Eigen::Index texels = Eigen::Index{width} * height;
  for (int k = 0; k < options.noise_channels; ++k) {
    for (float& w : white) w = normal.Next();
    process->Forward(white.data(), draw.data());
    // The others of its colours are nearly the same.
    Eigen::Map<Eigen::ArrayXf> red(draw.data(), texels);
    red -= red.mean();
    red /= std::sqrt(red.square().mean());
    noise.insert(noise.end(), draw.data(), draw.data() + texels);
  }
  return noise;
}

}  // namespace ibrdf
