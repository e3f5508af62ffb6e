// Uses each library once; argument: a file to write.
#include <cstddef>
#include <cstdio>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/solve/solve.h"
#include "ibrdf/uncertainty/angular_entropy.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"

// The network reaches the kernels, compiled once per instruction set.
bool InitialMapIsConstant() {
  ibrdf::IlluminationUnetOptions options;
  options.width = 32;
  options.height = 16;
  const ibrdf::IlluminationUnet unet(options);
  const std::vector<float> weights = unet.InitialWeights(1);
  ibrdf::IlluminationUnet::Workspace workspace;
  std::vector<float> log_radiance(unet.num_outputs(), 1.0f);
  unet.Forward(weights.data(), &workspace, log_radiance.data());
  for (const float value : log_radiance) {
    if (value != 0.0f) return false;
  }
  return true;
}

bool TableEqualsItself(const char* path) {
  ibrdf::MerlTable table;
  table.raw.assign(size_t{3} * ibrdf::kMerlBins, 100.0);
  if (!ibrdf::WriteMerl(table, path).ok()) return false;
  const auto read = ibrdf::ReadMerl(path);
  if (!read.ok()) return false;
  const auto metrics = ibrdf::CompareBrdfs(*read, table);
  return metrics.ok() && metrics->log_rmse == 0.0;
}

// A problem without an image is refused.
bool RefusesAnEmptyProblem() {
  return !ibrdf::SolveInverseRendering({}, nullptr, nullptr).ok();
}

// Two texels, of which views see one: the map of entropy tells them apart.
bool MapsEntropy() {
  ibrdf::TexelSamples samples;
  samples.num_texels = 2;
  samples.num_views = 3;
  samples.weight = {1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f};
  for (int k = 0; k < 6; ++k) {
    const float x = 0.6f * static_cast<float>(k % 3 - 1);
    samples.directions.insert(samples.directions.end(),
                              {x, 0.0f, x == 0.0f ? 1.0f : 0.8f});
    samples.incoming.insert(samples.incoming.end(), 3, 1.0f + x);
    samples.outgoing.insert(samples.outgoing.end(), 3, 0.5f + 0.5f * x);
  }
  const ibrdf::SpectrumEntropyEvaluator spectrum({});
  const ibrdf::AngularEntropyEvaluator angular({});
  for (const ibrdf::EntropyEvaluator* evaluator :
       {static_cast<const ibrdf::EntropyEvaluator*>(&spectrum),
        static_cast<const ibrdf::EntropyEvaluator*>(&angular)}) {
    const auto maps = evaluator->Evaluate(samples, 1);
    if (!maps.ok()) return false;
    const std::vector<float> entropy = maps->MinimumEntropy();
    if (!(entropy[0] < 1.0f) || entropy[1] != 1.0f) return false;
  }
  return true;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool ok = InitialMapIsConstant() && TableEqualsItself(argv[1]) &&
                  RefusesAnEmptyProblem() && MapsEntropy();
  std::printf("%s\n", ok ? "ok" : "failed");
  return ok ? 0 : 1;
}
