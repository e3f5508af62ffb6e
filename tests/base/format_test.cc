#include "ibrdf/base/format.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(Format, IsPrintfOfAnyLength) {
  EXPECT_EQ("3 x 0.25 of a", Format("%d x %g of %s", 3, 0.25, "a"));
  EXPECT_EQ("", Format("%s", ""));
  const std::string text(5000, 'x');
  EXPECT_EQ(text + "|", Format("%s|", text.c_str()));
}

}  // namespace
}  // namespace ibrdf
