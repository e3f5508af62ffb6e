#include "ibrdf/solvers/problem/load_normals.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/io/photo_file.h"

namespace ibrdf {
namespace {

// Unit normals stored as (n + 1) / 2 have lengths from 0.37 to 1.37, and most
// are off by more than this; resampled or rounded normals are not.
constexpr double kFarOff = 0.1;
// Lengths further from 1 are worth a word: half floats and 8 bits are nearer.
constexpr double kNotUnit = 0.02;

Eigen::Vector3d At(const Image& image, size_t pixel) {
  return Eigen::Map<const Eigen::Vector3f>(&image.rgb[3 * pixel])
      .cast<double>();
}

bool IsSet(const Eigen::Vector3d& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() > 0.0;
}

// Whether floats look like (n + 1) / 2.
bool LooksEncoded(const Image& image) {
  size_t set = 0, far_off = 0;
  for (size_t i = 0; i < image.rgb.size() / 3; ++i) {
    const Eigen::Vector3d v = At(image, i);
    if (!IsSet(v)) continue;
    if (v.minCoeff() < 0.0 || v.maxCoeff() > 1.0) return false;
    ++set;
    far_off += std::abs(v.stableNorm() - 1.0) > kFarOff;
  }
  return 2 * far_off > set;
}

// Turns what the file holds into vectors in its own frame.
Status Decode(const GeometrySpec& geometry, int bits, NormalMap* map) {
  NormalEncoding encoding = geometry.encoding;
  if (encoding == NormalEncoding::kFloat && bits > 0) {
    return InvalidInput(geometry.file,
                        "geometry.encoding: expected unit_0_1 of a file of "
                        "whole numbers, found 'float'");
  }
  if (encoding == NormalEncoding::kAuto) {
    const bool encoded = bits > 0 || LooksEncoded(map->normals);
    if (encoded && bits == 0) {
      map->warnings.push_back(
          geometry.file +
          ": no component is negative and the lengths are far from 1: taken "
          "for normals stored as (n + 1) / 2 in [0, 1] (geometry.encoding)");
    }
    encoding = encoded ? NormalEncoding::kUnit01 : NormalEncoding::kFloat;
  }
  if (encoding == NormalEncoding::kFloat) return OkStatus();
  const double largest = bits > 0 ? std::exp2(bits) - 1.0 : 1.0;
  for (size_t i = 0; i < map->normals.rgb.size() / 3; ++i) {
    const Eigen::Vector3d v = At(map->normals, i);
    if (!IsSet(v)) continue;
    Eigen::Map<Eigen::Vector3f>(&map->normals.rgb[3 * i]) =
        (2.0 * v.array() / largest - 1.0).matrix().cast<float>();
  }
  return OkStatus();
}

// A vector of the file's frame in the camera's.
Eigen::Vector3f Turned(const NormalFrame& frame, const Eigen::Vector3f& v) {
  Eigen::Vector3f out;
  for (size_t k = 0; k < 3; ++k) {
    // Pairs in the order of x, y and z, those that grow first.
    const int word = static_cast<int>(frame[k]);
    const float component = v[static_cast<Eigen::Index>(k)];
    out[word / 2] = word % 2 == 0 ? component : -component;
  }
  return out;
}

// Turns them into the camera's frame and counts those of other lengths.
void Orient(const GeometrySpec& geometry, NormalMap* map) {
  size_t set = 0, other = 0;
  for (size_t i = 0; i < map->normals.rgb.size() / 3; ++i) {
    Eigen::Map<Eigen::Vector3f> v(&map->normals.rgb[3 * i]);
    if (!IsSet(v.cast<double>())) continue;
    v = Turned(geometry.frame, v);
    ++set;
    other += std::abs(v.cast<double>().stableNorm() - 1.0) > kNotUnit;
  }
  if (100 * other > set) {
    map->warnings.push_back(geometry.file + ": " + std::to_string(other) +
                            " of " + std::to_string(set) +
                            " normals are not of unit length; they were "
                            "normalised");
  }
}

Status CheckTheyFaceTheCamera(const GeometrySpec& geometry,
                              const Image& normals) {
  size_t set = 0, away = 0;
  for (size_t i = 0; i < normals.rgb.size() / 3; ++i) {
    const Eigen::Vector3d v = At(normals, i);
    if (!IsSet(v)) continue;
    ++set;
    away += v.z() < 0.0;
  }
  if (2 * away <= set) return OkStatus();
  const std::string advice = geometry.frame == kOpenGlFrame ? "opencv"
                             : geometry.frame == kOpenCvFrame
                                 ? "opengl"
                                 : "one axis is toward or away";
  return InvalidInput(
      geometry.file,
      std::to_string(100 * away / set) +
          " % of the normals face away from the camera, which is at +z (x "
          "right, y up); OpenCV's y and z have the other sign: "
          "geometry.frame: " +
          advice);
}

}  // namespace

StatusOr<NormalMap> LoadNormals(const GeometrySpec& geometry) {
  PhotoOptions options;
  options.content = PhotoContent::kNormals;
  StatusOr<Photo> photo = ReadPhoto(geometry.file, options);
  if (!photo.ok()) return photo.status();
  NormalMap map;
  map.normals = std::move(photo->image);
  IBRDF_RETURN_IF_ERROR(Decode(geometry, photo->bits, &map));
  Orient(geometry, &map);
  IBRDF_RETURN_IF_ERROR(CheckTheyFaceTheCamera(geometry, map.normals));
  return map;
}

}  // namespace ibrdf
