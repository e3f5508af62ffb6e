// Problem files of textures.
#include <gtest/gtest.h>

#include <string>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST(ProblemText, ViewsOfTexturesHaveFiles) {
  const std::string least =
      "problem: textures\ngeometry: {mesh: m.obj}\n"
      "illumination: {known: {sky: {}}}\n";
  const StatusOr<Problem> p = ParseProblem(
      "d/p.yaml",
      least +
          "views: [{name: a, file: a.exr, mask: b.png}, {name: c, file: "
          "c.exr}]\nimage: {response: srgb}",
      {"uncertainty.order=3", "texture.width=32"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_TRUE(CheckTextures(*p).ok()) << CheckTextures(*p).message();
  EXPECT_EQ("d/a.exr", p->views.list[0].file);
  EXPECT_EQ("d/b.png", p->views.list[0].mask);
  EXPECT_EQ("", p->views.list[1].mask);
  EXPECT_EQ(3, p->uncertainty.order);
  EXPECT_EQ(32, p->texture.width);
  int named = 0;
  for (const NamedFile& file : NamedFiles(*p)) {
    named += file.path == "d/a.exr" || file.path == "d/b.png" ||
             file.path == "d/c.exr";
  }
  EXPECT_EQ(3, named);
  // Other programs refuse them.
  const std::string refused =
      "d/p.yaml: problem: textures are ibrdf_uncertainty's alone";
  EXPECT_EQ(refused, CheckSolvable(*p).message());
  EXPECT_EQ(refused, CheckRenderable(*p).message());
}

TEST(ProblemText, TexturesNeedViewsASurfaceAndLight) {
  const std::string least =
      "problem: textures\ngeometry: {mesh: m.obj}\n"
      "illumination: {known: {sky: {}}}\nviews: [{name: a, file: a.exr}]\n";
  const struct {
    std::string override_text, error;
  } cases[] = {
      {"problem=joint", "problem: expected textures, found joint"},
      {"views=null", "views: expected with problem: textures"},
      {"views=[{name: a}]", "views[0].file: expected the view's image"},
      {"image.file=a.exr", "image: expected no file"},
      {"image={width: 8, height: 8}", "image: expected no file"},
      {"image.response=unknown", "image.response: expected a known curve"},
      {"geometry={normals: n.exr}", "geometry: expected a mesh, or sphere"},
      {"geometry={sphere: {centre: [1, 2], radius: 3}}",
       "geometry: expected a mesh, or sphere"},
      {"reflectance.known=a.binary", "reflectance.known: expected without"},
      {"illumination=null", "illumination.known: expected with problem"},
      {"views=[{name: a, file: a.exr, camera: {type: perspective, "
       "focal_pixels: 0}}]",
       "views[0].camera.focal_pixels: expected"},
      {"views=[{name: a, file: a.exr, camera: {world_from_camera: [[2, 0, 0, "
       "0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}]",
       "views[0].camera.world_from_camera: expected a rotation"},
      {"uncertainty.order=0", "uncertainty.order: expected a whole number"},
      {"uncertainty.sigma=0", "uncertainty.sigma: expected"},
      {"texture.width=0", "texture.width: expected a whole number"}};
  for (const auto& c : cases) {
    const StatusOr<Problem> p =
        ParseProblem("p.yaml", least, {c.override_text});
    const Status status = p.ok() ? CheckTextures(*p) : p.status();
    EXPECT_EQ(0u, status.message().find("p.yaml: " + c.error))
        << c.override_text << ": " << status.message();
  }
  EXPECT_EQ("p.yaml: problem: expected textures, found joint",
            CheckTextures(ParseProblem("p.yaml",
                                       "image: {file: a}\ngeometry: {sphere: "
                                       "{}}",
                                       {})
                              .value())
                .message());
}

}  // namespace
}  // namespace ibrdf
