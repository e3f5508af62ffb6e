// How far a program is, on standard error.
#pragma once
#include <string>

#include "ibrdf/base/stopwatch.h"

namespace ibrdf {

// Lines "render 40 %" on stderr: rewritten in place on a terminal, one for
// every tenth in a file; none in the first two seconds.
class ProgressLine {
 public:
  ProgressLine(const std::string& what, bool quiet);

  void Show(double share);

 private:
  const std::string what_;
  const bool quiet_;
  const bool terminal_;
  const Stopwatch watch_;
  int shown_ = -1;
};

}  // namespace ibrdf
