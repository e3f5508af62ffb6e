#include "ibrdf/solvers/forward/known_paint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr int kSize = 14;
// Floats of a file, and sums of them.
constexpr double kRounding = 1e-6;
// Tables are looked up in floats.
constexpr double kTable = 1e-5;
constexpr char kCoated[] =
    "cook_torrance: {diffuse: [0.6, 0.5, 0.4], roughness: 0.15}";

// A bowl open to the camera: shadows and bounces.
MeshSpec Bowl() {
  constexpr int kRings = 8, kColumns = 16;
  MeshSpec bowl;
  for (int i = 0; i <= kRings; ++i) {
    for (int k = 0; k < kColumns; ++k) {
      const double theta = kPi / 2 * i / kRings, phi = 2 * kPi * k / kColumns;
      bowl.vertices.emplace_back(std::sin(theta) * std::cos(phi),
                                 std::sin(theta) * std::sin(phi),
                                 -std::cos(theta));
    }
  }
  for (int i = 0; i < kRings; ++i) {
    for (int k = 0; k < kColumns; ++k) {
      const int a = i * kColumns + k, d = i * kColumns + (k + 1) % kColumns;
      bowl.triangles.push_back({a, a + kColumns, d + kColumns});
      bowl.triangles.push_back({a, d + kColumns, d});
    }
  }
  return bowl;
}

Image Even(float value) {
  Image image(kSize, kSize);
  for (float& a : image.rgb) a = value;
  return image;
}

// Red to the left, dark blue to the right.
Image TwoHalves() {
  Image image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      float* const a = image.At(x, y);
      a[0] = x < kSize / 2 ? 1.3f : 0.1f;
      a[1] = x < kSize / 2 ? 0.3f : 0.1f;
      a[2] = x < kSize / 2 ? 0.2f : 0.4f;
    }
  }
  return image;
}

class KnownPaintTest : public ::testing::Test {
 protected:
  KnownPaintTest() { WriteBytes(dir_.File("bowl.obj"), ObjBytes(Bowl())); }

  StatusOr<RenderedScene> Render(const std::string& shape,
                                 const std::string& known,
                                 const std::string& quality) const {
    const std::string geometry =
        shape == "bowl" ? "{mesh: bowl.obj, fit: none}" : "{sphere: {}}";
    const StatusOr<Problem> problem = ParseProblem(
        dir_.File("scene.yaml"),
        "image: {width: 14, height: 14}\ngeometry: " + geometry +
            "\nreflectance: {known: {" + known +
            "}}\nillumination: {width: 64, height: 32, known: {sky: "
            "{sun_phi_degrees: 35}}}\nquality: " +
            quality + "\n",
        {});
    if (!problem.ok()) return problem.status();
    IBRDF_RETURN_IF_ERROR(CheckRenderable(*problem));
    RenderSceneOptions options;
    options.num_threads = 1;
    return RenderScene(*problem, options);
  }

  // The same with paint over it. more: keys beside the file.
  StatusOr<RenderedScene> Painted(const std::string& shape,
                                  const std::string& known, const Image& paint,
                                  const std::string& quality,
                                  const std::string& more = "") {
    EXPECT_TRUE(WriteExr(paint, dir_.File("paint.exr")).ok());
    return Render(shape, known + ", albedo: paint.exr" + more, quality);
  }

  std::string Refusal(const Image& paint) {
    const Status status = Painted("sphere", kCoated, paint, "preview").status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos, status.message().find("paint.exr"));
    EXPECT_NE(std::string::npos,
              status.message().find("reflectance.known.albedo"));
    return status.message();
  }

  const TempDir dir_;
};

// Largest |log a / b| over the object.
double LargestLogDifference(const RenderedScene& a, const RenderedScene& b) {
  double largest = 0.0;
  for (size_t k = 0; k < a.image.rgb.size(); ++k) {
    if (a.mask.inside[k / 3] == 0) continue;
    largest = std::max(
        largest, std::abs(std::log(double{a.image.rgb[k]} / b.image.rgb[k])));
  }
  return largest;
}

// A bowl at reference quality takes long, so that one test has one.
const struct {
  const char *shape, *quality;
} kScenes[] = {
    {"sphere", "preview"}, {"sphere", "reference"}, {"bowl", "preview"}};

TEST_F(KnownPaintTest, PaintOfOneIsTheUnpaintedMaterial) {
  for (const auto& [shape, quality] : kScenes) {
    const RenderedScene plain = Render(shape, kCoated, quality).value();
    const RenderedScene painted =
        Painted(shape, kCoated, Even(1.0f), quality).value();
    EXPECT_LT(LargestLogDifference(painted, plain), kRounding)
        << shape << " " << quality;
  }
}

// A Lambertian is all paint, what it throws on itself too.
TEST_F(KnownPaintTest, EvenPaintOfALambertianIsItsAlbedo) {
  for (const auto& [shape, quality] : kScenes) {
    const RenderedScene grey =
        Render(shape, "lambertian: 0.4", quality).value();
    const RenderedScene factor =
        Painted(shape, "lambertian: 0.8", Even(0.5f), quality).value();
    EXPECT_LT(LargestLogDifference(factor, grey), kTable) << shape;
    const RenderedScene albedo = Painted(shape, "lambertian: 0.8", Even(0.4f),
                                         quality, ", unpainted_albedo: auto")
                                     .value();
    EXPECT_LT(LargestLogDifference(albedo, grey), kTable) << shape;
  }
}

TEST_F(KnownPaintTest, APixelsPaintIsItsOwn) {
  const RenderedScene white =
      Painted("sphere", "lambertian: 1", Even(1.0f), "reference").value();
  const Image paint = TwoHalves();
  const RenderedScene painted =
      Painted("sphere", "lambertian: 1", paint, "reference").value();
  for (size_t k = 0; k < paint.rgb.size(); ++k) {
    EXPECT_NEAR(paint.rgb[k] * white.image.rgb[k], painted.image.rgb[k],
                kRounding * white.image.rgb[k])
        << k;
  }
}

// Paint leaves the gloss as it is: black paint bares it.
TEST_F(KnownPaintTest, GlossStays) {
  const RenderedScene white =
      Painted("sphere", kCoated, Even(1.0f), "reference").value();
  const RenderedScene black =
      Painted("sphere", kCoated, Even(0.0f), "reference").value();
  const RenderedScene half =
      Painted("sphere", kCoated, Even(0.5f), "reference").value();
  const RenderedScene lobe =
      Render("sphere", "cook_torrance: {diffuse: 0, roughness: 0.15}",
             "reference")
          .value();
  double error = 0.0, gloss = 0.0;
  for (size_t k = 0; k < white.image.rgb.size(); ++k) {
    EXPECT_NEAR(0.5 * (white.image.rgb[k] + black.image.rgb[k]),
                half.image.rgb[k], kRounding * white.image.rgb[k]);
    error += std::abs(black.image.rgb[k] - lobe.image.rgb[k]);
    gloss += lobe.image.rgb[k];
  }
  // The lobe's tails far from the mirror's direction count as matte.
  EXPECT_LT(error, 0.1 * gloss);
  EXPECT_EQ(black.mask.CountInside(), white.mask.CountInside());
  ASSERT_EQ(1u, black.warnings.size());
  EXPECT_NE(std::string::npos, black.warnings[0].find("black paint"));
}

double MeanLogDifference(const RenderedScene& a, const RenderedScene& b) {
  double sum = 0.0;
  int count = 0;
  for (size_t k = 0; k < a.image.rgb.size(); ++k) {
    if (a.mask.inside[k / 3] == 0) continue;
    sum += std::abs(std::log(double{a.image.rgb[k]} / b.image.rgb[k]));
    ++count;
  }
  return sum / count;
}

// Paint adds nothing to what a preview of the sphere is off by. The bowl's has
// its tolerances (RenderTolerances), 0.011, and coarser patches, 0.007
// (SceneRadianceOptions), besides.
TEST_F(KnownPaintTest, QualitiesAgree) {
  const auto painted = [&](const char* shape) {
    return MeanLogDifference(
        Painted(shape, kCoated, TwoHalves(), "preview").value(),
        Painted(shape, kCoated, TwoHalves(), "reference").value());
  };
  const double unpainted =
      MeanLogDifference(Render("sphere", kCoated, "preview").value(),
                        Render("sphere", kCoated, "reference").value());
  EXPECT_LT(painted("sphere"), unpainted + RenderTolerances().pixel);
  EXPECT_LT(painted("bowl"), 0.018);
}

// What paint makes of a pixel is what it makes in a solve: the solver renders
// matte and whole by its own quadrature.
TEST_F(KnownPaintTest, PaintIsThatOfASolve) {
  const Image paint = TwoHalves();
  const RenderedScene plain = Render("sphere", kCoated, "preview").value();
  const RenderedScene painted =
      Painted("sphere", kCoated, paint, "preview").value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), kSize, kSize, Mask(), 1)
          .value();
  CookTorrance coated;
  coated.diffuse = {0.6, 0.5, 0.4};
  coated.roughness.setConstant(0.15);
  const TransportOptions options;
  const BrdfGrid grid = BrdfGrid::FromFunction(coated.Function(), options.grid);
  const Image& map = plain.illumination;
  const Transport transport(points, map.height, map.width, options);
  std::vector<double> whole(3 * points.size()), matte(whole.size());
  transport.Render(grid, map.rgb.data(), whole.data());
  transport.Render(MattePart(grid), map.rgb.data(), matte.data());
  double error = 0.0;
  size_t count = 0;
  for (size_t i = 0; i < whole.size(); ++i) {
    const double W = whole[i], M = matte[i];
    const size_t k = size_t{3} * points[i / 3].pixel + i % 3;
    // Near the outline a pixel is more than its centre, which a solve takes.
    if (std::abs(std::log(plain.image.rgb[k] / W)) > 0.005) continue;
    const double expected = (paint.rgb[k] * M + std::max(W - M, 0.0)) / W;
    const double found = painted.image.rgb[k] / plain.image.rgb[k];
    error += std::abs(found - expected);
    ++count;
  }
  EXPECT_GT(count, whole.size() / 2);
  EXPECT_LT(error / static_cast<double>(count), 0.003);
}

// A result holds no albedo where a pixel's centre misses the object.
TEST_F(KnownPaintTest, TheRimTakesItsNeighboursPaint) {
  const RenderedScene centres =
      Painted("sphere", "lambertian: 1", Even(0.5f), "preview").value();
  Image paint = Even(0.5f);
  for (size_t k = 0; k < paint.rgb.size(); ++k) {
    if (centres.mask.inside[k / 3] == 0) paint.rgb[k] = 0.0f;
  }
  const RenderedScene held =
      Painted("sphere", "lambertian: 1", paint, "reference").value();
  EXPECT_GT(held.mask.CountInside(), centres.mask.CountInside());
  const RenderedScene even =
      Painted("sphere", "lambertian: 1", Even(0.5f), "reference").value();
  EXPECT_LT(LargestLogDifference(held, even), kRounding);
  EXPECT_TRUE(held.warnings.empty());
}

TEST_F(KnownPaintTest, WhatIsNoPaintIsRefused) {
  EXPECT_NE(std::string::npos,
            Refusal(Image(kSize, kSize + 1)).find("14x14, found 14x15"));
  Image bad = Even(0.5f);
  bad.At(6, 7)[1] = -0.1f;
  EXPECT_NE(std::string::npos, Refusal(bad).find("found -0.1 at pixel (6, 7)"));
  bad.At(6, 7)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(std::string::npos, Refusal(bad).find("nan at pixel (6, 7)"));
  bad.At(6, 7)[1] = std::numeric_limits<float>::infinity();
  EXPECT_NE(std::string::npos, Refusal(bad).find("inf at pixel (6, 7)"));
  // Nobody sees the corner.
  Image corner = Even(0.5f);
  corner.At(0, 0)[0] = -1.0f;
  EXPECT_TRUE(Painted("sphere", kCoated, corner, "preview").ok());
}

TEST_F(KnownPaintTest, AMissingFileIsNamed) {
  const Status status =
      Render("sphere", std::string(kCoated) + ", albedo: none.exr", "preview")
          .status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("none.exr"));
}

TEST_F(KnownPaintTest, NoPaintWithoutAMattePart) {
  const Status status =
      Painted("sphere", "lambertian: [0.5, 0, 0.5]", Even(0.5f), "preview",
              ", unpainted_albedo: auto")
          .status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos,
            status.message().find("above 0 in every channel"));
}

// The table of a painted object is that of its mean paint.
TEST_F(KnownPaintTest, TheTableIsThatOfTheMeanPaint) {
  const RenderedScene painted =
      Painted("sphere", "lambertian: 0.8", Even(0.25f), "preview").value();
  ASSERT_TRUE(painted.painted_brdf.has_value());
  const Eigen::Array3d f = InterpolateMerl(*painted.painted_brdf, 0.3, 0.4, 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(0.2 / kPi, f[c], 1e-6);
  EXPECT_FALSE(
      Render("sphere", kCoated, "preview").value().painted_brdf.has_value());
}

}  // namespace
}  // namespace ibrdf
