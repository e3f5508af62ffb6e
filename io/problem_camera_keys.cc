// The keys of the sections `camera` and `views`.
#include <string>

#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {

Keys CameraKeys() {
  const std::string pinhole = "camera.type: perspective";
  return {
      Row("camera",
          "The camera that took the image. "
          "[Conventions](conventions.md#frames) has its frame.")
          .Notes({"A calibrated camera has `world_from_camera` in place of "
                  "`from`, `to` and `up`, and `focal_pixels` in place of "
                  "`fov_degrees`.",
                  "A rotation may be rounded to three digits. A mirror image "
                  "or a scale is refused."}),
      Row("camera.type", "How the camera projects.")
          .Choice("orthographic",
                  {{"orthographic",
                    "Looks along -z. The shorter side of the image spans [-1, "
                    "1], the longer one proportionally more."},
                   {"perspective", "A pinhole at `camera.from`."}}),
      Row("camera.fov_degrees", "Full vertical angle of view.")
          .Number({0.0, 180.0, false, false}, "30")
          .Unit("degrees")
          .Needs(pinhole),
      Row("camera.from", "Position of the camera. It differs from `camera.to`.")
          .Triple(kAnyNumber, "[0, 0, 4]")
          .Unit("scene units")
          .Needs(pinhole),
      Row("camera.to", "The point that is seen in the middle of the image.")
          .Triple(kAnyNumber, "[0, 0, 0]")
          .Unit("scene units")
          .Needs(pinhole),
      Row("camera.up", "Upward direction, not parallel to the view.")
          .Triple(kAnyNumber, "[0, 1, 0]")
          .Needs(pinhole),
      Row("camera.world_from_camera",
          "The pose: four rows of a rotation and the camera's centre. Columns: "
          "right, up, against the view (OpenGL), and the centre.")
          .Matrix()
          .Without("by `from`, `to` and `up`"),
      Row("camera.focal_pixels", "Focal length, along x and y.")
          .OneOrPair(kPositive)
          .Unit("pixels")
          .Without("by `fov_degrees`")
          .Needs(pinhole),
      Row("camera.centre_pixels",
          "Where the view meets the image, from its top left corner, x to the "
          "right and y down.")
          .Pair(kAnyNumber)
          .Unit("pixels")
          .Without("the middle")
          .Needs(pinhole)};
}

Keys ViewKeys() {
  return {
      Row("views",
          "Several views in place of `image` and `camera`: a list, or a file "
          "of another program.")
          .ListOrMap()
          .Notes({"Each item of a list has a `name` and a `camera` with the "
                  "keys above: `views: [{name: left, camera: {...}}]`.",
                  "Results of a view have its name. Those of files are named "
                  "by their images.",
                  "With `views`, `geometry.fit` is `none` by default: cameras "
                  "and mesh share one frame.",
                  "The focal length of a file is scaled to the size of "
                  "`image`, which has its proportions.",
                  "In a solve and with `problem: textures` each item has a "
                  "`file` as well, and may have a `mask`: `{name: left, file: "
                  "left.exr, mask: left.png, camera: {...}}`.",
                  "`image` then holds what the photographs share: the curve "
                  "and the exposure. An item may have an `exposure` of its "
                  "own.",
                  "Views of labelled materials each have `labels`, in place "
                  "of `reflectance.labels`.",
                  "A solve explains all views by one reflectance and one "
                  "light. They need a mesh or a sphere.",
                  "A render makes all views in one run."}),
      Row("views.transforms",
          "transforms.json of NeRF, Stanford-ORB or instant-ngp: poses in "
          "OpenGL's frame, of cameras without distortion.")
          .Path(".json"),
      Row("views.colmap",
          "Folder of a model of COLMAP, text or binary, with PINHOLE or "
          "SIMPLE_PINHOLE cameras.")
          .Path("a folder"),
      Row("views.images",
          "Folder of the images that the file or model names. A name without "
          "extension is that of a PNG.")
          .Path("a folder")
          .Without("the file's folder, or `colmap`")
          .UsedBy(kPhotographs),
      Row("views.masks",
          "Folder of the views' masks, NAME.png each. Transparent pixels of an "
          "image are outside without a mask, too.")
          .Path("a folder")
          .Without("none")
          .UsedBy(kPhotographs)};
}

}  // namespace problem_keys
}  // namespace ibrdf
