#include "ibrdf/solvers/problem/load_normals.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/base/median.h"
#include "ibrdf/io/photo_file.h"

namespace ibrdf {
namespace {

// Unit normals stored as (n + 1) / 2 have lengths from 0.37 to 1.37, and most
// are off by more than this; resampled or rounded normals are not.
constexpr double kFarOff = 0.1;
// Lengths further from 1 are worth a word: half floats and 8 bits are nearer.
constexpr double kNotUnit = 0.02;
// What is decoded and shorter is the middle grey that maps have around an
// object.
constexpr double kGround = 0.1;
// Lengths of normals that were averaged or rounded keep within these factors of
// their median, and those of (n + 1) / 2 have a median of 1. Others are colours
// or positions, where more than this share is so.
constexpr double kFarFactor = 2.0, kFarMedian = 0.3, kFarShare = 0.25;

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

// Refuses what cannot be normals by its lengths. Those of floats may have any
// unit, those that were `decoded` have not.
Status CheckLengths(const GeometrySpec& geometry, const Image& normals,
                    bool decoded) {
  std::vector<double> lengths;
  for (size_t i = 0; i < normals.rgb.size() / 3; ++i) {
    const Eigen::Vector3d v = At(normals, i);
    if (IsSet(v)) lengths.push_back(v.stableNorm());
  }
  if (lengths.empty()) return OkStatus();
  const double median = UpperMedian(lengths);
  const auto far_off = static_cast<double>(
      std::count_if(lengths.begin(), lengths.end(), [&](double length) {
        return length > kFarFactor * median || kFarFactor * length < median;
      }));
  if (far_off <= kFarShare * static_cast<double>(lengths.size()) &&
      !(decoded && std::abs(median - 1.0) > kFarMedian)) {
    return OkStatus();
  }
  return InvalidInput(
      geometry.file,
      "expected normals, found vectors whose lengths are far from alike, or "
      "from 1 (the median is " +
          Format("%.3g", median) + "): is it another picture?");
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
  if (encoding == NormalEncoding::kFloat) {
    return CheckLengths(geometry, map->normals, false);
  }
  const double largest = bits > 0 ? std::exp2(bits) - 1.0 : 1.0;
  for (size_t i = 0; i < map->normals.rgb.size() / 3; ++i) {
    const Eigen::Vector3d v = At(map->normals, i);
    if (!IsSet(v)) continue;
    Eigen::Vector3d n = (2.0 * v.array() / largest - 1.0).matrix();
    if (n.norm() < kGround) n.setZero();
    Eigen::Map<Eigen::Vector3f>(&map->normals.rgb[3 * i]) = n.cast<float>();
  }
  return CheckLengths(geometry, map->normals, true);
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

// The axis of a frame that points along the view, with its other word.
std::string OtherWay(const NormalFrame& frame) {
  for (size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    if (frame[k] == PictureAxis::kAway) return axis + ": toward";
    if (frame[k] == PictureAxis::kToward) return axis + ": away";
  }
  return "one axis is toward or away";
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
                                 : OtherWay(geometry.frame);
  return InvalidInput(
      geometry.file,
      std::to_string(100 * away / set) +
          " % of the normals face away from the camera, which is at +z (x "
          "right, y up); OpenCV's y and z have the other sign: "
          "geometry.frame: " +
          advice);
}

PhotoOptions NormalsOptions(const ImageLimits& limits) {
  PhotoOptions options;
  options.content = PhotoContent::kNormals;
  options.limits = limits;
  return options;
}

StatusOr<NormalMap> NormalsOfPhoto(const GeometrySpec& geometry,
                                   StatusOr<Photo> photo) {
  if (!photo.ok()) return photo.status();
  IBRDF_RETURN_IF_ERROR(CheckSquarePixels(geometry.file, *photo));
  NormalMap map;
  map.normals = std::move(photo->image);
  IBRDF_RETURN_IF_ERROR(Decode(geometry, photo->bits, &map));
  Orient(geometry, &map);
  IBRDF_RETURN_IF_ERROR(CheckTheyFaceTheCamera(geometry, map.normals));
  return map;
}

}  // namespace

StatusOr<NormalMap> LoadNormals(const GeometrySpec& geometry) {
  return NormalsOfPhoto(geometry, ReadPhoto(geometry.file, NormalsOptions({})));
}

StatusOr<NormalMap> DecodeNormals(const GeometrySpec& geometry,
                                  const std::string& bytes,
                                  const ImageLimits& limits) {
  return NormalsOfPhoto(
      geometry, DecodePhoto(geometry.file, bytes, NormalsOptions(limits)));
}

}  // namespace ibrdf
