// The cameras and images of COLMAP's sparse models.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/text_numbers.h"

namespace ibrdf {
namespace {

// Images list the points that they see, which are not read.
constexpr size_t kMaxColmapBytes = size_t{512} << 20;

struct ColmapModel {
  const char* name;
  size_t parameters;
};
// By their numbers in the binary format.
constexpr std::array<ColmapModel, 11> kColmapModels = {
    {{"SIMPLE_PINHOLE", 3},
     {"PINHOLE", 4},
     {"SIMPLE_RADIAL", 4},
     {"RADIAL", 5},
     {"OPENCV", 8},
     {"OPENCV_FISHEYE", 8},
     {"FULL_OPENCV", 12},
     {"FOV", 5},
     {"SIMPLE_RADIAL_FISHEYE", 4},
     {"RADIAL_FISHEYE", 5},
     {"THIN_PRISM_FISHEYE", 12}}};

struct ColmapCamera {
  std::string model;
  double width = 0.0, height = 0.0;
  std::vector<double> parameters;
};
using ColmapCameras = std::map<uint32_t, ColmapCamera>;

struct ColmapImage {
  std::string name;
  std::array<double, 4> rotation{};  // w, x, y, z
  std::array<double, 3> translation{};
  uint32_t camera = 0;
};

// Fills in what `camera` says of the lens.
Status SetLens(const std::string& where, const ColmapCamera& camera,
               CalibratedView* view) {
  const bool simple = camera.model == "SIMPLE_PINHOLE";
  if (!simple && camera.model != "PINHOLE") {
    return InvalidInput(where, "expected PINHOLE or SIMPLE_PINHOLE, found " +
                                   camera.model.substr(0, 60) +
                                   "; undistort the images with COLMAP first");
  }
  const std::vector<double>& p = camera.parameters;
  bool ok = p.size() == (simple ? 3u : 4u) && camera.width >= 1.0 &&
            camera.width <= kMaxCalibratedSide && camera.height >= 1.0 &&
            camera.height <= kMaxCalibratedSide;
  for (const double value : p) ok = ok && std::isfinite(value);
  if (!ok || !(p[0] > 0.0) || !(p[1] > 0.0 || simple)) {
    return InvalidInput(where,
                        "expected a size of 1 to 1e6 pixels, a focal length > "
                        "0 and a finite centre");
  }
  view->width = camera.width;
  view->height = camera.height;
  view->focal = {p[0], simple ? p[0] : p[1]};
  view->centre = {p[p.size() - 2], p[p.size() - 1]};
  return OkStatus();
}

// world_from_camera in OpenGL's frame of camera_from_world in OpenCV's.
Status SetPose(const std::string& where, const ColmapImage& image,
               CalibratedView* view) {
  const Eigen::Map<const Eigen::Vector4d> q(image.rotation.data());
  const Eigen::Map<const Eigen::Vector3d> t(image.translation.data());
  // COLMAP's are of length 1 but for rounding.
  constexpr double kUnit = 1e-2;
  if (!q.allFinite() || !t.allFinite() || !(std::abs(q.norm() - 1.0) < kUnit)) {
    return InvalidInput(where,
                        "expected a quaternion of length 1 and a finite "
                        "translation");
  }
  const Eigen::Matrix3d world_from_camera =
      Eigen::Quaterniond(q[0], q[1], q[2], q[3])
          .normalized()
          .toRotationMatrix()
          .transpose();
  const Eigen::Vector3d centre = -(world_from_camera * t);
  if (!centre.allFinite()) {
    return InvalidInput(where, "expected a finite position");
  }
  view->world_from_camera.topLeftCorner<3, 3>() =
      world_from_camera * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  view->world_from_camera.topRightCorner<3, 1>() = centre;
  return OkStatus();
}

StatusOr<std::vector<CalibratedView>> ViewsOf(const ColmapFile& cameras_file,
                                              const ColmapCameras& cameras,
                                              const ColmapFile& images_file,
                                              std::vector<ColmapImage> images) {
  if (images.empty() || images.size() > kMaxViews) {
    return InvalidInput(images_file.path,
                        "expected 1 to " + std::to_string(kMaxViews) +
                            " images, found " + std::to_string(images.size()));
  }
  std::sort(images.begin(), images.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  std::vector<CalibratedView> views;
  for (const ColmapImage& image : images) {
    const std::string where =
        images_file.path + ": image " + image.name.substr(0, 200);
    const auto camera = cameras.find(image.camera);
    const std::string id = std::to_string(image.camera);
    if (camera == cameras.end()) {
      return InvalidInput(
          where, "expected a camera of " + cameras_file.path + ", found " + id);
    }
    CalibratedView view;
    view.image = image.name;
    IBRDF_RETURN_IF_ERROR(
        SetLens(cameras_file.path + ": camera " + id, camera->second, &view));
    IBRDF_RETURN_IF_ERROR(SetPose(where, image, &view));
    views.push_back(std::move(view));
  }
  if (!NameViews(&views)) {
    return InvalidInput(images_file.path,
                        "expected every image to name another file");
  }
  return views;
}

// The lines of a text file, counted.
class ColmapLines {
 public:
  explicit ColmapLines(const ColmapFile& file)
      : path_(file.path), text_(WithoutByteOrderMark(file.bytes)) {}

  // Splits the next line into words; false at the end.
  bool Next(std::vector<std::string_view>* words) {
    words->clear();
    if (at_ >= text_.size()) return false;
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    SplitWords(line, words);
    return true;
  }

  // The next line with words that is no comment.
  bool NextEntry(std::vector<std::string_view>* words) {
    while (Next(words)) {
      if (!words->empty() && words->front().front() != '#') return true;
    }
    return false;
  }

  Status Expected(const std::string& what) const {
    return InvalidInput(path_ + ": line " + std::to_string(line_),
                        "expected " + what);
  }

 private:
  const std::string& path_;
  std::string_view text_;
  size_t at_ = 0;
  int64_t line_ = 0;
};

StatusOr<ColmapCameras> CamerasOfText(const ColmapFile& file) {
  ColmapCameras cameras;
  ColmapLines lines(file);
  std::vector<std::string_view> words;
  while (lines.NextEntry(&words)) {
    constexpr size_t kMaxWords = 4 + 12;
    uint32_t id = 0;
    ColmapCamera camera;
    bool ok = words.size() > 4 && words.size() <= kMaxWords &&
              ParseNumber(words[0], &id) &&
              ParseNumber(words[2], &camera.width) &&
              ParseNumber(words[3], &camera.height);
    if (ok) camera.model = std::string(words[1].substr(0, 60));
    for (size_t i = 4; ok && i < words.size(); ++i) {
      camera.parameters.push_back(0.0);
      ok = ParseNumber(words[i], &camera.parameters.back());
    }
    if (!ok || cameras.size() >= kMaxViews) {
      return lines.Expected(
          "CAMERA_ID MODEL WIDTH HEIGHT and the model's parameters, of at "
          "most " +
          std::to_string(kMaxViews) + " cameras");
    }
    cameras[id] = std::move(camera);
  }
  return cameras;
}

StatusOr<std::vector<ColmapImage>> ImagesOfText(const ColmapFile& file) {
  std::vector<ColmapImage> images;
  ColmapLines lines(file);
  std::vector<std::string_view> words;
  while (lines.NextEntry(&words)) {
    constexpr size_t kNameAt = 9;
    uint32_t id = 0;
    ColmapImage image;
    bool ok = words.size() > kNameAt && ParseNumber(words[0], &id) &&
              ParseNumber(words[8], &image.camera);
    for (size_t i = 0; ok && i < 4; ++i) {
      ok = ParseNumber(words[1 + i], &image.rotation[i]);
    }
    for (size_t i = 0; ok && i < 3; ++i) {
      ok = ParseNumber(words[5 + i], &image.translation[i]);
    }
    if (!ok || images.size() >= kMaxViews) {
      return lines.Expected(
          "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, of "
          "at most " +
          std::to_string(kMaxViews) + " images");
    }
    for (size_t i = kNameAt; i < words.size(); ++i) {
      image.name += (i > kNameAt ? " " : "") + std::string(words[i]);
    }
    images.push_back(std::move(image));
    lines.Next(&words);  // its points, perhaps none
  }
  return images;
}

// Little-endian numbers of a file; all fail once one is cut off.
class ColmapBytes {
 public:
  explicit ColmapBytes(const ColmapFile& file)
      : path_(file.path), text_(file.bytes) {}

  bool ok() const { return ok_; }

  template <typename Number>
  Number Next() {
    Number value{};
    if (!Skip(sizeof(Number))) return value;
    std::memcpy(&value, text_.data() + at_ - sizeof(Number), sizeof(Number));
    return value;
  }

  // Up to a byte 0.
  std::string NextText() {
    const size_t end = ok_ ? text_.find('\0', at_) : std::string::npos;
    ok_ = end != std::string::npos;
    if (!ok_) return "";
    const size_t begin = at_;
    at_ = end + 1;
    return text_.substr(begin, end - begin);
  }

  bool Skip(uint64_t bytes) {
    ok_ = ok_ && bytes <= text_.size() - at_;
    if (ok_) at_ += bytes;
    return ok_;
  }

  Status CutOff() const {
    return InvalidInput(path_,
                        "expected more bytes: the file is cut off, or "
                        "not of COLMAP");
  }
  Status Expected(const std::string& what) const {
    return InvalidInput(path_, "expected " + what);
  }

 private:
  const std::string& path_;
  const std::string& text_;
  size_t at_ = 0;
  bool ok_ = true;
};

StatusOr<ColmapCameras> CamerasOfBinary(const ColmapFile& file) {
  ColmapCameras cameras;
  ColmapBytes bytes(file);
  const auto count = bytes.Next<uint64_t>();
  if (count > kMaxViews) {
    return bytes.Expected("at most " + std::to_string(kMaxViews) +
                          " cameras, found " + std::to_string(count));
  }
  for (uint64_t i = 0; i < count; ++i) {
    const auto id = bytes.Next<uint32_t>();
    const auto model = bytes.Next<uint32_t>();
    ColmapCamera camera;
    camera.width = static_cast<double>(bytes.Next<uint64_t>());
    camera.height = static_cast<double>(bytes.Next<uint64_t>());
    if (!bytes.ok()) return bytes.CutOff();
    if (model >= kColmapModels.size()) {
      return bytes.Expected("the number of a camera model, found " +
                            std::to_string(model));
    }
    camera.model = kColmapModels[model].name;
    for (size_t k = 0; k < kColmapModels[model].parameters; ++k) {
      camera.parameters.push_back(bytes.Next<double>());
    }
    cameras[id] = std::move(camera);
  }
  if (!bytes.ok()) return bytes.CutOff();
  return cameras;
}

StatusOr<std::vector<ColmapImage>> ImagesOfBinary(const ColmapFile& file) {
  constexpr uint64_t kPointBytes = 24;
  std::vector<ColmapImage> images;
  ColmapBytes bytes(file);
  const auto count = bytes.Next<uint64_t>();
  if (count > kMaxViews) {
    return bytes.Expected("at most " + std::to_string(kMaxViews) +
                          " images, found " + std::to_string(count));
  }
  for (uint64_t i = 0; i < count; ++i) {
    ColmapImage image;
    bytes.Next<uint32_t>();  // its number
    for (double& q : image.rotation) q = bytes.Next<double>();
    for (double& t : image.translation) t = bytes.Next<double>();
    image.camera = bytes.Next<uint32_t>();
    image.name = bytes.NextText();
    const auto points = bytes.Next<uint64_t>();
    if (!bytes.ok() || points > file.bytes.size() / kPointBytes ||
        !bytes.Skip(kPointBytes * points)) {
      return bytes.CutOff();
    }
    images.push_back(std::move(image));
  }
  if (!bytes.ok()) return bytes.CutOff();
  return images;
}

}  // namespace

StatusOr<std::vector<CalibratedView>> ParseColmapText(
    const ColmapFile& cameras, const ColmapFile& images) {
  const StatusOr<ColmapCameras> found = CamerasOfText(cameras);
  if (!found.ok()) return found.status();
  StatusOr<std::vector<ColmapImage>> listed = ImagesOfText(images);
  if (!listed.ok()) return listed.status();
  return ViewsOf(cameras, *found, images, *std::move(listed));
}

StatusOr<std::vector<CalibratedView>> ParseColmapBinary(
    const ColmapFile& cameras, const ColmapFile& images) {
  const StatusOr<ColmapCameras> found = CamerasOfBinary(cameras);
  if (!found.ok()) return found.status();
  StatusOr<std::vector<ColmapImage>> listed = ImagesOfBinary(images);
  if (!listed.ok()) return listed.status();
  return ViewsOf(cameras, *found, images, *std::move(listed));
}

StatusOr<std::vector<CalibratedView>> ReadColmap(const std::string& folder) {
  const std::filesystem::path at(folder);
  std::error_code ignored;
  const bool binary = std::filesystem::exists(at / "images.bin", ignored);
  if (!binary && !std::filesystem::exists(at / "images.txt", ignored)) {
    return InvalidInput(folder,
                        "expected a folder with cameras.bin and images.bin, "
                        "or cameras.txt and images.txt");
  }
  std::array<ColmapFile, 2> files;
  for (size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "cameras" : "images";
    files[i].path = (at / (name + (binary ? ".bin" : ".txt"))).string();
    StatusOr<std::string> bytes = ReadFile(files[i].path, kMaxColmapBytes);
    if (!bytes.ok()) return bytes.status();
    files[i].bytes = *std::move(bytes);
  }
  return binary ? ParseColmapBinary(files[0], files[1])
                : ParseColmapText(files[0], files[1]);
}

}  // namespace ibrdf
