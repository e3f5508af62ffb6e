#include "ibrdf/solvers/programs/progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace ibrdf {
namespace {

constexpr double kSilentSeconds = 2.0;

}  // namespace

ProgressLine::ProgressLine(const std::string& what, bool quiet)
    : what_(what), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0) {}

void ProgressLine::Show(double share) {
  const double seconds = watch_.Seconds();
  const int percent = static_cast<int>(100.0 * share);
  if (quiet_ || percent == shown_) return;
  if (share < 1.0 && seconds < kSilentSeconds) return;
  if (shown_ < 0 && share >= 1.0) return;
  if (!terminal_ && percent / 10 == shown_ / 10 && shown_ >= 0) return;
  shown_ = percent;
  std::fprintf(stderr, terminal_ ? "\r%s %3d %%, %.0f s" : "%s %d %%, %.0f s\n",
               what_.c_str(), percent, seconds);
  if (terminal_ && share >= 1.0) std::fputc('\n', stderr);
}

}  // namespace ibrdf
