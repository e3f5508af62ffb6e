#include "ibrdf/solvers/forward/known_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "tests/support/camera_files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Sums of floats, and textures of floats.
constexpr double kTextureRounding = 1e-6;
constexpr char kMaterial[] =
    "{base: [0.6, 0.4, 0.2], roughness: 0.45, metallic: 0.25, specular: 0.5}";

Image Even(double r, double g, double b) {
  Image image(5, 3);
  for (size_t i = 0; i < image.num_pixels(); ++i) {
    image.rgb[3 * i] = static_cast<float>(r);
    image.rgb[3 * i + 1] = static_cast<float>(g);
    image.rgb[3 * i + 2] = static_cast<float>(b);
  }
  return image;
}

double LargestRatio(const Image& a, const Image& b) {
  double largest = 0.0;
  for (size_t k = 0; k < a.rgb.size(); ++k) {
    if (a.rgb[k] == b.rgb[k]) continue;
    largest = std::max(largest, std::abs(double{a.rgb[k]} / b.rgb[k] - 1.0));
  }
  return largest;
}

class Textured : public ::testing::Test {
 protected:
  Textured() {
    MeshSpec torus;
    const TriangleMesh mesh = TorusMesh(24, 12);
    for (const auto& v : mesh.vertices) {
      torus.vertices.push_back(v.cast<double>());
    }
    for (const auto& n : mesh.normals) {
      torus.normals.push_back(n.cast<double>());
    }
    torus.triangles = mesh.triangles;
    WriteBytes(dir_.File("torus.obj"), ObjBytes(torus));
    Write("base.exr", Even(0.6, 0.4, 0.2));
    Write("roughness.exr", Even(0.45, 0.45, 0.45));
    Write("metallic.exr", Even(0.25, 0.25, 0.25));
    Write("specular.exr", Even(0.5, 0.5, 0.5));
  }

  void Write(const std::string& name, const Image& image) {
    ASSERT_TRUE(WriteExr(image, dir_.File(name)).ok());
  }

  Problem Parse(const std::string& shape, const std::string& material,
                const std::vector<std::string>& overrides = {}) {
    const StatusOr<Problem> problem = ParseProblem(
        dir_.File("p.yaml"),
        "image: {width: 20, height: 20}\nquality: preview\ngeometry: " + shape +
            "\ncamera: {type: perspective, from: [0.5, 4, 3]}\nreflectance: "
            "{known: {principled: " +
            material + "}}\nillumination: {width: 64, known: {sky: {}}}\n",
        overrides);
    CHECK(problem.ok()) << problem.status().message();
    return *problem;
  }

  RenderedScene Render(const std::string& shape, const std::string& material,
                       const std::vector<std::string>& overrides = {}) {
    StatusOr<RenderedScene> out =
        RenderScene(Parse(shape, material, overrides), {});
    CHECK(out.ok()) << out.status().message();
    return *std::move(out);
  }

  const std::string torus_ = "{mesh: torus.obj, fit: none}";
  const std::string constant_ =
      "{base: base.exr, roughness: roughness.exr, metallic: metallic.exr, "
      "specular: specular.exr}";
  TempDir dir_;
};

TEST_F(Textured, AConstantTextureIsTheMaterial) {
  for (const std::string& shape : {std::string("{sphere: {}}"), torus_}) {
    for (const std::string effects :
         {"none", "visibility", "interreflection"}) {
      if (shape != torus_ && effects != "none") continue;
      for (const std::string quality : {"preview", "reference"}) {
        if (quality == "reference" && effects == "interreflection") continue;
        SCOPED_TRACE(shape + effects + quality);
        const std::vector<std::string> set = {
            "effects=[" + effects + "]", "quality=" + quality, "image.width=12",
            "image.height=12"};
        const std::vector<std::string> plain =
            effects == "none" ? std::vector<std::string>{"effects=none", set[1],
                                                         set[2], set[3]}
                              : set;
        const RenderedScene expected = Render(shape, kMaterial, plain);
        const RenderedScene found = Render(shape, constant_, plain);
        EXPECT_LT(LargestRatio(found.image, expected.image), kTextureRounding);
        EXPECT_EQ(expected.mask.inside, found.mask.inside);
      }
    }
  }
}

// Left and right of the sphere, that is u below and above 1/2, are two
// materials.
TEST_F(Textured, ASphereOfTwoMaterialsShowsEach) {
  Image halves(64, 1);
  Image rough(64, 1);
  for (int x = 0; x < 64; ++x) {
    halves.At(x, 0)[0] = x < 32 ? 0.8f : 0.1f;
    halves.At(x, 0)[1] = halves.At(x, 0)[2] = 0.3f;
    for (int c = 0; c < 3; ++c) rough.At(x, 0)[c] = x < 32 ? 0.2f : 0.7f;
  }
  Write("halves.exr", halves);
  Write("rough.exr", rough);
  const std::vector<std::string> front = {"camera={type: orthographic}",
                                          "effects=none"};
  const Image both =
      Render("{sphere: {}}", "{base: halves.exr, roughness: rough.exr}", front)
          .image;
  const Image left =
      Render("{sphere: {}}", "{base: [0.8, 0.3, 0.3], roughness: 0.2}", front)
          .image;
  const Image right =
      Render("{sphere: {}}", "{base: [0.1, 0.3, 0.3], roughness: 0.7}", front)
          .image;
  double differ = 0.0;
  for (int y = 4; y < 16; ++y) {
    for (int c = 0; c < 3; ++c) {
      // The sun is sampled as finely as the lobe of all points asks for.
      EXPECT_NEAR(1.0, both.At(5, y)[c] / left.At(5, y)[c], 2e-3);
      EXPECT_NEAR(1.0, both.At(14, y)[c] / right.At(14, y)[c], 2e-3);
      differ = std::max(
          differ, std::abs(both.At(14, y)[c] / double{left.At(14, y)[c]} - 1));
    }
  }
  EXPECT_GT(differ, 0.2);
}

// A lobe that sees the object along rays of its own: what they meet is textured
// too.
TEST_F(Textured, AConstantMirrorIsTheMaterial) {
  Write("gloss.exr", Even(0.2, 0.2, 0.2));
  const std::vector<std::string> set = {"effects=[interreflection]",
                                        "image.width=10", "image.height=10"};
  const RenderedScene expected = Render(
      torus_, "{base: [0.6, 0.4, 0.2], roughness: 0.2, metallic: 0.25}", set);
  EXPECT_GT(expected.plan.lobe_rays, 0);
  const RenderedScene found = Render(
      torus_, "{base: base.exr, roughness: gloss.exr, metallic: 0.25}", set);
  EXPECT_EQ(expected.plan.lobe_rays, found.plan.lobe_rays);
  EXPECT_LT(LargestRatio(found.image, expected.image), kTextureRounding);
}

TEST_F(Textured, PngBaseColourIsSrgbAndTheRestIsLinear) {
  Rgb8Image codes(2, 2);
  for (size_t k = 0; k < codes.rgb.size(); ++k) codes.rgb[k] = 128;
  ASSERT_TRUE(WritePng(codes, dir_.File("codes.png")).ok());
  const Problem problem =
      Parse("{sphere: {}}", "{base: codes.png, roughness: codes.png}");
  const KnownTexture texture =
      KnownTexture::Load(*problem.reflectance.principled, true).value();
  const Disney brdf = texture.At({0.3f, 0.6f});
  EXPECT_NEAR(0.2158605, brdf.base[1], 1e-6);  // IEC 61966-2-1
  EXPECT_NEAR(128.0 / 255.0, brdf.roughness, 1e-6);
  EXPECT_EQ(0.5, brdf.specular);
}

TEST_F(Textured, MeanIsWrittenAsTheBrdf) {
  const RenderedScene out = Render(torus_, constant_);
  ASSERT_TRUE(out.painted_brdf.has_value());
  Disney brdf;
  brdf.base = {0.6, 0.4, 0.2};
  brdf.roughness = 0.45;
  brdf.metallic = 0.25;
  EXPECT_NEAR(brdf.Evaluate(0.1, 0.4, 1.0)[1],
              InterpolateMerl(*out.painted_brdf, 0.1, 0.4, 1.0)[1], 2e-3);
}

TEST_F(Textured, BadTexturesAreNamed) {
  Write("negative.exr", Even(0.5, -0.1, 0.5));
  Write("coloured.exr", Even(0.5, 0.1, 0.5));
  Write("bright.exr", Even(1.5, 1.5, 1.5));
  Write("nan.exr", Even(std::nan(""), 0.5, 0.5));
  WriteBytes(dir_.File("some.obj"),
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf 1 3 2\n");
  WriteBytes(dir_.File("far.obj"),
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 0 1\nf 1/1 2/2 "
             "3/3\n");
  const struct {
    std::string shape, material, error;
  } cases[] = {
      {torus_, "{base: missing.exr}", "missing.exr"},
      {torus_, "{base: negative.exr}",
       "negative.exr: reflectance.known.principled.base: expected values in "
       "[0, 1], found -0.1"},
      {torus_, "{base: nan.exr}", "expected values in [0, 1], found nan"},
      {torus_, "{roughness: coloured.exr}",
       "coloured.exr: reflectance.known.principled.roughness: expected a grey "
       "texture, found the colour 0.5, 0.1, 0.5"},
      {torus_, "{metallic: bright.exr}",
       "expected values in [0, 1], found 1.5"},
      {"{mesh: some.obj, fit: none}", "{base: base.exr}",
       "some.obj: expected texture coordinates (vt) on all faces or on none"},
      {"{mesh: far.obj, fit: none}", "{base: base.exr}",
       "far.obj: expected texture coordinates in [0, 1], found 2, 0"}};
  for (const auto& c : cases) {
    const Status status = RenderScene(Parse(c.shape, c.material), {}).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << c.error;
    EXPECT_NE(std::string::npos, status.message().find(c.error))
        << status.message();
  }
  EXPECT_NE(std::string::npos,
            CheckRenderable(Parse("{normals: n.exr}", "{base: base.exr}",
                                  {"camera={type: orthographic}"}))
                .message()
                .find("expected a sphere or a mesh with textures"));
  EXPECT_NE(
      std::string::npos,
      CheckRenderable(Parse(torus_, "{base: base.exr}", {"effects=harmonics"}))
          .message()
          .find("effects: expected no harmonics with textures"));
}

TEST_F(Textured, OverlapsAreWarnedOf) {
  const std::string square =
      "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\n";
  const auto warnings = [&](const std::string& face) {
    WriteBytes(dir_.File("square.obj"), square + face);
    return Render("{mesh: square.obj, fit: none}", "{base: base.exr}").warnings;
  };
  EXPECT_TRUE(warnings("f 1/1 3/3 4/4\n").empty());
  const std::vector<std::string> found = warnings("f 1/1 3/2 4/3\n");
  ASSERT_EQ(1u, found.size());
  EXPECT_NE(std::string::npos, found[0].find("texture coordinates overlap: "))
      << found[0];
}

// One texture serves all views.
TEST_F(Textured, SeveralViewsShowOneSurface) {
  Image stripes(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) {
        stripes.At(x, y)[c] = (x + y) / 8 % 2 == 0 ? 0.7f : 0.2f;
      }
    }
  }
  Write("stripes.exr", stripes);
  WriteBytes(dir_.File("t.json"), SmallTransforms());
  const Problem problem = Parse("{sphere: {}}", "{base: stripes.exr}",
                                {"camera=null", "views={transforms: t.json}"});
  int views = 0;
  EXPECT_TRUE(
      RenderViews(problem, {}, [&](const ViewSpec&, const RenderedScene& out) {
        ++views;
        EXPECT_GT(out.mask.CountInside(), 10u);
        return OkStatus();
      }).ok());
  EXPECT_EQ(2, views);
}

}  // namespace
}  // namespace ibrdf
