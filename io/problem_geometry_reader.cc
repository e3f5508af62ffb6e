// The reader of the section `geometry`.
#include <array>
#include <string>

#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

void ReadSphere(ProblemReader reader, GeometrySpec* geometry) {
  if (!reader.Has("centre") && !reader.Has("radius")) return;
  if (!reader.Has("centre") || !reader.Has("radius")) {
    reader.Fail("expected both centre and radius, or {}");
    return;
  }
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  PixelCircle outline;
  reader.Read("centre", &centre);
  reader.Read("radius", &outline.radius);
  outline.x = centre.x();
  outline.y = centre.y();
  geometry->outline = outline;
}

void ReadFrame(ProblemReader* geometry, NormalFrame* frame) {
  const ConfigNode* node = geometry->Find("frame");
  if (node == nullptr) return;
  if (node->kind != Kind::kMap) {
    int word = 0;
    geometry->ReadChoice("frame", &word);
    *frame = word == 0 ? kOpenGlFrame : kOpenCvFrame;
    return;
  }
  ProblemReader reader = geometry->Below("frame");
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (size_t k = 0; k < 3; ++k) reader.Read(kNames[k], &(*frame)[k]);
  // Words of one axis of the picture are neighbours.
  const auto axis = [&](size_t k) { return static_cast<int>((*frame)[k]) / 2; };
  for (size_t k = 1; k < 3; ++k) {
    for (size_t other = 0; other < k; ++other) {
      if (axis(k) != axis(other)) continue;
      reader.Fail(kNames[k],
                  "expected another axis of the picture than that of " +
                      std::string(kNames[other]) +
                      ": one of left and right, of up and down, of toward "
                      "and away");
    }
  }
}

void ReadDepth(ProblemReader* reader, bool perspective,
               GeometrySpec* geometry) {
  reader->Read("depth", &geometry->file);
  reader->Read("depth_scale", &geometry->depth_scale);
  const double scale = geometry->depth_scale.value_or(1.0);
  if (scale == 0.0) {
    reader->FailExpected("depth_scale", "a number other than 0");
  } else if (scale < 0.0 && perspective) {
    reader->FailExpected("depth_scale",
                         "a number > 0 with camera.type: perspective");
  }
}

void ReadShape(ProblemReader* reader, bool perspective,
               GeometrySpec* geometry) {
  if (reader->Has("sphere")) {
    ReadSphere(reader->Below("sphere"), geometry);
    if (geometry->outline.has_value() && perspective) {
      reader->Fail("sphere",
                   "expected {} with camera.type: perspective: centre and "
                   "radius are of an orthographic picture");
    }
  } else if (reader->Has("mesh")) {
    geometry->kind = GeometryKind::kMesh;
    reader->Read("mesh", &geometry->file);
  } else if (reader->Has("normals")) {
    geometry->kind = GeometryKind::kNormals;
    reader->Read("normals", &geometry->file);
  } else {
    geometry->kind = GeometryKind::kDepth;
    ReadDepth(reader, perspective, geometry);
  }
}

// Refuses the geometry of one picture where there are several views.
void CheckOneView(ProblemReader* reader, const ViewsSpec& views,
                  const GeometrySpec& geometry) {
  if (!views.several()) return;
  if (geometry.HasNormalMap()) {
    reader->Fail("expected a sphere or a mesh with several views: a map of " +
                 std::string(geometry.kind == GeometryKind::kDepth
                                 ? "depth"
                                 : "normals") +
                 " is of one");
  } else if (geometry.outline.has_value()) {
    reader->Fail("sphere",
                 "expected {} with several views: centre and radius are of "
                 "one picture");
  }
}

}  // namespace

void ReadGeometry(ProblemReader reader, bool perspective,
                  const ViewsSpec& views, GeometrySpec* geometry) {
  int found = 0;
  for (const char* key : {"sphere", "mesh", "normals", "depth"}) {
    found += reader.Has(key);
  }
  if (found != 1) {
    reader.Fail("expected one of sphere, mesh, normals and depth, found " +
                std::to_string(found));
    return;
  }
  reader.CheckNeeds("fit", reader.Has("mesh"));
  reader.CheckNeeds("depth_scale", reader.Has("depth"));
  for (const char* key : {"frame", "encoding"}) {
    reader.CheckNeeds(key, reader.Has("normals"));
  }
  ReadShape(&reader, perspective, geometry);
  if (views.given() && reader.Has("mesh")) geometry->fit = MeshFit::kNone;
  reader.Read("fit", &geometry->fit);
  geometry->fit_stated = reader.Has("fit");
  CheckOneView(&reader, views, *geometry);
  reader.Read("up", &geometry->up);
  if (geometry->up != UpAxis::kY && geometry->HasNormalMap()) {
    reader.Fail("up",
                "expected y with a map of normals or depth, which is in the "
                "camera's frame");
  }
  ReadFrame(&reader, &geometry->frame);
  reader.Read("encoding", &geometry->encoding);
}

// Maps of normals and depth are in the camera's frame.
void CheckCameraStays(ProblemReader camera, const GeometrySpec& geometry) {
  if (!geometry.HasNormalMap()) return;
  const bool depth = geometry.kind == GeometryKind::kDepth;
  for (const char* key : {"from", "to", "up", "world_from_camera"}) {
    if (!camera.Has(key)) continue;
    camera.Fail(key, std::string("expected without geometry.") +
                         (depth ? "depth" : "normals") +
                         ", which is in the camera's frame");
  }
}

}  // namespace ibrdf
