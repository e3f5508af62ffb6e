// The keys of the section `geometry`.
#include <string>

#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

constexpr double kMaxPixels = 1e6;
constexpr double kMaxDepthScale = 1e6;

// The words of PictureAxis, in its order.
Words PictureAxes() {
  return {{"right", "To the right in the picture."},
          {"left", "To the left."},
          {"up", "To the picture's upper side."},
          {"down", "To its lower side."},
          {"toward", "Toward the camera."},
          {"away", "Away from the camera."}};
}

Keys ShapeKeys() {
  return {
      Row("geometry",
          "The shape of the object: exactly one of `sphere`, `mesh`, `normals` "
          "and `depth`.")
          .Without("needed")
          .Notes({"The outline of a sphere is in pixels from the image's top "
                  "left corner, x to the right and y down. The first pixel's "
                  "centre is at (0.5, 0.5).",
                  "Without `centre` and `radius` it is the unit sphere's, or, "
                  "where that overlaps the mask by less than 0.98, fitted to "
                  "the mask (orthographic camera).",
                  "A map of normals or depth has the image's size and is in "
                  "the camera's frame: with `camera.type: perspective` leave "
                  "out `camera.from`, `to` and `up`.",
                  "Depth grows away from the camera, along the view. Its unit "
                  "is a pixel's side before the orthographic camera, and any "
                  "before the perspective one.",
                  "Depths that are 0, not finite or beyond 1e8 are holes."}),
      Row("geometry.sphere", "A sphere: `{}`, or its outline in the picture.")
          .OptionalMap()
          .Example("{}"),
      Row("geometry.sphere.centre", "Of the outline.")
          .Pair({-kMaxPixels, kMaxPixels, true, true})
          .Unit("pixels"),
      Row("geometry.sphere.radius", "Of the outline.")
          .Number({0.0, kMaxPixels, false, true}, "")
          .Unit("pixels")};
}

Keys PositionKeys() {
  return {Row("geometry.mesh",
              "A mesh of polygons. It shadows and lights itself where that "
              "matters (`effects`).")
              .Path(".obj, .ply, .stl, .glb"),
          Row("geometry.normals",
              "One normal per pixel, in the camera's frame; zero is outside. "
              "Without positions there are no shadows.")
              .Path(".exr, .hdr, .pfm, .png, .tif, .npy"),
          Row("geometry.depth",
              "One depth per pixel, which gives the normals. Without positions "
              "there are no shadows.")
              .Path(".exr, .pfm, .png, .tif, .npy"),
          Row("geometry.depth_scale",
              "The file's values times it are depth. `auto`: 1, and it must be "
              "said of whole numbers. Negative, for the orthographic camera "
              "alone: the file is a map of heights.")
              .AutoOrNumber({-kMaxDepthScale, kMaxDepthScale, true, true})
              .Needs("geometry.depth")};
}

Keys NormalMapKeys() {
  const std::string normals = "geometry.normals";
  return {
      Row("geometry.frame",
          "The axes of a normal map: a word, or a map that says where each "
          "points, as `{x: right, y: down, z: toward}`.")
          .ChoiceOrMap("opengl",
                       {{"opengl", "x right, y up, z toward the camera."},
                        {"opencv", "x right, y down, z away from the camera."}})
          .Needs(normals),
      Row("geometry.frame.x", "Where x points.")
          .Choice("", PictureAxes())
          .Without("`right`"),
      Row("geometry.frame.y", "Where y points.")
          .Choice("", PictureAxes())
          .Without("`up`"),
      Row("geometry.frame.z", "Where z points.")
          .Choice("", PictureAxes())
          .Without("`toward`"),
      Row("geometry.encoding", "How a normal map stores a component n.")
          .Choice("auto",
                  {{"auto",
                    "Files of whole numbers as `unit_0_1`; floats too, where "
                    "none is negative and lengths are far from 1."},
                   {"float", "As it is."},
                   {"unit_0_1", "(n + 1) / 2."}})
          .Needs(normals)};
}

Keys FitKeys() {
  return {Row("geometry.fit",
              "How a mesh is placed before the camera sees it. It must be said "
              "where `camera.from` or `camera.to` is given and `unit_sphere` "
              "would move the mesh.")
              .Choice("unit_sphere",
                      {{"unit_sphere",
                        "Its bounding box is centred at the origin, and its "
                        "farthest vertex is scaled to distance 1."},
                       {"none", "Its vertices stay as they are."}})
              .Needs("geometry.mesh"),
          Row("geometry.up",
              "The axis of the world of mesh, cameras and views that points "
              "up. The light is told above from below by it.")
              .Choice("y", {{"y", "As in files of OBJ, GLB and OpenGL."},
                            {"z",
                             "As in Blender and its scripts for NeRF: X, Y and "
                             "Z become x, -z and y."}})};
}

}  // namespace

Keys GeometryKeys() {
  Keys keys = Join({ShapeKeys(), PositionKeys(), NormalMapKeys(), FitKeys()});
  // Several views need a surface.
  for (ProblemKey& key : keys) {
    for (const char* map :
         {"geometry.sphere.", "geometry.normals", "geometry.depth",
          "geometry.frame", "geometry.encoding"}) {
      if (key.path.rfind(map, 0) == 0) key.used_by = kSolveOrRender;
    }
  }
  return keys;
}

}  // namespace problem_keys
}  // namespace ibrdf
