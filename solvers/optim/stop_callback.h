// Ends a Ceres solve early, with its best iterate, when a caller asks.
#pragma once
#include <ceres/iteration_callback.h>

#include <functional>

namespace ibrdf {

// `stop` may be empty and must outlive the callback; asked once an iteration.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(const std::function<bool()>& stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary&) override {
    return stop_ && stop_() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                            : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<bool()>& stop_;
};

}  // namespace ibrdf
