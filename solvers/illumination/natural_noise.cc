#include "ibrdf/solvers/illumination/natural_noise.h"

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "ibrdf/base/normal_source.h"
#include "ibrdf/solvers/illumination/process_illumination.h"
#include "ibrdf/solvers/illumination/resample_planes.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

std::vector<float> NaturalNoise(const IlluminationUnetOptions& options) {
  const MapSize asked = {options.width, options.height};
  const MapSize drawn = ProcessSize(asked);
  const std::unique_ptr<IlluminationModel> process =
      MakeProcessIllumination(drawn.width, drawn.height, LightProcess(),
                              LightHyperparameters::Average());
  std::vector<float> white(process->num_parameters());
  std::vector<float> draw(process->num_outputs()), noise;
  NormalSource normal(options.seed);
  const Eigen::Index texels = Eigen::Index{drawn.width} * drawn.height;
  for (int k = 0; k < options.noise_channels; ++k) {
    for (float& w : white) w = normal.Next();
    process->Forward(white.data(), draw.data());
    // The others of its colours are nearly the same.
    std::vector<float> channel(draw.begin(), draw.begin() + texels);
    if (drawn != asked) channel = ResamplePlanes(channel, drawn, asked);
    Eigen::Map<Eigen::ArrayXf> red(channel.data(),
                                   static_cast<Eigen::Index>(channel.size()));
    red -= red.mean();
    red /= std::sqrt(red.square().mean());
    noise.insert(noise.end(), channel.begin(), channel.end());
  }
  return noise;
}

}  // namespace ibrdf
