// The conditional invertible BRDF with its embedding, as the trainer makes it.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/flow/flow_shape.h"

namespace ibrdf {

// One lobe of the model is colour * q(x | z)^exponent, where q is the flow's
// density on the unit cube x = (sqrt(theta_h / bound), theta_d, phi_d) (see
// brdf_grid.h). Exponent 1 is Chen et al. 2020, Eq. 5, and what ships; a larger
// one lets the coupling stack, whose densities have a moderate range, stand for
// reflectance of many orders of magnitude.
struct NeuralBrdfModel {
  FlowShape shape;
  double exponent = 1.0;
  std::vector<float> weights;  // [shape.NumWeights()]

  // The embedding: one code per training distribution (material and channel).
  std::vector<std::string> names;  // "material.red" ...
  std::vector<float> codes;  // [names.size()][code_size], in the unit ball
  // log of the colour (raw MERL units) with which a code fits its table.
  std::vector<float> log_colours;  // [names.size()]

  // The training materials (three codes each, in order) as lobes that share
  // their code between channels, the most peaked first, each as of LobeModel:
  // [materials][fit_lobes][code_size + 3]; fit_lobes 0: none. With
  // fit_lambertian the log colours [3] of a Lambertian lobe follow those of
  // each material: [materials][fit_size()]. What an estimate expects of lobes
  // before it sees an image.
  int fit_lobes = 0;
  bool fit_lambertian = false;
  std::vector<float> lobe_fits;

  std::string note;  // data, licence, command and score of the training

  int num_codes() const { return static_cast<int>(names.size()); }
  int num_materials() const { return num_codes() / 3; }
  // Numbers of a material in lobe_fits.
  int fit_size() const {
    return fit_lobes * (shape.code_size() + 3) + (fit_lambertian ? 3 : 0);
  }
};

}  // namespace ibrdf
