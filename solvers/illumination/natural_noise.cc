#include "ibrdf/solvers/illumination/natural_noise.h"

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "ibrdf/base/normal_source.h"
#include "ibrdf/solvers/illumination/process_illumination.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

std::vector<float> NaturalNoise(const IlluminationUnetOptions& options) {
  const MapSize asked = {options.width, options.height};
  const MapSize drawn = ProcessSize(asked);
  const std::unique_ptr<IlluminationModel> process =
      MakeProcessIllumination(drawn.width, drawn.height, LightProcess(),
                              LightHyperparameters::Average());
  std::vector<float> white(process->num_parameters()), noise;
  LogMap sample;
  NormalSource normal(options.seed);
  for (int k = 0; k < options.noise_channels; ++k) {
    for (float& w : white) w = normal.Next();
    process->Forward(white.data(), &sample);
    if (drawn != asked) sample = sample.Resized(asked);
    // The others of its colours are nearly the same.
    Eigen::Map<Eigen::ArrayXf> red(
        sample.data(), static_cast<Eigen::Index>(sample.num_texels()));
    red -= red.mean();
    red /= std::sqrt(red.square().mean());
    noise.insert(noise.end(), red.begin(), red.end());
  }
  return noise;
}

}  // namespace ibrdf
