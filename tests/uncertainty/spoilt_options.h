// Options of which one is bad, for tests.
#pragma once
#include <string>

namespace ibrdf {

// Whether Check() of options after `spoil` has `name` in its message.
template <typename Options>
bool CheckNames(const char* name, void (*spoil)(Options*)) {
  Options options;
  spoil(&options);
  return options.Check().message().find(name) != std::string::npos;
}

}  // namespace ibrdf
