// Cameras and views of problem files.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

// What all files of several views here begin with.
constexpr char kManyViews[] =
    "image: {width: 8, height: 8}\ngeometry: {mesh: m.obj}\n";

std::vector<Refusal> ViewRefusals() {
  const std::string least = kManyViews;
  const std::string normals =
      "image: {width: 8, height: 8}\ngeometry: {normals: n.exr}\n";
  const std::string sphere =
      "image: {width: 8, height: 8}\ngeometry: {sphere: {centre: [4, 4], "
      "radius: 3}}\n";
  return {
      {least + "views: []", "views: expected a list of 1 to 10000 views"},
      {least + "views: 3",
       "views: expected a map of transforms, colmap, images or masks"},
      {least + "views: {}", "views: expected a list, or one of transforms"},
      {least + "views: {transforms: a.json, colmap: b}",
       "views: expected a list, or one of transforms"},
      {least + "views: {transform: a.json}",
       "views.transform: unknown key; the nearest known one is "
       "views.transforms"},
      {least + "views: [3]",
       "views[0]: expected a map of name, camera, file, mask, labels or "
       "exposure"},
      {least + "views: [{camera: {}}]", "views[0].name: expected the view's"},
      {least + "views: [{name: a/b}]",
       "views[0].name: expected a name that a file may have"},
      {least + "views: [{name: a}, {name: a}]",
       "views[1].name: expected a name that no other view has"},
      {least + "views: [{name: a, files: b}]", "views[0].files: unknown key"},
      {least + "views: [{name: a, file: b}]",
       "image: expected no file, mask or size beside the view's own file"},
      {least + "views: [{name: a, mask: b}]",
       "views[0].mask: expected beside the view's file"},
      {least + "views: [{name: a, labels: b}]",
       "views[0].labels: expected beside the view's file"},
      {least + "views: [{name: a, exposure: 2}]",
       "views[0].exposure: expected beside the view's file"},
      {least + "views: [{name: a, file: b, exposure: 0}]",
       "views[0].exposure: expected a number > 0"},
      {least + "views: [{name: a, camera: {fov_degrees: 3}}]",
       "views[0].camera.fov_degrees: expected with camera.type: perspective"},
      {least + "views: [{name: a, camera: {type: perspective, to: [0, 0, 4]}}]",
       "views[0].camera: expected `from` apart"},
      {least + "camera: {}\nviews: [{name: a}]",
       "views: expected without camera"},
      {normals + "views: [{name: a}, {name: b}]",
       "geometry: expected a sphere or a mesh with several views: a map of "
       "normals is of one"},
      {sphere + "views: {colmap: c}",
       "geometry.sphere: expected {} with several views"}};
}

TEST(ProblemText, CamerasHavePosesAndLensesInPixels) {
  const std::string least = "image: {file: a}\ngeometry: {sphere: {}}\n";
  const StatusOr<Problem> p = ParseProblem(
      "p.yaml",
      least +
          "camera: {type: perspective, focal_pixels: 500, centre_pixels: "
          "[81, 60.5], world_from_camera: [[0, 0, 1, 4], [0, 1, 0, 0.5], "
          "[-1, 0, 0, 0], [0, 0, 0, 1]]}",
      {});
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_EQ(Eigen::Vector2d(500, 500), *p->camera.focal_pixels);
  EXPECT_EQ(Eigen::Vector2d(81, 60.5), *p->camera.centre_pixels);
  EXPECT_EQ(Eigen::Vector3d(4, 0.5, 0), AxesOf(p->camera).centre);
  EXPECT_EQ(Eigen::Vector3d(1, 0, 0),
            AxesOf(p->camera).world_from_camera.col(2));
  EXPECT_TRUE(p->camera_placed);
  const std::string pinhole = least + "camera: {type: perspective, ";
  const struct {
    std::string text, error;
  } cases[] = {
      {pinhole + "focal_pixels: 0}",
       "camera.focal_pixels: expected a number > 0 or a list of two"},
      {pinhole + "focal_pixels: [3, -1]}", "camera.focal_pixels: expected"},
      {pinhole + "focal_pixels: 3, fov_degrees: 4}",
       "camera.fov_degrees: expected without focal_pixels"},
      {pinhole + "centre_pixels: 3}", "camera.centre_pixels: expected a list"},
      {least + "camera: {focal_pixels: 3}",
       "camera.focal_pixels: expected with camera.type: perspective only"},
      {least + "camera: {world_from_camera: [[1, 0, 0, 0]]}",
       "camera.world_from_camera: expected four lists of four numbers"},
      {least + "camera: {world_from_camera: [[2, 0, 0, 0], [0, 2, 0, 0], [0, "
               "0, 2, 0], [0, 0, 0, 1]]}",
       "camera.world_from_camera: expected a rotation, found axes of lengths "
       "2, 2, 2"},
      {pinhole + "from: [0, 0, 3], world_from_camera: [[1, 0, 0, 0], [0, 1, "
                 "0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}",
       "camera.from: expected without a pose"},
      {"image: {file: a}\ngeometry: {normals: n.exr}\ncamera: "
       "{world_from_camera: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, "
       "0, 1]]}",
       "camera.world_from_camera: expected without geometry.normals"}};
  for (const auto& c : cases) {
    EXPECT_EQ(0u, ParseError(c.text).find("p.yaml: " + c.error))
        << ParseError(c.text);
  }
}

TEST(ProblemText, ViewsAreAListOrAFile) {
  const std::string least = kManyViews;
  const StatusOr<Problem> p = ParseProblem(
      "d/p.yaml",
      least +
          "views: [{name: left, camera: {type: perspective, fov_degrees: "
          "20}}, {name: right}]",
      {});
  ASSERT_TRUE(p.ok()) << p.status().message();
  ASSERT_EQ(2u, p->views.list.size());
  EXPECT_EQ("left", p->views.list[0].name);
  EXPECT_EQ(20.0, p->views.list[0].camera.fov_degrees);
  EXPECT_EQ(CameraType::kOrthographic, p->views.list[1].camera.type);
  // Cameras and mesh share one frame.
  EXPECT_EQ(MeshFit::kNone, p->geometry.fit);
  EXPECT_EQ(MeshFit::kUnitSphere,
            ParseProblem("d/p.yaml", least + "views: {colmap: c}",
                         {"geometry.fit=unit_sphere"})
                ->geometry.fit);
  EXPECT_EQ("d/t.json",
            ParseProblem("d/p.yaml", least + "views: {transforms: t.json}", {})
                ->views.transforms);
  for (const Refusal& c : ViewRefusals()) {
    EXPECT_EQ(0u, ParseError(c.text).find("p.yaml: " + c.error))
        << ParseError(c.text);
  }
}

TEST(ProblemText, SolvesTakeViewsInPlaceOfTheImage) {
  const std::string least = "image: {file: a}\ngeometry: {mesh: m.obj}\n";
  const Problem one =
      ParseProblem("p.yaml",
                   least +
                       "views: [{name: a, camera: {type: perspective, "
                       "fov_degrees: 20}}]",
                   {})
          .value();
  EXPECT_TRUE(CheckSolvable(one).ok());
  EXPECT_EQ(20.0, one.camera.fov_degrees);
  const auto check = [](const std::string& text) {
    return CheckSolvable(
        ParseProblem("p.yaml", "geometry: {mesh: m.obj}\n" + text, {}).value());
  };
  for (const std::string views :
       {"[{name: a, file: a.exr}, {name: b, file: b.png, mask: m.png}]",
        "[{name: a, file: a.exr}]", "{colmap: c, images: d, masks: m}",
        "{transforms: t.json}"}) {
    EXPECT_TRUE(check("views: " + views).ok()) << views;
  }
  const struct {
    std::string text, error;
  } refused[] = {
      {"views: [{name: a}, {name: b}]", "views[0].file: expected the view's"},
      {"views: [{name: a, file: f}, {name: b}]",
       "views[1].file: expected the view's image, found nothing"},
      {"image: {file: a}\nviews: {colmap: c}", "image: expected no file"},
      {"image: {width: 4, height: 4}\nviews: {colmap: c}",
       "image: expected no file"},
      {"views: [{name: a, file: f, labels: l}, {name: b, file: f}]",
       "views[1].labels: expected labels as of the other views"},
      {"reflectance: {labels: l}\nviews: {colmap: c}",
       "reflectance.labels: expected auto, or labels of each view"},
      {"reflectance: {labels: l}\nviews: [{name: a, file: f}, {name: b, file: "
       "f}]",
       "reflectance.labels: expected auto, or labels of each view"}};
  for (const auto& c : refused) {
    EXPECT_EQ(0u, check(c.text).message().find("p.yaml: " + c.error))
        << check(c.text).message();
  }
  for (const std::string reflectance :
       {"{labels: l}", "{known: {lambertian: 0.5}}", "{variation: albedo}"}) {
    EXPECT_FALSE(
        ParseProblem("p.yaml",
                     "geometry: {mesh: m.obj}\nreflectance: " + reflectance +
                         "\nviews: [{name: a, file: f, labels: l}]",
                     {})
            .ok())
        << reflectance;
  }
}

}  // namespace
}  // namespace ibrdf
