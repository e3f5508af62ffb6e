// Input images of the sweeps, many at a time.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/sweep_cases.h"

namespace ibrdf {

// What the case's input is made from, as its input.json has it.
std::string InputSettings(const SweepOptions& options, const SweepCase& c);

// Whether the case's folder holds an input made with these settings.
bool HasInput(const SweepOptions& options, const SweepCase& c);

// Makes CaseFolder/{input.exr, mask.png, input.json} for the cases that have
// none with these settings: ReferenceBatch over up to options.batch materials
// and their maps, 2x2 samples a pixel, then log-normal noise of options.seed,
// the same for every image. input.json is written last and stands for whole
// files, so that a killed run goes on where it was. kInterrupted once stopped.
Status MakeInputs(const SweepOptions& options,
                  const std::vector<SweepCase>& cases);

// Makes the inputs of all selected cases.
Status RunRenderInputs(const SweepOptions& options);

}  // namespace ibrdf
