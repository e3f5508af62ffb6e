#include "ibrdf/solvers/photograph_check/photograph_check.h"

#include <gtest/gtest.h>

#include "ibrdf/solvers/photograph_check/check_words.h"
#include "tests/photograph_check/surfaces.h"

namespace ibrdf {
namespace {

Image Shaded(const Image& normals) {
  return Painted(normals, [](const Eigen::Vector3d& n, int, int) {
    return Eigen::Array3d(Eigen::Array3d(0.8, 0.5, 0.4) * (1.2 + n.x()));
  });
}

PhotographCheck CheckOf(const Image& image, const Image& normals,
                        const Mask& mask) {
  return CheckPhotograph({image, mask, PointsOf(normals), normals, false,
                          "linear (the file holds floats)", 1.0, 0,
                          std::nullopt});
}

bool Contains(const std::vector<std::string>& lines, const std::string& part) {
  for (const std::string& line : lines) {
    if (line.find(part) != line.npos) return true;
  }
  return false;
}

std::vector<std::string> LinesOf(const PhotographCheck& check) {
  std::vector<std::string> lines;
  for (const CheckFinding& finding : CheckFindings(check)) {
    EXPECT_EQ(finding.text.npos, finding.text.find('\n'));
    lines.push_back(finding.subject + ": " + finding.text);
  }
  return lines;
}

TEST(PhotographCheck, AGoodPhotographHasNoWarning) {
  const Image normals = SphereNormals(96);
  const PhotographCheck check = CheckOf(Shaded(normals), normals, Mask());
  EXPECT_EQ(check.counts.object, check.counts.used);
  EXPECT_EQ(nullptr, check.BetterNormals());
  EXPECT_TRUE(CheckWarnings(check, "i.exr", "n.npy").empty());
  const std::vector<std::string> lines = LinesOf(check);
  EXPECT_TRUE(Contains(lines, "96x96 pixels"));
  EXPECT_TRUE(Contains(lines, "as given: most plausible"));
  EXPECT_TRUE(Contains(lines, "cannot be told"));
}

TEST(PhotographCheck, FlippedNormalsAreAWarningThatNamesTheFile) {
  const Image sphere = SphereNormals(96);
  const Image flipped = UnderHypothesis(sphere, NormalHypothesis::kYFlipped);
  const PhotographCheck check = CheckOf(Shaded(flipped), flipped, Mask());
  ASSERT_NE(nullptr, check.BetterNormals());
  const std::vector<std::string> warnings =
      CheckWarnings(check, "i.exr", "n.npy");
  ASSERT_EQ(1u, warnings.size());
  EXPECT_EQ(0u, warnings[0].find("n.npy: "));
  EXPECT_NE(std::string::npos, warnings[0].find("negate y"));
}

TEST(PhotographCheck, PaintIsAWarningThatNamesTheImage) {
  const Image normals = SurfaceNormals(128, Bumps);
  const Image image =
      Painted(normals, [](const Eigen::Vector3d& n, int x, int) {
        return Eigen::Array3d((1.2 + n.x()) *
                              (x / 32 % 2 == 0 ? Eigen::Array3d(1, 0.5, 0.5)
                                               : Eigen::Array3d(0.5, 1, 0.5)));
      });
  const std::vector<std::string> warnings =
      CheckWarnings(CheckOf(image, normals, Mask()), "i.exr", "n.npy");
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(0u, warnings[0].find("i.exr: the object looks painted"));
}

TEST(PhotographCheck, AnObjectWithoutAUsablePixelIsNoFailure) {
  const Image normals = SphereNormals(32);
  const PhotographCheck check = CheckOf(Image(32, 32), normals, Mask());
  EXPECT_EQ(0u, check.counts.used);
  EXPECT_EQ(check.counts.object, check.counts.zero);
  EXPECT_FALSE(CheckFindings(check).empty());
}

TEST(PhotographCheck, OtherGeometryHasNoRanking) {
  const Image normals = SphereNormals(32);
  const Image image = Shaded(normals);
  const Mask mask(32, 32, 1);
  const PhotographCheck check = CheckPhotograph(
      {image, mask, PointsOf(normals), Image(), true, "srgb", 2.0, 3, 0.97});
  EXPECT_TRUE(check.normals.empty());
  EXPECT_EQ("", NormalsVerdict(check));
  const std::vector<std::string> lines = LinesOf(check);
  EXPECT_TRUE(Contains(lines, "overlap of mask and shape 0.97"));
  EXPECT_TRUE(Contains(lines, "3 missing"));
  EXPECT_TRUE(Contains(lines, "exposure 2"));
}

}  // namespace
}  // namespace ibrdf
