// Normal maps in the frames and encodings that programs write.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

struct NormalMap {
  // In the camera's frame: x right, y up, z towards the camera; zero outside
  // the object. Of the file's lengths, which Scene::FromNormalMap makes 1.
  Image normals;
  std::vector<std::string> warnings;  // sentences for the user
};

// Reads geometry.file by its encoding and frame (GeometrySpec). Under kAuto,
// files of whole numbers hold (n + 1) / 2, and so do floats none of which is
// negative and whose lengths are far from 1; the latter is a warning. Values
// (0, 0, 0) are outside the object in every encoding.
//
// Vectors that (n + 1) / 2 leaves shorter than 0.1 are the grey ground around
// an object, and become (0, 0, 0).
//
// Fails where most normals face away from the camera, which is at +z, where
// lengths say that they are no normals, and where pixels are not square.
StatusOr<NormalMap> LoadNormals(const GeometrySpec& geometry);

// The same of a file's bytes; messages call it geometry.file.
StatusOr<NormalMap> DecodeNormals(const GeometrySpec& geometry,
                                  const std::string& bytes,
                                  const ImageLimits& limits = {});

}  // namespace ibrdf
