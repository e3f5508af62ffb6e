// What the tests of problem files share.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/problem_file.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {

// The least problem file.
inline constexpr char kLeast[] =
    "image: {file: a.exr}\ngeometry: {sphere: {}}\n";

// Tests of problem files on disk.
class ProblemFile : public ::testing::Test {
 protected:
  StatusOr<Problem> Read(const std::string& text,
                         const std::vector<std::string>& overrides = {}) {
    WriteBytes(path_, text);
    return ReadProblem(path_, overrides);
  }
  std::string ErrorOf(const std::string& text,
                      const std::vector<std::string>& overrides = {}) {
    const StatusOr<Problem> problem = Read(text, overrides);
    if (problem.ok()) return "no error";
    EXPECT_EQ(StatusCode::kInvalidInput, problem.status().code());
    return problem.status().message();
  }

  const TempDir dir_;
  const std::string path_ = dir_.File("joint.yaml");
};

// A file's text, and a part of the message that refuses it.
struct Refusal {
  std::string text, error;
};

// The message of a text that is refused.
inline std::string ParseError(const std::string& text) {
  return ParseProblem("p.yaml", text, {}).status().message();
}

}  // namespace ibrdf
