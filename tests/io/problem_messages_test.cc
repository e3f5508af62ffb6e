// The messages of problem files that are refused.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

using Refusals = std::vector<Refusal>;

Refusals FileRefusals() {
  const std::string least = kLeast;
  return {
      {least + "sovler: {}",
       "sovler: unknown key; the nearest known one is "
       "solver"},
      {"geometry: {sphere: {}}", "image: expected this key, found nothing"},
      {"image: {file: a.exr}", "geometry: expected this key, found nothing"},
      {"image: {file: a, width: 3, height: 3}\ngeometry: {sphere: {}}",
       "image: expected either file or width and height"},
      {"image: {width: 3}\ngeometry: {sphere: {}}", "both width and height"},
      {"", "image: expected this key, found nothing"},
      {"just words", "expected a map of problem, image"}};
}

Refusals CameraRefusals() {
  const std::string least = kLeast;
  return {{least + "camera: {fov_degrees: 3}", "camera.fov_degrees: expected"},
          {least + "camera: {type: perspective, fov_degrees: 180}",
           "camera.fov_degrees: expected a number in (0, 180), found '180'"},
          {least + "camera: {type: perspective, from: [0, 0, 0]}",
           "camera: expected `from` apart"},
          {least + "camera: {type: perspective, from: [0, 0]}",
           "camera.from: expected a list of three"}};
}

Refusals SphereRefusals() {
  return {
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
       "geometry.sphere: expected {} with camera.type: perspective"}};
}

Refusals NormalMapRefusals() {
  return {
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
       "geometry.depth_scale: expected a number > 0 with camera.type"}};
}

Refusals ReflectanceRefusals() {
  const std::string least = kLeast;
  return {
      {least + "reflectance: {lobs: 3}",
       "reflectance.lobs: unknown key; the nearest known one is "
       "reflectance.lobes"},
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
       "reflectance.labels: expected without solver.estimator: maximum"}};
}

Refusals KnownReflectanceRefusals() {
  const std::string least = kLeast;
  return {
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
       "reflectance.known: expected the name of a file, found a list of 1"}};
}

Refusals IlluminationRefusals() {
  const std::string least = kLeast;
  return {
      {least + "illumination: {width: 63}", "expected an even number"},
      {least + "illumination: {frame: camera}",
       "illumination.frame: expected with illumination.known only"},
      {least + "illumination: {known: {sky: {}}, frame: camera}",
       "illumination.frame: expected with the file of a known map only"},
      {least + "illumination: {known: a.exr, frame: maya}",
       "illumination.frame: expected auto, camera, openexr, mitsuba, "},
      {least + "illumination: {output_frame: auto}",
       "illumination.output_frame: expected camera, openexr, "},
      {least + "illumination: {unet_channels: 0}",
       "illumination.unet_channels: expected a whole number in [1, 128], "
       "found '0'"},
      {least + "illumination: {prior: process, unet_channels: 8}",
       "illumination.unet_channels: expected with illumination.prior: unet"},
      {least + "illumination: {prior: auto, unet_channels: 0}",
       "illumination.unet_channels: expected a whole number in [1, 128], "
       "found '0'"},
      {least + "illumination: {known: {sun: {}}}",
       "illumination.known.sun: unknown key"},
      {least + "illumination: {known: {sky: {cloud: 1}}}",
       "illumination.known.sky.cloud: unknown key; the nearest known one is "
       "illumination.known.sky.clouds"}};
}

Refusals SolverRefusals() {
  const std::string least = kLeast;
  return {
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
      {least + "solver: {quadrature: finest}",
       "solver.quadrature: expected coarse, standard or fine, found 'finest'"},
      {least + "solver: {search: long}",
       "solver.search: expected auto, standard or thorough, found 'long'"},
      {least + "problem: reflectance\nsolver: {search: thorough}",
       "solver.search: expected with problem: joint only"},
      {least + "solver: {gauge: grey}",
       "solver.gauge: expected prior, grey_light or unit_light, found 'grey'"},
      {least + "problem: reflectance\nsolver: {gauge: prior}",
       "solver.gauge: expected with problem: joint only"}};
}

Refusals TruthRefusals() {
  const std::string least = kLeast;
  return {
      {least + "truth: {frame: camera}",
       "truth.frame: expected with truth.illumination only"},
      {least + "truth: {brdf: }", "truth.brdf: expected the name of a file"}};
}

TEST_F(ProblemFile, MessagesNameFileKeyAndWhatWasExpected) {
  for (const Refusals& section :
       {FileRefusals(), CameraRefusals(), SphereRefusals(), NormalMapRefusals(),
        ReflectanceRefusals(), KnownReflectanceRefusals(),
        IlluminationRefusals(), SolverRefusals(), TruthRefusals()}) {
    for (const Refusal& c : section) {
      const std::string message = ErrorOf(c.text);
      EXPECT_EQ(0u, message.find(path_ + ": ")) << message;
      EXPECT_NE(std::string::npos, message.find(c.error)) << c.text << "\n"
                                                          << message;
    }
  }
}

}  // namespace
}  // namespace ibrdf
