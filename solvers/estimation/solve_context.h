// What a solve may spend, and whom it tells how far it is.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// Called at every line of the trace, with the share in [0, 1] of the time that
// is spent.
using SolveProgress =
    std::function<void(const TraceEntry& entry, double share)>;

// The clock, the iterations, the user's wish to stop and the trace of one
// solve. It starts the clock. Not thread-safe but for Interrupted().
class SolveContext {
 public:
  // Takes solver.seconds, solver.max_iterations and seconds_spent of the
  // problem. `stop` may be null; it and `progress` must outlive the context.
  SolveContext(const InverseProblem& problem, const SolveProgress& progress,
               const std::atomic<bool>* stop);

  // Seconds, with those spent before the call.
  double Elapsed() const { return seconds_spent_ + clock_.Seconds(); }
  double budget() const { return budget_; }
  const std::atomic<bool>* stop() const { return stop_; }
  const SolveProgress& progress() const { return progress_; }
  double reserved() const { return reserved_; }
  bool Interrupted() const { return stop_ != nullptr && stop_->load(); }

  // Keeps seconds for what follows the estimate (Summarise and the writing of
  // results): no stage may spend them.
  void Reserve(double seconds) { reserved_ = seconds; }
  // Seconds that stages may still spend; negative when there are none.
  double Remaining() const { return RemainingAt(Elapsed()); }
  double RemainingAt(double elapsed) const {
    return budget_ - reserved_ - elapsed;
  }
  // True once the solve is interrupted or a share of what remains now is spent.
  std::function<bool()> StopAfter(double share) const;

  // Outer iterations, of all stages together.
  bool IterationsLeft() const { return iterations_ < max_iterations_; }
  int iterations() const { return iterations_; }
  void CountIteration() { ++iterations_; }

  // Adds a line to the trace and calls `progress`.
  void Report(const TraceEntry& entry);
  // The same of a stage that knows these alone: the cost, nats, is all the
  // likelihood's.
  void Report(const std::string& stage, int pixels, double cost, double misfit);
  const std::vector<TraceEntry>& trace() const { return trace_; }

 private:
  const SolveProgress& progress_;
  const std::atomic<bool>* const stop_;
  const double seconds_spent_, budget_;
  const int max_iterations_;
  const Stopwatch clock_;
  double reserved_ = 0.0;
  int iterations_ = 0;
  std::vector<TraceEntry> trace_;
};

}  // namespace ibrdf
