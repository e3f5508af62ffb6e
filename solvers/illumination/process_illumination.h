// The unknown map as a draw of the light's Gaussian process.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ibrdf/solvers/illumination/illumination_model.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

// log L = level + S w with S S^T the process's covariance between the texels'
// centres: under a standard normal prior of w [3 H W] the map has the
// process's, and a least-squares step from one has no steep directions but the
// data's. Texels at the directional lights (unit directions) vary besides, each
// by itself: of the N texels of NearDirectionalLights another w [3 N].
//
// The covariance is the same at every longitude, so that a Fourier transform
// along the rows leaves a Cholesky factor [H][H] for each frequency. Costs
// O(W H (W + H)) a product and O(W H^3) to build: maps of up to 256x128.
// width even.
std::unique_ptr<IlluminationModel> MakeProcessIllumination(
    int width, int height, const LightProcess& process,
    const LightHyperparameters& hyperparameters,
    const std::vector<Eigen::Vector3d>& directional_lights = {});

// The size of a draw for a map of `size`: that, or halved until no side is
// above 256; width even.
MapSize ProcessSize(MapSize size);

}  // namespace ibrdf
