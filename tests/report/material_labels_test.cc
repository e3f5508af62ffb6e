#include "ibrdf/solvers/report/material_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(MaterialLabels, FilesOfOtherLabelsAreThoseOfNoLabelGiven) {
  const TempDir dir;
  for (const char* name :
       {"brdf_40.binary", "brdf_40.json", "brdf_80.binary", "brdf_255_0_0.json",
        "brdf_0_255_0.binary", "brdf.binary", "brdf_80.png", "brdf_mine.binary",
        "brdf_1_2.binary", "my_brdf_80.json"}) {
    WriteBytes(dir.File(name), "");
  }
  std::vector<std::string> found = FilesOfOtherLabels(
      dir.File(""), {MaterialLabel{"40", 1}, MaterialLabel{"255_0_0", 1}});
  std::sort(found.begin(), found.end());
  EXPECT_EQ((std::vector<std::string>{"brdf_0_255_0.binary", "brdf_80.binary"}),
            found);
  EXPECT_EQ(size_t{5}, FilesOfOtherLabels(dir.File(""), {}).size());
  EXPECT_TRUE(FilesOfOtherLabels(dir.File("absent"), {}).empty());
}

}  // namespace
}  // namespace ibrdf
