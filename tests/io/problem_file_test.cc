#include "ibrdf/io/problem_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/io/problem_json.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr char kLeast[] = "image: {file: a.exr}\ngeometry: {sphere: {}}\n";

class ProblemFile : public ::testing::Test {
 protected:
  StatusOr<Problem> Read(const std::string& text,
                         const std::vector<std::string>& overrides = {}) {
    WriteBytes(path_, text);
    return ReadProblem(path_, overrides);
  }
  std::string ErrorOf(const std::string& text,
                      const std::vector<std::string>& overrides = {}) {
    const StatusOr<Problem> problem = Read(text, overrides);
    if (problem.ok()) return "no error";
    EXPECT_EQ(StatusCode::kInvalidInput, problem.status().code());
    return problem.status().message();
  }

  const TempDir dir_;
  const std::string path_ = dir_.File("joint.yaml");
};

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
  EXPECT_EQ(SolverGauge::kPrior, p.solver.gauge);
  EXPECT_FALSE(p.likelihood.scale.has_value());
  EXPECT_EQ(EffectsMode::kAuto, p.effects.mode);
  EXPECT_EQ(120.0, p.solver.seconds);
  EXPECT_EQ(1e-4, p.solver.tolerance);
  EXPECT_EQ(0.0, p.noise);
  EXPECT_FALSE(p.illumination.ambient.has_value());
  EXPECT_TRUE(CheckSolvable(p).ok());
  EXPECT_FALSE(CheckRenderable(p).ok());
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

TEST_F(ProblemFile, AmbientTermIsAutoOneNumberOrThree) {
  const auto ambient = [&](const std::string& value) {
    const StatusOr<Problem> read =
        Read(kLeast + std::string("illumination: {known: a.exr, ambient: ") +
             value + "}");
    EXPECT_TRUE(read.ok()) << read.status().message();
    return read->illumination.ambient;
  };
  EXPECT_FALSE(ambient("auto").has_value());
  EXPECT_TRUE((*ambient("0") == 0.0).all());
  EXPECT_TRUE((*ambient("[0.5, 0, 2]") == Eigen::Array3d(0.5, 0, 2)).all());
  for (const std::string bad :
       {"-1", "none", "[1, 2]", "[1, 2, -3]", "[1, 2, nan]", "inf", "{}", "[]",
        "[auto, 1, 1]"}) {
    const std::string error =
        ErrorOf(kLeast + std::string("illumination: {known: a.exr, ambient: ") +
                bad + "}");
    EXPECT_NE(std::string::npos, error.find("illumination.ambient")) << error;
  }
  // No light is known that it could be beside.
  EXPECT_NE(std::string::npos,
            ErrorOf(kLeast + std::string("illumination: {ambient: 0.1}"))
                .find("illumination.known"));
}

TEST_F(ProblemFile, FramesOfMapsHaveTheLibrarysWords) {
  const std::string least = kLeast;
  const Problem none = *Read(least);
  EXPECT_FALSE(none.illumination.frame.has_value());
  EXPECT_FALSE(none.truth.frame.has_value());
  EXPECT_EQ(MapFrame::kCamera, none.illumination.output_frame);
  for (const MapFrame frame : kMapFrames) {
    const std::string word = MapFrameName(frame);
    const StatusOr<Problem> read =
        Read(least + "illumination: {known: a.exr, frame: " + word +
             ", output_frame: " + word + "}\ntruth: {illumination: b.exr, " +
             "frame: " + word + "}");
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(frame, read->illumination.frame);
    EXPECT_EQ(frame, read->illumination.output_frame);
    EXPECT_EQ(frame, read->truth.frame);
  }
  EXPECT_FALSE(Read(least + "illumination: {known: a.exr, frame: auto}")
                   ->illumination.frame.has_value());
}

TEST_F(ProblemFile, GaugesAreOfJointProblems) {
  const std::string least = kLeast;
  EXPECT_EQ(SolverGauge::kGreyLight,
            Read(least + "solver: {gauge: grey_light}")->solver.gauge);
  EXPECT_EQ(SolverGauge::kUnitLight,
            Read(least + "solver: {gauge: unit_light}")->solver.gauge);
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

TEST_F(ProblemFile, PaintLiesOverAKnownReflectance) {
  const auto known = [&](const std::string& keys) {
    return Read(
        "image: {width: 8, height: 8}\ngeometry: {sphere: {}}\n"
        "illumination: {known: {sky: {}}}\nreflectance: {known: {" +
        keys + "}}\n");
  };
  const StatusOr<Problem> table = known("brdf: a.binary, albedo: a.exr");
  ASSERT_TRUE(table.ok()) << table.status().message();
  EXPECT_EQ(dir_.File("a.binary"), table->reflectance.known_file);
  EXPECT_EQ(dir_.File("a.exr"), table->reflectance.paint->albedo);
  EXPECT_EQ(1.0, table->reflectance.paint->unpainted_albedo->minCoeff());
  EXPECT_TRUE(CheckRenderable(*table).ok());
  const std::vector<NamedFile> files = NamedFiles(*table);
  EXPECT_TRUE(std::any_of(files.begin(), files.end(), [](const NamedFile& f) {
    return f.key == "reflectance.known.albedo";
  }));
  const StatusOr<Problem> own =
      known("lambertian: 0.5, albedo: a.exr, unpainted_albedo: auto");
  ASSERT_TRUE(own.ok()) << own.status().message();
  EXPECT_FALSE(own->reflectance.paint->unpainted_albedo.has_value());
  EXPECT_EQ(0.25, known("brdf: a.binary, albedo: a.exr, unpainted_albedo: "
                        "[0.5, 0.25, 1]")
                      ->reflectance.paint->unpainted_albedo.value()[1]);
  EXPECT_FALSE(known("brdf: a.binary")->reflectance.paint.has_value());

  // It is for renders.
  const StatusOr<Problem> solved =
      Read(std::string(kLeast) +
           "problem: illumination\nreflectance: {known: "
           "{lambertian: 0.5, albedo: a.exr}}");
  ASSERT_TRUE(solved.ok()) << solved.status().message();
  EXPECT_NE(std::string::npos,
            CheckSolvable(*solved).message().find(
                "reflectance.known.albedo: expected in a render alone"));
}

TEST_F(ProblemFile, MessagesNameFileKeyAndWhatWasExpected) {
  const std::string least = kLeast;
  const struct {
    std::string text, message;
  } cases[] = {
      {least + "reflectance: {lobs: 3}",
       "reflectance.lobs: unknown key; the nearest known one is "
       "reflectance.lobes"},
      {least + "sovler: {}",
       "sovler: unknown key; the nearest known one is "
       "solver"},
      {least + "reflectance: {lobes: 2.5}",
       "reflectance.lobes: expected a whole number in [1, 8], found '2.5'"},
      {least + "reflectance: {lobes: 99}", "[1, 8], found '99'"},
      {least + "reflectance: {prior_sigma: 0}",
       "reflectance.prior_sigma: expected a number > 0, found '0'"},
      {least + "reflectance: {prior_sigma: nan}", "found 'nan'"},
      {least + "reflectance: {prior_sigma: '1'}", "expected a number > 0"},
      {least + "reflectance: [1]",
       "reflectance: expected a map of model, lobes, prior_sigma, variation, "
       "labels or known, found a list of 1"},
      {least + "reflectance: {labels: l.png, variation: none}",
       "reflectance.labels: expected without variation: none"},
      {least + "reflectance: {labels: l.png, variation: albedo}",
       "reflectance.labels: expected without variation: albedo"},
      {least + "reflectance: {labels: l.png, known: {lambertian: 0.5}}",
       "reflectance.labels: expected without reflectance.known"},
      {least + "reflectance: {labels: l.png}\nsolver: {estimator: maximum}",
       "reflectance.labels: expected without solver.estimator: maximum"},
      {least + "solver: {method: newton}",
       "solver.method: expected auto, alternating, gauss_newton, lbfgs, adam "
       "or trust_region, found 'newton'"},
      {least + "solver: {seconds: 1e400}", "solver.seconds: expected"},
      {least + "likelihood: {scale: many}", "likelihood.scale: expected"},
      {least + "likelihood: {scale: []}", "expected auto or a number"},
      {least + "effects: [visibilty]", "the nearest known one is visibility"},
      {least + "effects: [visibility, visibility]", "listed twice"},
      {least + "effects: [gausians]", "the nearest known one is gaussians"},
      {least + "effects: harmonic", "the nearest known one is harmonics"},
      {least + "effects: [harmonics, visibility]",
       "effects: expected harmonics or visibility, found both"},
      {least + "effects: [interreflection, gaussians]",
       "effects: expected gaussians or interreflection, found both"},
      {least + "camera: {fov_degrees: 3}", "camera.fov_degrees: expected"},
      {least + "camera: {type: perspective, fov_degrees: 180}",
       "camera.fov_degrees: expected a number in (0, 180), found '180'"},
      {least + "camera: {type: perspective, from: [0, 0, 0]}",
       "camera: expected `from` apart"},
      {least + "camera: {type: perspective, from: [0, 0]}",
       "camera.from: expected a list of three"},
      {least + "illumination: {width: 63}", "expected an even number"},
      {least + "illumination: {frame: camera}",
       "illumination.frame: expected with illumination.known only"},
      {least + "illumination: {known: {sky: {}}, frame: camera}",
       "illumination.frame: expected with the file of a known map only"},
      {least + "illumination: {known: a.exr, frame: maya}",
       "illumination.frame: expected auto, camera, openexr, mitsuba, "},
      {least + "illumination: {output_frame: auto}",
       "illumination.output_frame: expected camera, openexr, "},
      {least + "truth: {frame: camera}",
       "truth.frame: expected with truth.illumination only"},
      {least + "illumination: {unet_channels: 0}",
       "illumination.unet_channels: expected a whole number in [1, 128], "
       "found '0'"},
      {least + "illumination: {prior: process, unet_channels: 8}",
       "illumination.unet_channels: expected with illumination.prior: unet"},
      {least + "illumination: {prior: auto, unet_channels: 0}",
       "illumination.unet_channels: expected a whole number in [1, 128], "
       "found '0'"},
      {least + "solver: {quadrature: finest}",
       "solver.quadrature: expected coarse, standard or fine, found 'finest'"},
      {least + "solver: {gauge: grey}",
       "solver.gauge: expected prior, grey_light or unit_light, found 'grey'"},
      {least + "problem: reflectance\nsolver: {gauge: prior}",
       "solver.gauge: expected with problem: joint only"},
      {least + "illumination: {known: {sun: {}}}",
       "illumination.known.sun: unknown key"},
      {least + "illumination: {known: {sky: {cloud: 1}}}",
       "illumination.known.sky.cloud: unknown key; the nearest known one is "
       "illumination.known.sky.clouds"},
      {least + "reflectance: {known: {albedo: a.exr}}",
       "reflectance.known: expected a file or one of brdf, lambertian, "
       "cook_torrance and principled"},
      {least + "reflectance: {known: {brdf: a.binary, lambertian: 1}}",
       "reflectance.known: expected a file or one of brdf, lambertian, "
       "cook_torrance and principled"},
      {least + "reflectance: {known: {lambertian: 1, unpainted_albedo: 1}}",
       "reflectance.known.unpainted_albedo: expected with "
       "reflectance.known.albedo only"},
      {least + "reflectance: {known: {lambertian: 1, albedo: a.exr, "
               "unpainted_albedo: 0}}",
       "reflectance.known.unpainted_albedo: expected"},
      {least + "reflectance: {known: {lambertian: 1, albedo: [1]}}",
       "reflectance.known.albedo: expected"},
      {least + "reflectance: {known: {lambertian: [1, 2, 0]}}",
       "reflectance.known.lambertian: expected a number in [0, 1] or a list"},
      {least + "reflectance: {known: [a]}",
       "reflectance.known: expected the name of a file, found a list of 1"},
      {least + "truth: {brdf: }", "truth.brdf: expected the name of a file"},
      {"geometry: {sphere: {}}", "image: expected this key, found nothing"},
      {"image: {file: a.exr}", "geometry: expected this key, found nothing"},
      {"image: {file: a, width: 3, height: 3}\ngeometry: {sphere: {}}",
       "image: expected either file or width and height"},
      {"image: {width: 3}\ngeometry: {sphere: {}}", "both width and height"},
      {"image: {file: a}\ngeometry: {sphere: {}, mesh: b.obj}",
       "geometry: expected one of sphere, mesh, normals and depth, found 2"},
      {"image: {file: a}\ngeometry: {sphere: {}, fit: none}",
       "geometry.fit: expected with geometry.mesh only"},
      {"image: {file: a}\ngeometry: {sphere: {radius: 2}}",
       "geometry.sphere: expected both centre and radius, or {}"},
      {"image: {file: a}\ngeometry: {sphere: yes}",
       "geometry.sphere: expected a map of centre or radius, found 'yes'"},
      {"image: {file: a}\ngeometry: {sphere: {centre: 3, radius: 2}}",
       "geometry.sphere.centre: expected a list of two, each a number in "},
      {"image: {file: a}\ngeometry: {sphere: {centre: [1, .inf], radius: 2}}",
       "geometry.sphere.centre: expected a list of two"},
      {"image: {file: a}\ngeometry: {sphere: {centre: [1, 2], radius: 0}}",
       "geometry.sphere.radius: expected a number in (0, 1e+06], found '0'"},
      {"image: {file: a}\ngeometry: {sphere: {centre: [1, 2], radius: 1}}\n"
       "camera: {type: perspective}",
       "geometry.sphere: expected {} with camera.type: perspective"},
      {"image: {file: a}\ngeometry: {normals: n.exr}\ncamera: {type: "
       "perspective, from: [0, 0, 4]}",
       "camera.from: expected without geometry.normals, which is in the "},
      {"image: {file: a}\ngeometry: {depth: n.exr}\ncamera: {type: "
       "perspective, up: [0, 1, 0]}",
       "camera.up: expected without geometry.depth"},
      {"image: {file: a}\ngeometry: {normals: n.exr, frame: maya}",
       "geometry.frame: expected opengl or opencv, found 'maya'"},
      {"image: {file: a}\ngeometry: {normals: n.exr, frame: [x]}",
       "geometry.frame: expected opengl or opencv, found a list of 1"},
      {"image: {file: a}\ngeometry: {normals: n.exr, frame: {x: north}}",
       "geometry.frame.x: expected right, left, up, down, toward or away, "
       "found 'north'"},
      {"image: {file: a}\ngeometry: {normals: n.exr, frame: {y: left}}",
       "geometry.frame.y: expected another axis of the picture than that of "
       "x"},
      {"image: {file: a}\ngeometry: {normals: n.exr, frame: {w: left}}",
       "geometry.frame.w: unknown key"},
      {"image: {file: a}\ngeometry: {depth: d.png, depth_scale: 0}",
       "geometry.depth_scale: expected a number other than 0, found '0'"},
      {"image: {file: a}\ngeometry: {depth: d.png, depth_scale: far}",
       "geometry.depth_scale: expected"},
      {"image: {file: a}\ngeometry: {normals: d.png, depth_scale: 2}",
       "geometry.depth_scale: expected with geometry.depth only"},
      {"image: {file: a}\ngeometry: {depth: d.png, depth_scale: -1}\n"
       "camera: {type: perspective}",
       "geometry.depth_scale: expected a number > 0 with camera.type"},
      {"", "image: expected this key, found nothing"},
      {"just words", "expected a map of problem, image"},
  };
  for (const auto& c : cases) {
    const std::string message = ErrorOf(c.text);
    EXPECT_EQ(0u, message.find(path_ + ": ")) << message;
    EXPECT_NE(std::string::npos, message.find(c.message)) << c.text << "\n"
                                                          << message;
  }
}

TEST_F(ProblemFile, LabelsNeedNoWordOfTheVariation) {
  for (const std::string variation :
       {"", ", variation: auto", ", variation: labels"}) {
    const StatusOr<Problem> problem =
        Read(kLeast + ("reflectance: {labels: l.png" + variation) + "}");
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    EXPECT_EQ(ReflectanceVariation::kLabels, problem->reflectance.variation);
    EXPECT_EQ(dir_.File("l.png"), problem->reflectance.labels);
  }
  const StatusOr<Problem> without =
      Read(kLeast + std::string("reflectance: {variation: labels}"));
  ASSERT_TRUE(without.ok());
  EXPECT_EQ(path_ +
                ": reflectance.labels: expected this key with variation: "
                "labels, found nothing",
            CheckSolvable(*without).message());
}

TEST_F(ProblemFile, EveryMethodIsReadByItsName) {
  for (int m = 0; m < kNumSolverMethods; ++m) {
    const auto method = static_cast<SolverMethod>(m);
    const std::string name = SolverMethodName(method);
    const StatusOr<Problem> p = Read(kLeast, {"solver.method=" + name});
    ASSERT_TRUE(p.ok()) << p.status().message();
    EXPECT_EQ(method, p->solver.method);
    EXPECT_EQ(name, ProblemToJson(*p)["solver"]["method"]);
  }
  EXPECT_EQ(SolverMethod::kTrustRegion,
            Read(kLeast, {"solver.method=trust_region"})->solver.method);
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

TEST_F(ProblemFile, EffectsOfRendersAreNoneOfSolves) {
  for (const std::string effect : {"harmonics", "gaussians"}) {
    const StatusOr<Problem> read = Read(kLeast, {"effects=[" + effect + "]"});
    ASSERT_TRUE(read.ok()) << read.status().message();
    const Status s = CheckSolvable(*read);
    EXPECT_EQ(StatusCode::kInvalidInput, s.code());
    EXPECT_NE(std::string::npos, s.message().find("effects: " + effect));
  }
  EXPECT_TRUE(CheckSolvable(*Read(kLeast, {"effects=[visibility]"})).ok());
  // What no program simulates.
  for (const std::string effect : {"sharp_lobes", "perspective"}) {
    EXPECT_NE(std::string::npos,
              ErrorOf(kLeast, {"effects=[" + effect + "]"}).find(effect));
  }
}

TEST_F(ProblemFile, ThePriorOfTheLightIsChosen) {
  const auto prior = [&](const std::string& rest) {
    return Read(std::string(kLeast) + rest).value().illumination.prior;
  };
  EXPECT_EQ(IlluminationPrior::kProcess, prior(""));
  EXPECT_EQ(IlluminationPrior::kProcess, prior("illumination: {width: 256}"));
  EXPECT_EQ(IlluminationPrior::kProcess,
            prior("illumination: {prior: process}\n"
                  "solver: {estimator: maximum}"));
  EXPECT_EQ(IlluminationPrior::kUNet, prior("illumination: {width: 258}"));
  EXPECT_EQ(IlluminationPrior::kUNet,
            prior("illumination: {prior: auto, unet_channels: 8}"));
  EXPECT_EQ(IlluminationPrior::kUNet, prior("solver: {estimator: maximum}"));
  EXPECT_EQ(IlluminationPrior::kNone,
            prior("illumination: {prior: none}\nsolver: {estimator: maximum}"));
}

TEST_F(ProblemFile, MapsOfTheProcessAreSmall) {
  const auto check = [&](const std::string& illumination) {
    return CheckSolvable(*Read(kLeast, {"illumination=" + illumination}));
  };
  EXPECT_TRUE(check("{width: 256, prior: process}").ok());
  EXPECT_TRUE(check("{width: 512}").ok());
  const Status s = check("{width: 512, prior: process}");
  EXPECT_EQ(StatusCode::kInvalidInput, s.code());
  EXPECT_NE(std::string::npos, s.message().find("illumination.width"));
  EXPECT_NE(std::string::npos, check("{width: 64, height: 512, prior: process}")
                                   .message()
                                   .find("illumination.height"));
}

TEST_F(ProblemFile, KnownPartsMustFitTheKind) {
  const struct {
    const char* kind;
    bool brdf, light, ok;
  } cases[] = {
      {"joint", false, false, true},
      {"joint", true, false, false},
      {"joint", false, true, false},
      {"reflectance", false, true, true},
      {"reflectance", false, false, false},
      {"illumination", true, false, true},
      {"illumination", false, false, false},
  };
  for (const auto& c : cases) {
    std::vector<std::string> overrides = {std::string("problem=") + c.kind};
    if (c.brdf) overrides.emplace_back("reflectance.known=a.binary");
    if (c.light) overrides.emplace_back("illumination.known=a.exr");
    const StatusOr<Problem> read = Read(kLeast, overrides);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(c.ok, CheckSolvable(*read).ok()) << c.kind;
  }
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

TEST_F(ProblemFile, JsonHasTheKeysOfTheFileAndReadsBack) {
  const StatusOr<Problem> read = Read(
      kLeast, {"camera={type: perspective, fov_degrees: 40}",
               "effects=[reflectance_map, harmonics, gaussians]",
               "solver.seed=4", "likelihood.scale=0.1", "truth.brdf=b.binary",
               "geometry={mesh: m.obj, fit: none}"});
  ASSERT_TRUE(read.ok()) << read.status().message();
  const nlohmann::json json = ProblemToJson(*read);
  EXPECT_EQ("joint", json["problem"]);
  EXPECT_EQ(0.1, json["likelihood"]["scale"]);
  EXPECT_EQ("auto", json["likelihood"]["epsilon"]);
  EXPECT_EQ(nlohmann::json({"reflectance_map", "harmonics", "gaussians"}),
            json["effects"]);
  EXPECT_EQ(dir_.File("b.binary"), json["truth"]["brdf"]);
  // JSON is YAML: the resolved problem is a problem file.
  const StatusOr<Problem> again = Read(json.dump(2));
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));
}

TEST_F(ProblemFile, JsonOfABuiltInSceneReadsBack) {
  const StatusOr<Problem> read = Read(
      "image: {width: 8, height: 8}\ngeometry: {sphere: {}}\n"
      "reflectance: {known: {cook_torrance: {}}}\n"
      "illumination: {known: {sky: {clouds: 0.25}}}\n");
  ASSERT_TRUE(read.ok()) << read.status().message();
  const nlohmann::json json = ProblemToJson(*read);
  EXPECT_EQ(0.25, json["illumination"]["known"]["sky"]["clouds"]);
  const StatusOr<Problem> again = Read(json.dump());
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(json, ProblemToJson(*again));
}

TEST_F(ProblemFile, SettingsAreTheLeavesByTheNamesThatSetTakes) {
  const StatusOr<Problem> read =
      Read(kLeast, {"effects=[visibility, interreflection]",
                    "geometry={mesh: m.obj}", "solver.seconds=30"});
  ASSERT_TRUE(read.ok()) << read.status().message();
  std::map<std::string, std::string> settings;
  for (const ProblemSetting& setting : ListSettings(*read)) {
    settings[setting.key] = setting.value;
  }
  EXPECT_EQ("joint", settings["problem"]);
  EXPECT_EQ("30.0", settings["solver.seconds"]);
  EXPECT_EQ("auto", settings["likelihood.scale"]);
  EXPECT_EQ(dir_.File("m.obj"), settings["geometry.mesh"]);
  EXPECT_EQ("[\"visibility\",\"interreflection\"]", settings["effects"]);
  EXPECT_EQ(0u, settings.count("geometry"));
}

// Of a text that is refused.
std::string ParseError(const std::string& text) {
  return ParseProblem("p.yaml", text, {}).status().message();
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
  const std::string least =
      "image: {width: 8, height: 8}\ngeometry: {mesh: m.obj}\n";
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
  const std::string normals =
      "image: {width: 8, height: 8}\ngeometry: {normals: n.exr}\n";
  const std::string sphere =
      "image: {width: 8, height: 8}\ngeometry: {sphere: {centre: [4, 4], "
      "radius: 3}}\n";
  const struct {
    std::string text, error;
  } cases[] = {
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
       "views[0]: expected a map of name, camera, file or mask"},
      {least + "views: [{camera: {}}]", "views[0].name: expected the view's"},
      {least + "views: [{name: a/b}]",
       "views[0].name: expected a name that a file may have"},
      {least + "views: [{name: a}, {name: a}]",
       "views[1].name: expected a name that no other view has"},
      {least + "views: [{name: a, files: b}]", "views[0].files: unknown key"},
      {least + "views: [{name: a, file: b}]",
       "views[0].file: expected with problem: textures only"},
      {least + "views: [{name: a, mask: b}]",
       "views[0].mask: expected with problem: textures only"},
      {least + "views: {colmap: c, images: d}",
       "views.images: expected with problem: textures only"},
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
  for (const auto& c : cases) {
    EXPECT_EQ(0u, ParseError(c.text).find("p.yaml: " + c.error))
        << ParseError(c.text);
  }
}

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
      {"problem=joint", "image: expected this key"},
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

TEST(ProblemText, SolvesTakeOneView) {
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
  for (const std::string views :
       {"[{name: a}, {name: b}]", "{colmap: c}", "{transforms: t.json}"}) {
    EXPECT_EQ(
        "p.yaml: views: expected one view: a solve of several is not "
        "there yet",
        CheckSolvable(
            ParseProblem("p.yaml", least + "views: " + views, {}).value())
            .message());
  }
}

}  // namespace
}  // namespace ibrdf
