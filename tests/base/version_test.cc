#include "ibrdf/base/version.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(Version, IsThatOfTheBuild) {
  const std::string cmake =
      ReadBytes(std::string(IBRDF_SOURCE_DIR) + "/CMakeLists.txt");
  EXPECT_NE(std::string::npos,
            cmake.find("project(ibrdf VERSION " + std::string(kVersion) + " "));
}

}  // namespace
}  // namespace ibrdf
