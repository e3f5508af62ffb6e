#include "ibrdf/io/calibrated_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "tests/support/camera_files.h"
#include "tests/support/corruption.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using Views = StatusOr<std::vector<CalibratedView>>;

// Poses and lenses of files hold the digits they have.
constexpr double kRounding = 1e-12;

std::string With(std::string text, const std::string& old,
                 const std::string& by) {
  const size_t at = text.find(old);
  EXPECT_NE(std::string::npos, at) << old;
  return text.replace(at, old.size(), by);
}

TEST(Transforms, PosesAreOpenGlsAndTheAngleIsHorizontal) {
  const Views views = ParseTransforms("t.json", SmallTransforms());
  ASSERT_TRUE(views.ok()) << views.status().message();
  ASSERT_EQ(2u, views->size());
  EXPECT_EQ("r_0", (*views)[0].name);
  const StatusOr<Camera> camera = CameraOf((*views)[1], 800, 600);
  ASSERT_TRUE(camera.ok());
  const Ray middle = CameraRay(*camera, 400, 300, 800, 600);
  EXPECT_TRUE(middle.origin.isApprox(Eigen::Vector3d(4, 0.5, 0), kRounding));
  EXPECT_TRUE(middle.direction.isApprox(Eigen::Vector3d(-1, 0, 0), kRounding));
  // Right in the picture is -z there, and up is y.
  const Ray right = CameraRay(*camera, 800, 300, 800, 600);
  EXPECT_NEAR(-std::tan(0.5 * 0.6911112070083618),
              right.direction.z() / -right.direction.x(), kRounding);
  EXPECT_GT(CameraRay(*camera, 400, 0, 800, 600).direction.y(), 0.0);
}

TEST(Transforms, FocalLengthsScaleWithTheImage) {
  const Views views = ParseTransforms("t.json", PixelTransforms());
  ASSERT_TRUE(views.ok()) << views.status().message();
  const Camera full = CameraOf((*views)[0], 160, 120).value();
  EXPECT_EQ(Eigen::Vector2d(120, 130), *full.focal_pixels);
  EXPECT_EQ(Eigen::Vector2d(81, 59.5), *full.centre_pixels);
  const Camera half = CameraOf((*views)[0], 80, 60).value();
  EXPECT_EQ(Eigen::Vector2d(60, 65), *half.focal_pixels);
  EXPECT_EQ(Eigen::Vector2d(40.5, 29.75), *half.centre_pixels);
  EXPECT_TRUE(CameraRay(full, 24, 32, 160, 120)
                  .direction.isApprox(CameraRay(half, 12, 16, 80, 60).direction,
                                      kRounding));
  EXPECT_EQ(
      "image: expected the proportions of view a, 160 x 120, found 100 x 100",
      CameraOf((*views)[0], 100, 100).status().message());
}

TEST(Transforms, RefusesWhatIsNoPinholeWithAPose) {
  const struct {
    std::string text, error;
  } cases[] = {
      {"[]", "t.json: expected a JSON object"},
      {"{\"frames\": [", "t.json: expected a JSON object"},
      {std::string(40, '['), "t.json: expected a JSON object"},
      {"{}", "t.json: frames: expected a list of 1 to 10000"},
      {"{\"frames\": []}", "t.json: frames: expected a list"},
      {"{\"frames\": [3]}", "t.json: frames[0]: expected a map with a text"},
      {With(SmallTransforms(), "\"camera_angle_x\": 0.6911112070083618,", ""),
       "t.json: camera_angle_x: expected an angle in (0, pi), or fl_x"},
      {With(SmallTransforms(), "0.6911112070083618", "0"),
       "t.json: camera_angle_x: expected an angle"},
      {With(SmallTransforms(), "[[1, 0, 0, 0]", "[[2, 0, 0, 0]"),
       "t.json: frames[0].transform_matrix: expected a rotation, found axes of "
       "lengths 2, 1, 1"},
      {With(SmallTransforms(), "[[1, 0, 0, 0]", "[[-1, 0, 0, 0]"),
       "t.json: frames[0].transform_matrix: expected a rotation, found a "
       "mirror"},
      {With(SmallTransforms(), "[[1, 0, 0, 0]", "[[1, 0, 0]"),
       "t.json: frames[0].transform_matrix: expected four rows"},
      {With(SmallTransforms(), "[0, 0, 0, 1]", "[0, 0, 0.1, 1]"),
       "t.json: frames[0].transform_matrix: expected 0, 0, 0, 1 in the last"},
      {With(SmallTransforms(), "r_1", "r_0"),
       "t.json: frames: expected every file_path to name another file"},
      {With(PixelTransforms(), "\"k1\": 0", "\"k1\": 0.1"),
       "t.json: k1: expected 0: images without distortion"},
      {With(PixelTransforms(), "OPENCV", "OPENCV_FISHEYE"),
       "t.json: camera_model: expected PINHOLE, SIMPLE_PINHOLE or an OPENCV "
       "without distortion, found \"OPENCV_FISHEYE\""},
      {With(PixelTransforms(), "120.0", "-3"), "t.json: fl_x: expected a numb"},
      {With(PixelTransforms(), "\"h\": 120", "\"h\": 0"),
       "t.json: w, h: expected the size of the images"},
      {With(PixelTransforms(), "\"w\": 160, ", ""), "t.json: w, h: expected"}};
  for (const auto& c : cases) {
    const Views views = ParseTransforms("t.json", c.text);
    ASSERT_FALSE(views.ok()) << c.error;
    EXPECT_EQ(0u, views.status().message().find(c.error))
        << views.status().message();
    EXPECT_EQ(StatusCode::kInvalidInput, views.status().code());
  }
}

TEST(Transforms, NamesKeepFoldersApartWhereTheyMust) {
  const Views views = ParseTransforms(
      "t.json", With(SmallTransforms(), "./train/r_1", "./val/r_0"));
  ASSERT_TRUE(views.ok()) << views.status().message();
  EXPECT_EQ("train_r_0", (*views)[0].name);
  EXPECT_EQ("val_r_0", (*views)[1].name);
}

Views ParseText(const std::string& cameras, const std::string& images) {
  return ParseColmapText({"cameras.txt", cameras}, {"images.txt", images});
}
Views ParseBinary(const std::string& cameras, const std::string& images) {
  return ParseColmapBinary({"cameras.bin", cameras}, {"images.bin", images});
}

// COLMAP: camera_from_world in OpenCV's frame; views in the order of names.
TEST(Colmap, TextAndBinaryModelsAreOneAndProjectAsColmapDoes) {
  const Views text = ParseText(SmallColmapCameras(), SmallColmapImages());
  const Views binary =
      ParseBinary(SmallColmapCamerasBinary(), SmallColmapImagesBinary());
  ASSERT_TRUE(text.ok()) << text.status().message();
  ASSERT_TRUE(binary.ok()) << binary.status().message();
  for (const Views& views : {text, binary}) {
    ASSERT_EQ(2u, views->size());
    EXPECT_EQ("a", (*views)[0].name);
    EXPECT_EQ("b", (*views)[1].name);
    // In b, (0.2, 0.1, 1) of the world is at depth 5: to the right and, y
    // being down, below.
    const CalibratedView& b = (*views)[1];
    const Camera camera = CameraOf(b, 80, 60).value();
    const auto p = ProjectPoint(camera, {0.2, 0.1, 1.0}, 80, 60);
    ASSERT_TRUE(p.has_value());
    EXPECT_NEAR(40.5 + 65 * 0.2 / 5, p->x, kRounding);
    EXPECT_NEAR(29 + 66 * 0.1 / 5, p->y, kRounding);
    EXPECT_NEAR(5.0, p->depth, kRounding);
    // In a, half a turn about y takes x to -x and z to -z.
    const Camera turned = CameraOf((*views)[0], 160, 120).value();
    const auto q = ProjectPoint(turned, {0.2, 0.1, 1.0}, 160, 120);
    ASSERT_TRUE(q.has_value());
    EXPECT_NEAR(80 + 130 * (-0.2 + 0.5) / 3, q->x, 1e-9);
    EXPECT_NEAR(60 + 130 * 0.1 / 3, q->y, 1e-9);
  }
}

TEST(Colmap, ReadsAFolderOfEither) {
  const TempDir dir;
  EXPECT_EQ(0u, ReadColmap(dir.path())
                    .status()
                    .message()
                    .find(dir.path() + ": expected a folder with cameras.bin"));
  WriteBytes(dir.File("images.txt"), SmallColmapImages());
  EXPECT_FALSE(ReadColmap(dir.path()).ok());
  WriteBytes(dir.File("cameras.txt"), SmallColmapCameras());
  EXPECT_TRUE(ReadColmap(dir.path()).ok());
  // The binary model is taken where there are both.
  WriteBytes(dir.File("images.bin"), SmallColmapImagesBinary());
  WriteBytes(dir.File("cameras.bin"), SmallColmapCamerasBinary(2));
  EXPECT_NE(
      std::string::npos,
      ReadColmap(dir.path()).status().message().find("found SIMPLE_RADIAL"));
}

TEST(Colmap, RefusesOtherCamerasByName) {
  for (const std::string model : {"SIMPLE_RADIAL", "OPENCV_FISHEYE", "MINE"}) {
    EXPECT_EQ(
        "cameras.txt: camera 7: expected PINHOLE or SIMPLE_PINHOLE, "
        "found " +
            model + "; undistort the images with COLMAP first",
        ParseText(With(SmallColmapCameras(), "7 PINHOLE", "7 " + model),
                  SmallColmapImages())
            .status()
            .message());
  }
  EXPECT_EQ(
      "cameras.bin: camera 7: expected PINHOLE or SIMPLE_PINHOLE, found "
      "SIMPLE_RADIAL; undistort the images with COLMAP first",
      ParseBinary(SmallColmapCamerasBinary(2), SmallColmapImagesBinary())
          .status()
          .message());
  EXPECT_EQ("cameras.bin: expected the number of a camera model, found 99",
            ParseBinary(SmallColmapCamerasBinary(99), SmallColmapImagesBinary())
                .status()
                .message());
}

TEST(Colmap, RefusesMalformedText) {
  const struct {
    std::string cameras, images, error;
  } cases[] = {
      {"", SmallColmapImages(),
       "images.txt: image set/a.png: expected a camera of cameras.txt, found "
       "1"},
      {SmallColmapCameras(), "", "images.txt: expected 1 to 10000 images"},
      {"1 PINHOLE 3\n", SmallColmapImages(), "cameras.txt: line 1: expected C"},
      {With(SmallColmapCameras(), "130", "130x"), SmallColmapImages(),
       "cameras.txt: line 3: expected CAMERA_ID"},
      {With(SmallColmapCameras(), "130", "-130"), SmallColmapImages(),
       "cameras.txt: camera 1: expected a size"},
      {With(SmallColmapCameras(), "130", "nan"), SmallColmapImages(),
       "cameras.txt: camera 1: expected a size"},
      {With(SmallColmapCameras(), "160", "0"), SmallColmapImages(),
       "cameras.txt: camera 1: expected a size"},
      {With(SmallColmapCameras(), " 60\n", "\n"), SmallColmapImages(),
       "cameras.txt: camera 1: expected a size"},
      {SmallColmapCameras(), With(SmallColmapImages(), "7 set/b.png", "7"),
       "images.txt: line 2: expected IMAGE_ID"},
      {SmallColmapCameras(), With(SmallColmapImages(), "3 1 0", "3 2 0"),
       "images.txt: image set/b.png: expected a quaternion of length 1"},
      {SmallColmapCameras(), With(SmallColmapImages(), "0 4 7", "0 inf 7"),
       "images.txt: image set/b.png: expected a quaternion of length 1"},
      {SmallColmapCameras(), With(SmallColmapImages(), "b.png", "a.png"),
       "images.txt: expected every image to name another file"}};
  for (const auto& c : cases) {
    const Views views = ParseText(c.cameras, c.images);
    ASSERT_FALSE(views.ok()) << c.error;
    EXPECT_EQ(0u, views.status().message().find(c.error))
        << views.status().message();
  }
}

TEST(Colmap, RefusesBinaryFilesThatAreCutOff) {
  const std::string cameras = SmallColmapCamerasBinary();
  const std::string images = SmallColmapImagesBinary();
  for (size_t n = 0; n < cameras.size(); ++n) {
    const Views views = ParseBinary(cameras.substr(0, n), images);
    ASSERT_FALSE(views.ok()) << n;
    EXPECT_EQ(0u, views.status().message().find("cameras.bin: expected more"));
  }
  for (size_t n = 0; n < images.size(); ++n) {
    const Views views = ParseBinary(cameras, images.substr(0, n));
    ASSERT_FALSE(views.ok()) << n;
    EXPECT_EQ(0u, views.status().message().find("images.bin: expected more"));
  }
  // Counts that no file holds.
  const std::string huge(8, '\xff');
  EXPECT_FALSE(ParseBinary(huge + cameras.substr(8), images).ok());
  EXPECT_FALSE(ParseBinary(cameras, huge + images.substr(8)).ok());
}

// Damaged files are refused with a line that names one, or have views that
// cameras can be made of.
TEST(CalibratedViews, DamagedFiles) {
  const auto check = [](const Views& views) {
    if (!views.ok()) {
      EXPECT_EQ(StatusCode::kInvalidInput, views.status().code());
      EXPECT_EQ(std::string::npos, views.status().message().find('\n'));
      return;
    }
    for (const CalibratedView& view : *views) {
      EXPECT_EQ("", PoseFault(view.world_from_camera));
      const StatusOr<Camera> camera = CameraOf(view, 80, 60);
      if (camera.ok()) {
        EXPECT_TRUE(IsValidCamera(*camera));
      }
    }
  };
  const auto damage = [&](const std::string& bytes,
                          const std::function<Views(const std::string&)>& of) {
    const auto read = [&](const std::string& text) { check(of(text)); };
    ForEachTruncation(bytes, 100, read);
    ForEachCorruption(bytes, 100, 1500, 3, read);
  };
  for (const std::string& text : {SmallTransforms(), PixelTransforms()}) {
    damage(text,
           [](const std::string& t) { return ParseTransforms("t.json", t); });
  }
  damage(SmallColmapCameras(), [](const std::string& t) {
    return ParseText(t, SmallColmapImages());
  });
  damage(SmallColmapImages(), [](const std::string& t) {
    return ParseText(SmallColmapCameras(), t);
  });
  damage(SmallColmapCamerasBinary(), [](const std::string& t) {
    return ParseBinary(t, SmallColmapImagesBinary());
  });
  damage(SmallColmapImagesBinary(), [](const std::string& t) {
    return ParseBinary(SmallColmapCamerasBinary(), t);
  });
}

TEST(ViewNames, AreNamesOfFiles) {
  for (const std::string name : {"a", "r 3.left", "..."}) {
    EXPECT_EQ("", ViewNameFault(name));
  }
  for (const std::string& name :
       {std::string(), std::string("."), std::string(".."), std::string("a/b"),
        std::string("a\\b"), std::string("a\nb"), std::string(201, 'a')}) {
    EXPECT_NE("", ViewNameFault(name));
  }
}

}  // namespace
}  // namespace ibrdf
