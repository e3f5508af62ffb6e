// What a model's materials look like as a few lobes.
#pragma once
#include <atomic>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Fills lobe_fits and what tells of them: every material of the embedding, one
// code per channel, is tabulated and fitted by `lobes` lobes that share their
// codes between channels, and a Lambertian one beside them where it is wanted
// (LobeTableFitter). Needs no measured table. Lobes of a material are sorted by
// how far their peak stands out, the most peaked first; the Lambertian one is
// last.
// `stop`, where it is not null, is looked at before each material; then
// kInterrupted, and the model as it was.
Status FitMaterialLobes(int lobes, bool lambertian, int num_threads,
                        const std::atomic<bool>* stop, NeuralBrdfModel* model);

}  // namespace ibrdf
