// Views of an object by calibrated cameras, as other programs' files have them.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"

namespace ibrdf {

inline constexpr size_t kMaxViews = 10000;
inline constexpr double kMaxCalibratedSide = 1e6;  // pixels

// A pinhole's view.
struct CalibratedView {
  std::string name;   // a file name (ViewNameFault), unlike the others'
  std::string image;  // as the file has it
  Eigen::Matrix4d world_from_camera = Eigen::Matrix4d::Identity();  // a pose
  // In pixels of the image that was calibrated; focal > 0.
  Eigen::Vector2d focal{1.0, 1.0}, centre{0.5, 0.5};
  // Its size. Height 0: focal is in widths of an image of any size, whose
  // middle is the centre.
  double width = 1.0, height = 0.0;
};

// What keeps a text from naming a view's files; empty where it may. 1 to 200
// bytes, no slashes and no control characters, neither "." nor "..".
std::string ViewNameFault(const std::string& name);

// Names views by their images' files without folder and extension or, where
// two were alike, by their whole paths with _ for slashes. False: two are alike
// all the same, or a name has a fault.
bool NameViews(std::vector<CalibratedView>* views);

// The camera before an image of width x height, a larger or smaller version of
// the one that was calibrated. Refuses one of other proportions (by more than a
// pixel).
StatusOr<Camera> CameraOf(const CalibratedView& view, int width, int height);

// transforms.json of NeRF's synthetic scenes, of Stanford-ORB and of
// instant-ngp: poses in OpenGL's frame (Camera::world_from_camera), the focal
// length as camera_angle_x or fl_x, fl_y, cx, cy, w and h, at the top or in a
// frame. Refused by name: cameras with distortion, poses that are no rotation.
StatusOr<std::vector<CalibratedView>> ReadTransforms(const std::string& path);
StatusOr<std::vector<CalibratedView>> ParseTransforms(const std::string& path,
                                                      const std::string& bytes);

// A file that ReadTransforms reads back, to within rounding; the views are then
// named by their images.
std::string TransformsText(const std::vector<CalibratedView>& views);

// COLMAP's sparse model in a folder: cameras and images, .bin or else .txt.
// Poses are camera_from_world in OpenCV's frame (x right, y down, z ahead) as
// quaternions w, x, y, z. Cameras are PINHOLE or SIMPLE_PINHOLE; the others are
// refused by name. Views are in the order of their images' names.
StatusOr<std::vector<CalibratedView>> ReadColmap(const std::string& folder);

struct ColmapFile {
  std::string path, bytes;
};
StatusOr<std::vector<CalibratedView>> ParseColmapText(const ColmapFile& cameras,
                                                      const ColmapFile& images);
StatusOr<std::vector<CalibratedView>> ParseColmapBinary(
    const ColmapFile& cameras, const ColmapFile& images);

}  // namespace ibrdf
