// What the parsers under test promise of every answer.
#pragma once
#include <glog/logging.h>

#include <functional>
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct FuzzedParser {
  const char* name;
  std::function<void(const std::string&)> run;
};

// An error is of the input, one line, and names the file.
inline void CheckError(const Status& status, const std::string& name) {
  CHECK(status.code() == StatusCode::kInvalidInput) << status.message();
  CHECK_NE(status.message().find(name), std::string::npos) << status.message();
  CHECK_EQ(status.message().find('\n'), std::string::npos) << status.message();
}

// Text of a file that goes into messages.
inline void CheckOneLine(const std::string& text) {
  for (const char c : text) CHECK_GE(static_cast<unsigned char>(c), 0x20);
}

}  // namespace ibrdf
