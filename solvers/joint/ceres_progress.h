// A Ceres solve as a run: reports its iterations, ends it when asked. Internal.
#pragma once
#include <ceres/iteration_callback.h>

#include "ibrdf/solvers/joint/method_run.h"

namespace ibrdf {

class CeresProgress final : public ceres::IterationCallback {
 public:
  explicit CeresProgress(MethodRun* run) : run_(run) {}
  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& summary) override {
    // Iteration 0 is the evaluation of the start.
    if (summary.iteration > 0) run_->Report();
    return run_->Stop() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                        : ceres::SOLVER_CONTINUE;
  }

 private:
  MethodRun* run_;
};

}  // namespace ibrdf
