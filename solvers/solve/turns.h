// Turns of two estimates that each need the other, while time lasts.
#pragma once
#include "ibrdf/solvers/estimation/solve_context.h"

namespace ibrdf {

class Turns {
 public:
  // The first begins now; `context` must outlive this.
  Turns(int most, const SolveContext* context)
      : most_(most), context_(context), began_(context->Elapsed()) {}

  // All are left again, and the first begins now.
  void Restart() {
    taken_ = 0;
    began_ = context_->Elapsed();
  }

  // Whether to take another, which then begins: so many there are, and a turn
  // that is cut short would undo the last, so there must be half as much time
  // again as that took.
  bool Another() {
    const double now = context_->Elapsed(), last = now - began_;
    began_ = now;
    return ++taken_ < most_ && context_->Remaining() >= kMargin * last;
  }

 private:
  static constexpr double kMargin = 1.5;
  const int most_;
  const SolveContext* const context_;
  int taken_ = 0;
  double began_;
};

}  // namespace ibrdf
