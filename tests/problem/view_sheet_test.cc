#include "ibrdf/solvers/problem/view_sheet.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

std::vector<SheetView> Views(const std::vector<std::pair<int, int>>& sizes) {
  std::vector<SheetView> views;
  for (const auto& [width, height] : sizes) {
    SheetView view;
    view.name = "v" + std::to_string(views.size());
    view.width = width;
    view.height = height;
    views.push_back(view);
  }
  return views;
}

// Every pixel has its own value.
Image Numbered(int width, int height, float first) {
  Image image(width, height);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    image.rgb[k] = first + static_cast<float>(k);
  }
  return image;
}

TEST(ViewSheet, ViewsComeBackAsTheyWere) {
  const ViewSheet sheet =
      LayOut(Views({{5, 3}, {2, 7}, {4, 4}, {1, 1}, {6, 2}}));
  Image image(sheet.width, sheet.height);
  Mask mask(sheet.width, sheet.height, 0);
  for (size_t v = 0; v < sheet.views.size(); ++v) {
    const SheetView& view = sheet.views[v];
    Place(Numbered(view.width, view.height, 1000.0f * v), view, &image);
    Mask own(view.width, view.height, 0);
    for (size_t i = 0; i < own.inside.size(); i += 2) own.inside[i] = 1;
    Place(own, view, &mask);
  }
  for (size_t v = 0; v < sheet.views.size(); ++v) {
    const SheetView& view = sheet.views[v];
    EXPECT_EQ("v" + std::to_string(v), view.name);
    EXPECT_EQ(Numbered(view.width, view.height, 1000.0f * v).rgb,
              CutOut(image, view).rgb);
    const Mask own = CutOut(mask, view);
    for (size_t i = 0; i < own.inside.size(); ++i) {
      EXPECT_EQ(i % 2 == 0, own.inside[i] != 0);
    }
  }
}

TEST(ViewSheet, AnEmptyMaskHoldsItsViewAlone) {
  const ViewSheet sheet = LayOut(Views({{5, 3}, {2, 7}}));
  Mask mask(sheet.width, sheet.height, 0);
  Place(Mask(), sheet.views[1], &mask);
  EXPECT_EQ(14u, mask.CountInside());
  EXPECT_EQ(0u, CutOut(mask, sheet.views[0]).CountInside());
}

// Whatever looks at neighbours sees one view: no two pixels of different views
// are within three of each other, in rows or columns.
TEST(ViewSheet, ViewsAreApart) {
  const ViewSheet sheet =
      LayOut(Views({{5, 3}, {2, 7}, {4, 4}, {1, 1}, {6, 2}, {3, 3}, {3, 3}}));
  const auto apart = [](int a, int length_a, int b, int length_b) {
    return b - (a + length_a) >= 3 || a - (b + length_b) >= 3;
  };
  for (const SheetView& a : sheet.views) {
    EXPECT_LE(a.x + a.width, sheet.width);
    EXPECT_LE(a.y + a.height, sheet.height);
    for (const SheetView& b : sheet.views) {
      if (a.name == b.name) continue;
      EXPECT_TRUE(apart(a.x, a.width, b.x, b.width) ||
                  apart(a.y, a.height, b.y, b.height))
          << a.name << " " << b.name;
    }
  }
}

TEST(ViewSheet, PointsKeepTheirPlaceInTheirView) {
  const ViewSheet sheet = LayOut(Views({{9, 9}, {16, 16}, {7, 7}, {16, 16}}));
  std::set<int> pixels;
  for (const int v : {1, 3}) {
    const std::vector<ShadingPoint> before = SpherePoints(16);
    std::vector<ShadingPoint> after = before;
    MoveToSheet(sheet, v, &after);
    const SheetView& view = sheet.views[v];
    for (size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(v, after[i].view);
      EXPECT_EQ(before[i].pixel % 16, after[i].pixel % sheet.width - view.x);
      EXPECT_EQ(before[i].pixel / 16, after[i].pixel / sheet.width - view.y);
      EXPECT_EQ(before[i].normal, after[i].normal);
      EXPECT_TRUE(pixels.insert(after[i].pixel).second);
    }
  }
}

}  // namespace
}  // namespace ibrdf
