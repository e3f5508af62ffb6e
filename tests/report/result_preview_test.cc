#include "ibrdf/solvers/report/result_preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/report/brdf_sphere.h"
#include "ibrdf/solvers/report/result_images.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

ResultPreviewInput SmallInput() {
  ResultPreviewInput input;
  input.title = "test";
  input.input = Image(12, 10);
  std::fill(input.input.rgb.begin(), input.input.rgb.end(), 0.5f);
  input.mask = Mask(12, 10, 1);
  return input;
}

TEST(ResultPreview, WritesWhatThereIsAndNothingElse) {
  const TempDir dir;
  ResultPreviewInput input = SmallInput();
  ASSERT_TRUE(WriteResultPreviews(input, dir.path()).ok());
  EXPECT_EQ(dir.CountFiles(), 2);  // overview and input

  input.render = input.input;
  input.residual = Image(12, 10);
  input.illumination = ProceduralSky(8, 16);
  input.brdf.raw.assign(size_t{3} * kMerlBins, 100.0);
  ASSERT_TRUE(WriteResultPreviews(input, dir.path()).ok());
  for (const char* name : {"overview.png", "input.png", "render.png",
                           "residual.png", "illumination.png", "brdf.png"}) {
    EXPECT_TRUE(std::filesystem::exists(dir.File(name))) << name;
  }
  EXPECT_EQ(dir.CountFiles(), 6);
}

TEST(ResultPreview, PaintHasItsDeviationBesideIt) {
  const TempDir dir;
  ResultPreviewInput input = SmallInput();
  input.render = input.gloss = input.albedo = input.albedo_log_std =
      input.input;
  const ResultPanels panels = *MakeResultPanels(input);
  ASSERT_EQ(size_t{4}, panels.paint.size());
  EXPECT_EQ(PreviewPanel::Kind::kDeviation, panels.paint[1].kind);
  ASSERT_TRUE(WriteResultPreviews(panels, input, dir.path()).ok());
  for (const char* name : {"albedo.png", "albedo_certainty.png", "gloss.png"}) {
    EXPECT_TRUE(std::filesystem::exists(dir.File(name))) << name;
  }
  input.albedo_log_std = Image(3, 3);
  EXPECT_FALSE(MakeResultPanels(input).ok());
}

TEST(ResultPreview, ReferencesAddPanels) {
  ResultPreviewInput input = SmallInput();
  input.illumination = ProceduralSky(8, 16);
  const Rgb8Image alone = MakeOverview(input);
  input.reference_illumination = ProceduralSky(16, 32);  // of another size
  EXPECT_GT(MakeOverview(input).width, alone.width);
}

TEST(ResultPreview, ImagesAreCroppedToTheObject) {
  ResultPreviewInput input = SmallInput();
  input.mask = Mask(12, 10, 0);
  input.mask.inside[4 * 12 + 5] = input.mask.inside[5 * 12 + 6] = 1;
  input.render = input.input;
  input.residual = Image(12, 10);
  const ResultPanels panels = *MakeResultPanels(input);
  ASSERT_EQ(size_t{3}, panels.images.size());
  for (const PreviewPanel& panel : panels.images) {
    EXPECT_EQ(4, panel.image.width) << panel.label;
    EXPECT_EQ(4, panel.image.height) << panel.label;
    EXPECT_EQ(size_t{2}, panel.mask.CountInside()) << panel.label;
  }
}

TEST(ResultPreview, ShowsTheObjectRelitAndOtherReflectances) {
  ResultPreviewInput input = SmallInput();
  input.brdf.raw.assign(size_t{3} * kMerlBins, 100.0);
  ResultPanels panels = *MakeResultPanels(input);
  EXPECT_EQ(size_t{2}, panels.spheres.size());
  EXPECT_TRUE(panels.relit.empty());
  EXPECT_TRUE(panels.alternatives.empty());

  ShadingPoint point{};
  point.normal = point.wo = Eigen::Vector3f::UnitZ();
  point.pixel = 3;
  const std::vector<ShadingPoint> points = {point};
  input.points = &points;
  BrdfGrid white({2, 2, 1});
  std::fill(white.values.begin(), white.values.end(), 1.0f);
  input.alternatives = {{"another", white}};
  panels = *MakeResultPanels(input);
  ASSERT_EQ(size_t{2}, panels.relit.size());
  EXPECT_GT(panels.relit[0].image.At(3, 0)[1], 0.0f);
  EXPECT_EQ(0.0f, panels.relit[0].image.At(4, 0)[1]);
  ASSERT_EQ(size_t{2}, panels.alternatives.size());
  EXPECT_EQ("another", panels.alternatives[1].label);
}

TEST(ResultPreview, MapsAreShownAsSeenFromTheObject) {
  ResultPreviewInput input = SmallInput();
  input.illumination = ProceduralSky(8, 16);
  input.middle_of_map = "what the camera looks at";
  const ResultPanels panels = *MakeResultPanels(input);
  const Image& map = input.illumination;
  const Image& shown = panels.maps.at(0).image;
  ASSERT_EQ(map.width, shown.width);
  EXPECT_NE(map.rgb, shown.rgb);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(map.At(map.width - 1 - x, y)[c], shown.At(x, y)[c]);
      }
    }
  }
  EXPECT_NE(std::string::npos,
            panels.maps[0].label.find(
                "seen from the object: the middle is what the camera looks at"))
      << panels.maps[0].label;
}

TEST(ResultPreview, TheMiddleOfAMapIsAheadOfCamerasThatLookAlongMinusZ) {
  Camera camera;
  EXPECT_EQ("what the camera looks at", MiddleOfMapPicture(camera));
  camera.type = CameraType::kPerspective;
  camera.from = {0.0, 0.4, 4.0};
  EXPECT_EQ("what the camera looks at", MiddleOfMapPicture(camera));
  camera.from = {4.0, 0.0, 0.5};
  EXPECT_EQ("-z", MiddleOfMapPicture(camera));
  camera.from = {0.0, 0.0, 4.0};
  camera.up = {1.0, 0.0, 0.0};
  EXPECT_EQ("-z", MiddleOfMapPicture(camera));
}

TEST(ResultPreview, AKnownMapIsNoEstimate) {
  ResultPreviewInput input = SmallInput();
  input.illumination = input.reference_illumination = ProceduralSky(8, 16);
  EXPECT_EQ(size_t{2}, MakeResultPanels(input)->maps.size());
  input.illumination_known = true;
  const ResultPanels panels = MakeResultPanels(input).value();
  ASSERT_EQ(size_t{1}, panels.maps.size());
  EXPECT_EQ(0u, panels.maps[0].label.find("Known light"));
}

// An estimate that differs from its reference by a factor shows the same.
TEST(ResultPreview, EstimatesAreBroughtToTheReferencesScale) {
  ResultPreviewInput input = SmallInput();
  input.illumination = ProceduralSky(8, 16);
  input.reference_illumination = input.illumination;
  const Rgb8Image same = MakeOverview(input);
  for (float& value : input.illumination.rgb) value *= 0.25f;
  const Rgb8Image scaled = MakeOverview(input);
  ASSERT_EQ(same.rgb.size(), scaled.rgb.size());
  // Only the factor in the label differs.
  size_t different = 0;
  for (size_t k = 0; k < same.rgb.size(); ++k) {
    different += same.rgb[k] != scaled.rgb[k];
  }
  EXPECT_LT(different, 3u * 1000u);
}

TEST(ResultPreview, RefusesSizesThatDisagree) {
  const TempDir dir;
  ResultPreviewInput input = SmallInput();
  input.render = Image(10, 12);
  EXPECT_EQ(WriteResultPreviews(input, dir.path()).code(),
            StatusCode::kInvalidInput);
  input = SmallInput();
  input.mask = Mask(3, 3, 1);
  EXPECT_EQ(WriteResultPreviews(input, dir.path()).code(),
            StatusCode::kInvalidInput);
  input = SmallInput();
  input.brdf.raw.assign(7, 1.0);
  EXPECT_EQ(WriteResultPreviews(input, dir.path()).code(),
            StatusCode::kInvalidInput);
  EXPECT_EQ(WriteResultPreviews(ResultPreviewInput(), dir.path()).code(),
            StatusCode::kInvalidInput);
  EXPECT_EQ(dir.CountFiles(), 0);
}

TEST(ResultPreview, NamesAFolderThatDoesNotExist) {
  const Status status = WriteResultPreviews(SmallInput(), "/nowhere/at/all");
  EXPECT_FALSE(status.ok());
  EXPECT_NE(status.message().find("/nowhere/at/all"), std::string::npos);
}

}  // namespace
}  // namespace ibrdf
