// What a model's materials look like as a few lobes.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Fills fit_lobes and lobe_fits: every material of the embedding, one code per
// channel, is tabulated and fitted by `lobes` lobes that share their codes
// between channels (LobeTableFitter). Needs no measured table. Lobes of a
// material are sorted by how far their peak stands out, the most peaked first.
Status FitMaterialLobes(int lobes, int num_threads, NeuralBrdfModel* model);

}  // namespace ibrdf
