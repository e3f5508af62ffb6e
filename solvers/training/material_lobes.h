// What a model's materials look like as a few lobes.
#pragma once
#include <atomic>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Fills fit_lobes and lobe_fits: every material of the embedding, one code per
// channel, is tabulated and fitted by `lobes` lobes that share their codes
// between channels (LobeTableFitter). Needs no measured table. Lobes of a
// material are sorted by how far their peak stands out, the most peaked first.
// `stop`, where it is not null, is looked at before each material; then
// kInterrupted, and the model as it was.
Status FitMaterialLobes(int lobes, int num_threads,
                        const std::atomic<bool>* stop, NeuralBrdfModel* model);

}  // namespace ibrdf
