#include "ibrdf/io/problem_file.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST_F(ProblemFile, LeastFileHasTheDocumentedDefaults) {
  const StatusOr<Problem> read = Read(kLeast);
  ASSERT_TRUE(read.ok()) << read.status().message();
  const Problem& p = *read;
  EXPECT_EQ(ProblemKind::kJoint, p.kind);
  EXPECT_EQ(dir_.File("a.exr"), p.image.file);
  EXPECT_EQ("", p.image.mask);
  EXPECT_EQ(CameraType::kOrthographic, p.camera.type);
  EXPECT_EQ(GeometryKind::kSphere, p.geometry.kind);
  EXPECT_EQ("", p.reflectance.model);
  EXPECT_EQ(2, p.reflectance.lobes);
  EXPECT_EQ(0.5, p.reflectance.prior_sigma);
  EXPECT_EQ(128, p.illumination.width);
  EXPECT_EQ(64, p.illumination.height);
  EXPECT_EQ(32, p.illumination.unet_channels);
  EXPECT_EQ(QuadratureLevel::kStandard, p.solver.quadrature);
  EXPECT_EQ(SolverGauge::kGreyLight, p.solver.gauge);
  EXPECT_EQ(SolverSearch::kAuto, p.solver.search);
  EXPECT_FALSE(p.likelihood.scale.has_value());
  EXPECT_EQ(EffectsMode::kAuto, p.effects.mode);
  EXPECT_EQ(120.0, p.solver.seconds);
  EXPECT_EQ(1e-4, p.solver.tolerance);
  EXPECT_EQ(0.0, p.noise);
  EXPECT_FALSE(p.illumination.ambient.has_value());
  EXPECT_TRUE(CheckSolvable(p).ok());
  EXPECT_FALSE(CheckRenderable(p).ok());
}

// A word that stands for a model is no file's name; a path of that name is.
TEST_F(ProblemFile, ModelsThatComeWithTheProgramsHaveNames) {
  const auto model = [&](const std::string& value) {
    return Read(kLeast + ("reflectance: {model: " + value + "}\n"))
        .value()
        .reflectance.model;
  };
  EXPECT_EQ("", model("auto"));
  EXPECT_EQ("default", model("default"));
  EXPECT_EQ("broad", model("broad"));
  EXPECT_EQ(dir_.File("broad"), model("./broad"));
  EXPECT_EQ(dir_.File("broad.ibrdf"), model("broad.ibrdf"));
}

TEST_F(ProblemFile, EveryKeyIsRead) {
  const StatusOr<Problem> read = Read(R"(
problem: reflectance
image: {file: in.exr, mask: sub/../mask.png}
camera: {type: perspective, fov_degrees: 40, from: [0, 1, 5], to: [0, 0, 1], up: [1, 0, 0]}
geometry: {mesh: /abs/bunny.obj, fit: none}
reflectance: {model: m.ibrdf, lobes: 3, prior_sigma: 0.25}
illumination: {known: env.hdr, unet_channels: 16, frame: blender, output_frame: openexr}
likelihood: {scale: 0.02, epsilon: 1e-5}
effects: [visibility, reflectance_map]
solver: {method: lbfgs, quadrature: fine, seconds: 5, tolerance: 0, max_iterations: 7, seed: 9}
truth: {brdf: gt.binary, illumination: gt.exr, frame: cube_cross}
)");
  ASSERT_TRUE(read.ok()) << read.status().message();
  const Problem& p = *read;
  EXPECT_EQ(dir_.File("mask.png"), p.image.mask);
  EXPECT_EQ(40.0, p.camera.fov_degrees);
  EXPECT_EQ(Eigen::Vector3d(0, 1, 5), p.camera.from);
  EXPECT_EQ(Eigen::Vector3d(1, 0, 0), p.camera.up);
  EXPECT_EQ("/abs/bunny.obj", p.geometry.file);
  EXPECT_EQ(MeshFit::kNone, p.geometry.fit);
  EXPECT_EQ(dir_.File("m.ibrdf"), p.reflectance.model);
  EXPECT_EQ(3, p.reflectance.lobes);
  EXPECT_EQ(dir_.File("env.hdr"), p.illumination.known_file);
  EXPECT_EQ(MapFrame::kBlender, p.illumination.frame);
  EXPECT_EQ(MapFrame::kOpenExr, p.illumination.output_frame);
  EXPECT_EQ(MapFrame::kCubeCross, p.truth.frame);
  EXPECT_FALSE(p.illumination.sized);
  EXPECT_EQ(16, p.illumination.unet_channels);
  EXPECT_EQ(0.02, *p.likelihood.scale);
  EXPECT_EQ(1e-5, *p.likelihood.epsilon);
  ASSERT_EQ(2u, p.effects.list.size());
  EXPECT_EQ(Effect::kReflectanceMap, p.effects.list[1]);
  EXPECT_EQ(SolverMethod::kLbfgs, p.solver.method);
  EXPECT_EQ(QuadratureLevel::kFine, p.solver.quadrature);
  EXPECT_EQ(7, p.solver.max_iterations);
  EXPECT_EQ(9, *p.solver.seed);
  EXPECT_EQ(dir_.File("gt.exr"), p.truth.illumination);
  EXPECT_TRUE(CheckSolvable(p).ok());
}

TEST_F(ProblemFile, BuiltInScenesNeedNoFile) {
  const StatusOr<Problem> read = Read(R"(
image: {width: 32, height: 24}
geometry: {sphere: }
reflectance: {known: {cook_torrance: {diffuse: [0.1, 0.2, 0.3], roughness: 0.2}}}
illumination: {width: 256, known: {sky: {sun_theta_degrees: 30, haze: 0}}}
quality: preview
noise: 0.02
)");
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(0.2, read->reflectance.analytic->diffuse[1]);
  EXPECT_EQ(0.2, read->reflectance.analytic->roughness[2]);
  EXPECT_EQ(0.04, read->reflectance.analytic->f0[0]);
  EXPECT_EQ(128, read->illumination.height);
  EXPECT_TRUE(read->illumination.sized);
  EXPECT_EQ(30.0, read->illumination.sky->sun_theta_degrees);
  EXPECT_EQ(60.0, read->illumination.sky->sun_phi_degrees);
  EXPECT_EQ(RenderQuality::kPreview, read->quality);
  EXPECT_EQ(0.02, read->noise);
  EXPECT_TRUE(CheckRenderable(*read).ok());
  EXPECT_FALSE(CheckSolvable(*read).ok());

  const StatusOr<Problem> matte = Read(
      std::string(kLeast) + "reflectance: {known: {lambertian: [1, 0.5, 0]}}");
  ASSERT_TRUE(matte.ok()) << matte.status().message();
  EXPECT_EQ(0.0, matte->reflectance.analytic->specular.maxCoeff());
  EXPECT_EQ(0.5, matte->reflectance.analytic->diffuse[1]);
  EXPECT_FALSE(matte->reflectance.paint.has_value());
}

TEST_F(ProblemFile, OverridesAreCheckedAsTheFileIs) {
  const StatusOr<Problem> read =
      Read(kLeast, {"solver.seconds=7", "image.file=/x/b.exr",
                    "reflectance.lobes=1", "effects=none"});
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(7.0, read->solver.seconds);
  EXPECT_EQ("/x/b.exr", read->image.file);
  EXPECT_EQ(1, read->reflectance.lobes);
  EXPECT_EQ(EffectsMode::kNone, read->effects.mode);
  EXPECT_NE(std::string::npos,
            ErrorOf(kLeast, {"solver.second=7"}).find("solver.seconds"));
  EXPECT_NE(std::string::npos,
            ErrorOf(kLeast, {"solver.seconds=x"}).find("found 'x'"));
}

TEST_F(ProblemFile, MissingAndHugeFilesAreRefused) {
  EXPECT_FALSE(ReadProblem(dir_.File("none.yaml"), {}).ok());
  EXPECT_NE(std::string::npos,
            ErrorOf(std::string((1 << 20) + 1, ' ')).find(path_));
}

TEST_F(ProblemFile, DamagedTextNeverCrashes) {
  const std::string text = std::string(kLeast) +
                           "camera: {type: perspective, from: [0, 1, 5]}\n"
                           "effects: [visibility]\nsolver: {seconds: 5}\n";
  std::mt19937 rng(5);
  const std::string marks = "{}[]:,*&!'\"-#|> \n\t%@0a\x01\xff";
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = text;
    for (unsigned k = 0; k <= rng() % 4; ++k) {
      damaged[rng() % damaged.size()] = marks[rng() % marks.size()];
    }
    const StatusOr<Problem> read = Read(damaged);
    if (!read.ok()) {
      EXPECT_EQ(0u, read.status().message().find(path_)) << damaged;
    }
  }
}

}  // namespace
}  // namespace ibrdf
