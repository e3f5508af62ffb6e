// Uses each library once; argument: a file to write.
#include <cstddef>
#include <cstdio>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/solve/solve.h"

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

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool ok = InitialMapIsConstant() && TableEqualsItself(argv[1]) &&
                  RefusesAnEmptyProblem();
  std::printf("%s\n", ok ? "ok" : "failed");
  return ok ? 0 : 1;
}
