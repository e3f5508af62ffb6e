// What the illumination's network is given in place of white noise.
#pragma once
#include <vector>

#include "ibrdf/light/illumination_unet.h"

namespace ibrdf {

// [noise_channels][height][width]: draws of LightProcess at its average
// hyperparameters, independent of each other, each of mean 0 and variance 1
// over its texels. width even. Maps of more than 256 texels a side take it from
// a draw of fewer, which a process of so many frequencies would take minutes
// and gigabytes for.
//
// A network of white noise (Chen et al. 2020, Sec. 5) makes texture first and
// takes long to lose it where the image tells nothing; one of noise with the
// spectrum of natural light makes what looks like such light.
std::vector<float> NaturalNoise(const IlluminationUnetOptions& options);

}  // namespace ibrdf
