#include "ibrdf/solvers/report/material_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(MaterialLabels, FilesOfLabelsAreCalledByTheirValues) {
  const TempDir dir;
  const std::vector<std::string> expected = {
      "brdf_0_255_0.binary", "brdf_255_0_0.json", "brdf_40.binary",
      "brdf_40.json", "brdf_65535.binary"};
  for (const std::string& name : expected) WriteBytes(dir.File(name), "");
  for (const char* name : {"brdf.binary", "brdf_80.png", "brdf_mine.binary",
                           "brdf_1_2.binary", "my_brdf_80.json"}) {
    WriteBytes(dir.File(name), "");
  }
  std::vector<std::string> found = FilesOfLabels(dir.File(""));
  std::sort(found.begin(), found.end());
  EXPECT_EQ(expected, found);
  EXPECT_TRUE(FilesOfLabels(dir.File("absent")).empty());
}

}  // namespace
}  // namespace ibrdf
