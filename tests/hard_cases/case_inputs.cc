#include "tests/hard_cases/case_inputs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "tests/hard_cases/case_exr.h"
#include "tests/hard_cases/case_photographs.h"
#include "tests/hard_cases/recipe_value.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

Status Unknown(const std::string& what, const YAML::Node& node) {
  return InvalidInput("recipe", what + ": " + YAML::Dump(node));
}

float Value(const YAML::Node& node) {
  const std::string s = node.as<std::string>();
  if (s == "nan") return std::numeric_limits<float>::quiet_NaN();
  if (s == "inf") return std::numeric_limits<float>::infinity();
  if (s == "-inf") return -std::numeric_limits<float>::infinity();
  if (s == "denormal") return std::numeric_limits<float>::denorm_min();
  return static_cast<float>(node.as<double>());
}

Status Edit(const YAML::Node& edit, Image* image) {
  const int channel = Get(edit, "channel", -1);
  const int every = Get(edit, "every", 1);
  int first_row = 0, end_row = image->height;
  if (edit["rows"]) {
    first_row = edit["rows"][0].as<int>();
    end_row = edit["rows"][1].as<int>();
    if (first_row < 0 || end_row > image->height) return Unknown("rows", edit);
  }
  for (int y = first_row; y < end_row; ++y) {
    for (int x = 0; x < image->width; ++x) {
      if ((y * image->width + x) % every != 0) continue;
      if (edit["pixel"] && (x != edit["pixel"][0].as<int>() ||
                            y != edit["pixel"][1].as<int>())) {
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        if (channel >= 0 && c != channel) continue;
        float& v = image->At(x, y)[c];
        if (edit["set"]) {
          v = Value(edit["set"]);
        } else if (edit["scale"]) {
          v *= Value(edit["scale"]);
        } else if (edit["add"]) {
          v += Value(edit["add"]);
        } else if (edit["clip"]) {
          v = std::min(v, Value(edit["clip"]));
        } else {
          return Unknown("edit", edit);
        }
      }
    }
  }
  return OkStatus();
}

// constant; sky: bright above, brown below; sun: a sky with one texel of
// `radiance`; black; blue: one channel; stripes of `low` and `high`.
Status MakeLight(const YAML::Node& light, Image* map) {
  const std::string kind = light["kind"].as<std::string>();
  for (int y = 0; y < map->height; ++y) {
    for (int x = 0; x < map->width; ++x) {
      float* const L = map->At(x, y);
      const float up =
          static_cast<float>(std::cos(kPi * (y + 0.5) / map->height));
      const float around =
          static_cast<float>(std::sin(2 * kPi * (x + 0.5) / map->width));
      for (int c = 0; c < 3; ++c) {
        if (kind == "constant") {
          L[c] = 1.0f;
        } else if (kind == "black") {
          L[c] = 0.0f;
        } else if (kind == "blue") {
          L[c] = c == 2 ? std::exp(up) : 0.0f;
        } else if (kind == "stripes") {
          L[c] = Value(light[x / 2 % 2 == 0 ? "low" : "high"]);
        } else if (kind == "sky" || kind == "sun") {
          const float tint = up > 0 ? 0.1f * c : -0.1f * c;
          L[c] = std::exp(up + tint + 0.5f * around);
          if (kind == "sun" && x == map->width / 8 && y == map->height / 4) {
            L[c] = Value(light["radiance"]);
          }
        } else {
          return Unknown("light", light);
        }
      }
    }
  }
  return OkStatus();
}

Status MakeNormals(const std::string& kind, Image* normals) {
  for (int y = 0; y < normals->height; ++y) {
    for (int x = 0; x < normals->width; ++x) {
      const float u = 2 * (x + 0.5f) / normals->width - 1;
      const float v = 1 - 2 * (y + 0.5f) / normals->height;
      const float square = u * u + v * v;
      float* const n = normals->At(x, y);
      std::fill_n(n, 3, 0.0f);
      if (kind == "zero" || square >= 1) continue;
      n[0] = u;
      n[1] = v;
      n[2] = std::sqrt(1 - square);
      if (kind == "facing") {
        n[0] = n[1] = 0;
        n[2] = 1;
      } else if (kind == "away") {
        n[2] = -n[2];
      } else if (kind == "long") {
        for (int c = 0; c < 3; ++c) n[c] *= 1e20f;
      } else if (kind == "grazing") {
        const float length = std::sqrt(square);
        if (length > 0) {
          n[0] = u / length;
          n[1] = v / length;
        }
        n[2] = 1e-4f;
      } else if (kind != "sphere") {
        return InvalidInput("recipe", "normals: " + kind);
      }
    }
  }
  return OkStatus();
}

// Normals of the unit sphere 3 before the camera of a vertical angle of 40
// degrees.
void MakePerspectiveNormals(Image* normals) {
  const double half = std::tan(20 * kPi / 180), distance = 3;
  for (int y = 0; y < normals->height; ++y) {
    for (int x = 0; x < normals->width; ++x) {
      const double side = 2 * half / normals->height;
      const Eigen::Vector3d d =
          Eigen::Vector3d((x + 0.5 - 0.5 * normals->width) * side,
                          (0.5 * normals->height - y - 0.5) * side, -1)
              .normalized();
      const double along = -distance * d.z();
      const double rest = along * along - distance * distance + 1;
      if (rest <= 0) continue;
      const Eigen::Vector3d n =
          Eigen::Vector3d(0, 0, distance) + (along - std::sqrt(rest)) * d;
      Eigen::Map<Eigen::Vector3f>(normals->At(x, y)) = n.cast<float>();
    }
  }
}

// In pixels, of the sphere that fills the image; 0 outside.
Status MakeDepth(const std::string& kind, Image* depth) {
  if (kind != "sphere" && kind != "flat") {
    return InvalidInput("recipe", "depth: " + kind);
  }
  const double radius = 0.5 * std::min(depth->width, depth->height);
  for (int y = 0; y < depth->height; ++y) {
    for (int x = 0; x < depth->width; ++x) {
      const double u = x + 0.5 - 0.5 * depth->width;
      const double v = y + 0.5 - 0.5 * depth->height;
      const double rest = radius * radius - u * u - v * v;
      if (rest <= 0) continue;
      const double value = kind == "flat" ? 7 : 2 * radius - std::sqrt(rest);
      std::fill_n(depth->At(x, y), 3, static_cast<float>(value));
    }
  }
  return OkStatus();
}

// pixel: the middle one; corner: one that sees no object.
Status WriteMask(const YAML::Node& recipe, int width, int height,
                 const std::string& path) {
  const std::string kind = recipe["mask"].as<std::string>();
  const std::vector<double> centre =
      Get(recipe, "centre", std::vector<double>{0.5 * width, 0.5 * height});
  const std::vector<double> radii =
      Get(recipe, "radii", std::vector<double>{0.5 * width, 0.5 * height});
  Rgb8Image mask(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5 - centre[0]) / radii[0],
                   v = (y + 0.5 - centre[1]) / radii[1];
      bool on = false;
      if (kind == "disc") {
        on = u * u + v * v < 1;
      } else if (kind == "all") {
        on = true;
      } else if (kind == "pixel") {
        on = x == width / 2 && y == height / 2;
      } else if (kind == "corner") {
        on = x == 0 && y == 0;
      } else if (kind != "none") {
        return InvalidInput("recipe", "mask: " + kind);
      }
      std::fill_n(&mask.rgb[3 * (static_cast<size_t>(y) * width + x)], 3,
                  static_cast<uint8_t>(on ? 255 : 0));
    }
  }
  return WritePng(mask, path);
}

// diffuse: albedo; specular: raw units of the peak; degrees: standard deviation
// of its slopes; red, green, blue: factors.
Status MakeBrdf(const YAML::Node& brdf, const std::string& path) {
  const double diffuse = Get(brdf, "diffuse", 0.0);
  const double peak = Get(brdf, "specular", 0.0);
  const double width = Get(brdf, "degrees", 5.0) * kPi / 180;
  const double colour[3] = {Get(brdf, "red", 1.0), Get(brdf, "green", 1.0),
                            Get(brdf, "blue", 1.0)};
  const BrdfFunction f = [=](double theta_h, double, double) {
    const double slope = std::tan(std::min(theta_h, 1.5)) / width;
    const double lobe = std::exp(-0.5 * slope * slope);
    Eigen::Array3d out;
    for (int c = 0; c < 3; ++c) {
      out[c] = colour[c] * (diffuse / kPi + peak * lobe * kMerlScale[c]);
    }
    return out;
  };
  return WriteMerl(SampleMerl(f), path);
}

// By the extension. gltf: {pointer: value}: of a .glb, changes of its JSON.
Status WriteMesh(const YAML::Node& recipe, const MeshSpec& mesh,
                 const std::string& path) {
  const std::string format = FileExtension(path);
  if (format == "glb") {
    std::string buffer;
    nlohmann::json json = GltfJsonOf(mesh, &buffer);
    for (const auto& entry : recipe["gltf"]) {
      json[nlohmann::json::json_pointer(entry.first.as<std::string>())] =
          nlohmann::json::parse(entry.second.as<std::string>());
    }
    WriteBytes(path, GlbOf(json.dump(), buffer));
  } else if (format == "stl") {
    const bool text = Get(recipe, "stl_text", false);
    WriteBytes(path, text ? StlText(mesh) : StlBytes(mesh));
  } else {
    WriteBytes(path, format == "ply" ? PlyBytes(mesh) : ObjBytes(mesh));
  }
  return OkStatus();
}

// rings: of latitude. radius, centre: [x, y, z]; flip: turns triangles over;
// flip_half: every other one; hole: leaves out the triangles with a vertex
// beyond this height, or hole_towards: z; spike: adds triangles without area.
Status MakeSphereMesh(const YAML::Node& recipe, const std::string& path) {
  const int rings = recipe["sphere_mesh"].as<int>();
  const double radius = Get(recipe, "radius", 1.0);
  const std::vector<double> centre =
      Get(recipe, "centre", std::vector<double>{0.0, 0.0, 0.0});
  const double hole = Get(recipe, "hole", 2.0);
  const bool hole_towards_z =
      Get(recipe, "hole_towards", std::string("y")) == "z";
  const bool flip = Get(recipe, "flip", false);
  const bool flip_half = Get(recipe, "flip_half", false);
  MeshSpec mesh;
  const int columns = 2 * rings;
  std::vector<double> height;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k < columns; ++k) {
      const double theta = kPi * i / rings, phi = 2 * kPi * k / columns;
      const double x = std::sin(theta) * std::sin(phi), y = std::cos(theta),
                   z = std::sin(theta) * std::cos(phi);
      mesh.vertices.emplace_back(centre[0] + radius * x, centre[1] + radius * y,
                                 centre[2] + radius * z);
      height.push_back(hole_towards_z ? z : y);
    }
  }
  int count = 0;
  const auto face = [&](int a, int b, int c) {
    if (std::max({height[a], height[b], height[c]}) > hole) return;
    if (flip != (flip_half && count++ % 2 == 0)) std::swap(b, c);
    mesh.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < columns; ++k) {
      const int next = (k + 1) % columns;
      const int a = i * columns + k, b = (i + 1) * columns + k,
                c = (i + 1) * columns + next, d = i * columns + next;
      face(a, b, c);
      face(a, c, d);
      if (Get(recipe, "spike", false)) face(a, a, c);
    }
  }
  return WriteMesh(recipe, mesh, path);
}

Status WriteModelOf(const YAML::Node& recipe, const std::string& path) {
  NeuralBrdfModel model =
      TinyModel(recipe["model"].as<int>(), 1,
                static_cast<float>(Get(recipe, "curvature", 4.0)));
  if (recipe["code_norm"]) {
    const float norm = Value(recipe["code_norm"]);
    const size_t size = model.shape.code_size();
    for (size_t i = 0; i < model.codes.size(); i += size) {
      float square = 0.0f;
      for (size_t k = 0; k < size; ++k) {
        square += model.codes[i + k] * model.codes[i + k];
      }
      for (size_t k = 0; k < size; ++k) {
        model.codes[i + k] *= norm / std::sqrt(square);
      }
    }
  }
  if (const YAML::Node colour = recipe["log_colour"]) {
    for (size_t i = 0; i < model.log_colours.size(); ++i) {
      model.log_colours[i] =
          Value(colour.IsSequence() ? colour[i % 3] : colour);
    }
  }
  return WriteModel(model, path);
}

Status RenderInput(const YAML::Node& scene, const std::string& folder,
                   Image* image) {
  YAML::Node full = YAML::Clone(scene);
  full["quality"] = "preview";
  const std::string path = folder + "/scene.yaml";
  WriteBytes(path, YAML::Dump(full) + "\n");
  const StatusOr<Problem> problem = ReadProblem(path, {});
  if (!problem.ok()) return problem.status();
  IBRDF_RETURN_IF_ERROR(CheckRenderable(*problem));
  RenderSceneOptions options;
  options.num_threads = 1;
  const StatusOr<RenderedScene> rendered = RenderScene(*problem, options);
  if (!rendered.ok()) return rendered.status();
  *image = rendered->image;
  return OkStatus();
}

// Two digits a byte, in groups as one likes.
std::string BytesOfHex(const std::string& hex) {
  std::string bytes, digits;
  for (const char c : hex) {
    if (c == ' ') continue;
    digits += c;
    if (digits.size() < 2) continue;
    bytes += static_cast<char>(std::stoi(digits, nullptr, 16));
    digits.clear();
  }
  return bytes;
}

Status ChangeBytes(const YAML::Node& change, const std::string& path) {
  std::string bytes = ReadBytes(path);
  if (change["cut"]) bytes.resize(change["cut"].as<size_t>());
  if (change["before"])
    bytes = BytesOfHex(change["before"].as<std::string>()) + bytes;
  if (change["after"]) bytes += BytesOfHex(change["after"].as<std::string>());
  if (change["at"]) {
    const std::string put = BytesOfHex(change["put"].as<std::string>());
    bytes.replace(change["at"].as<size_t>(), put.size(), put);
  }
  WriteBytes(path, bytes);
  return OkStatus();
}

Status MakeWhole(const YAML::Node& recipe, const std::string& folder,
                 const std::string& name) {
  const std::string path = folder + "/" + name;
  if (recipe["text"]) {
    WriteBytes(path, recipe["text"].as<std::string>());
    return OkStatus();
  }
  if (recipe["hex"]) {
    WriteBytes(path, BytesOfHex(recipe["hex"].as<std::string>()));
    return OkStatus();
  }
  if (recipe["brdf"]) return MakeBrdf(recipe["brdf"], path);
  if (recipe["model"]) return WriteModelOf(recipe, path);
  if (recipe["sphere_mesh"]) return MakeSphereMesh(recipe, path);
  const std::vector<int> size = Get(recipe, "size", std::vector<int>{16, 16});
  if (recipe["mask"]) {
    return WriteMask(recipe, size[0], size[1], path);
  }
  Image image(size[0], size[1]);
  if (recipe["scene"]) {
    IBRDF_RETURN_IF_ERROR(RenderInput(recipe["scene"], folder, &image));
  } else if (recipe["constant"]) {
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      image.rgb[i] = Value(recipe["constant"][i % 3]);
    }
  } else if (recipe["light"]) {
    IBRDF_RETURN_IF_ERROR(MakeLight(recipe["light"], &image));
  } else if (recipe["depth"]) {
    IBRDF_RETURN_IF_ERROR(MakeDepth(recipe["depth"].as<std::string>(), &image));
  } else if (recipe["normals"] &&
             recipe["normals"].as<std::string>() == "perspective") {
    MakePerspectiveNormals(&image);
  } else if (recipe["normals"]) {
    IBRDF_RETURN_IF_ERROR(
        MakeNormals(recipe["normals"].as<std::string>(), &image));
  } else {
    return Unknown(name, recipe);
  }
  for (const YAML::Node& edit : recipe["edit"]) {
    IBRDF_RETURN_IF_ERROR(Edit(edit, &image));
  }
  if (recipe["codes"]) return MakePhotograph(recipe["codes"], image, path);
  if (recipe["exr"]) return MakeExr(recipe["exr"], image, path);
  return WriteExr(image, path);
}

}  // namespace

Status MakeInput(const YAML::Node& recipe, const std::string& folder,
                 const std::string& name) {
  IBRDF_RETURN_IF_ERROR(MakeWhole(recipe, folder, name));
  return recipe["bytes"] ? ChangeBytes(recipe["bytes"], folder + "/" + name)
                         : OkStatus();
}

}  // namespace ibrdf
