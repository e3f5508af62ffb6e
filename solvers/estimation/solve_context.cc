#include "ibrdf/solvers/estimation/solve_context.h"

#include <glog/logging.h>

#include <algorithm>

namespace ibrdf {

SolveContext::SolveContext(const InverseProblem& problem,
                           const SolveProgress& progress,
                           const std::atomic<bool>* stop)
    : progress_(progress),
      stop_(stop),
      seconds_spent_(problem.seconds_spent),
      budget_(problem.solver.seconds),
      max_iterations_(problem.solver.max_iterations) {}

std::function<bool()> SolveContext::StopAfter(double share) const {
  const double now = Elapsed();
  const double end = now + share * std::max(budget_ - reserved_ - now, 0.0);
  return [this, end] { return Interrupted() || Elapsed() > end; };
}

void SolveContext::Report(const TraceEntry& entry) {
  trace_.push_back(entry);
  VLOG(1) << entry.stage << " " << entry.seconds << " s misfit " << entry.misfit
          << " cost " << entry.cost;
  if (progress_) progress_(entry, std::min(entry.seconds / budget_, 1.0));
}

void SolveContext::Report(const std::string& stage, int pixels, double cost,
                          double misfit) {
  TraceEntry entry;
  entry.stage = stage;
  entry.pixels = pixels;
  entry.cost = entry.likelihood = cost;
  entry.misfit = misfit;
  entry.seconds = Elapsed();
  Report(entry);
}

}  // namespace ibrdf
