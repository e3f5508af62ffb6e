// transforms.json, the cameras of NeRF's data sets.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "ibrdf/base/pi.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/calibrated_views.h"

namespace ibrdf {
namespace {
using Json = nlohmann::json;

// The parsed form takes tens of times as much.
constexpr size_t kMaxTransformsBytes = size_t{16} << 20;
constexpr int kMaxTransformsDepth = 16;

Json ParseShallow(const std::string& text) {
  bool too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kMaxTransformsDepth;
    return !too_deep;
  };
  Json json = Json::parse(text, keep, false);
  if (too_deep) return {};
  return json;
}

// The values of a frame or else of the file.
class TransformsLens {
 public:
  TransformsLens(const std::string& path, const Json& file, const Json& frame)
      : path_(path), file_(file), frame_(frame) {}

  // Fills size, focal length and centre in.
  Status Read(CalibratedView* view) const {
    IBRDF_RETURN_IF_ERROR(CheckUndistorted());
    if (Find("fl_x") != nullptr) return ReadPixels(view);
    double angle = 0.0;
    if (!Number("camera_angle_x", &angle) || !(angle > 0.0) || !(angle < kPi)) {
      return Expected("camera_angle_x",
                      "an angle in (0, pi), or fl_x, w and h");
    }
    view->focal.setConstant(0.5 / std::tan(0.5 * angle));
    return OkStatus();
  }

 private:
  const Json* Find(const char* key) const {
    for (const Json* map : {&frame_, &file_}) {
      const auto value = map->find(key);
      if (value != map->end()) return &*value;
    }
    return nullptr;
  }

  bool Number(const char* key, double* out) const {
    const Json* value = Find(key);
    if (value == nullptr || !value->is_number()) return false;
    *out = value->get<double>();
    return std::isfinite(*out);
  }

  Status Expected(const std::string& key, const std::string& what) const {
    return InvalidInput(path_ + ": " + key, "expected " + what);
  }

  Status CheckUndistorted() const {
    const Json* model = Find("camera_model");
    if (model != nullptr &&
        (!model->is_string() ||
         (*model != "PINHOLE" && *model != "SIMPLE_PINHOLE" &&
          *model != "OPENCV" && *model != "perspective"))) {
      return Expected(
          "camera_model",
          "PINHOLE, SIMPLE_PINHOLE or an OPENCV without "
          "distortion, found " +
              model->dump(-1, ' ', true, Json::error_handler_t::replace)
                  .substr(0, 60));
    }
    for (const char* key : {"k1", "k2", "k3", "k4", "p1", "p2"}) {
      const Json* value = Find(key);
      if (value == nullptr) continue;
      if (!value->is_number() || value->get<double>() != 0.0) {
        return Expected(key, "0: images without distortion");
      }
    }
    return OkStatus();
  }

  Status ReadPixels(CalibratedView* view) const {
    if (!Number("w", &view->width) || !Number("h", &view->height) ||
        !(view->width >= 1.0) || !(view->width <= kMaxCalibratedSide) ||
        !(view->height >= 1.0) || !(view->height <= kMaxCalibratedSide)) {
      return Expected("w, h", "the size of the images, 1 to 1e6, with fl_x");
    }
    view->centre = 0.5 * Eigen::Vector2d(view->width, view->height);
    if (Find("cx") != nullptr && !Number("cx", &view->centre.x())) {
      return Expected("cx", "a number");
    }
    if (Find("cy") != nullptr && !Number("cy", &view->centre.y())) {
      return Expected("cy", "a number");
    }
    if (!Number("fl_x", &view->focal.x()) || !(view->focal.x() > 0.0)) {
      return Expected("fl_x", "a number > 0");
    }
    view->focal.y() = view->focal.x();
    if (Find("fl_y") != nullptr &&
        (!Number("fl_y", &view->focal.y()) || !(view->focal.y() > 0.0))) {
      return Expected("fl_y", "a number > 0");
    }
    return OkStatus();
  }

  const std::string& path_;
  const Json& file_;
  const Json& frame_;
};

Status ReadTransformMatrix(const std::string& where, const Json& frame,
                           Eigen::Matrix4d* pose) {
  const auto matrix = frame.find("transform_matrix");
  bool ok = matrix != frame.end() && matrix->is_array() && matrix->size() == 4;
  for (int i = 0; ok && i < 4; ++i) {
    const Json& row = (*matrix)[static_cast<size_t>(i)];
    ok = row.is_array() && row.size() == 4;
    for (int j = 0; ok && j < 4; ++j) {
      const Json& value = row[static_cast<size_t>(j)];
      ok = value.is_number();
      if (ok) (*pose)(i, j) = value.get<double>();
    }
  }
  if (!ok) return InvalidInput(where, "expected four rows of four numbers");
  const std::string fault = PoseFault(*pose);
  if (!fault.empty()) return InvalidInput(where, fault);
  *pose = NearestPose(*pose);
  return OkStatus();
}

}  // namespace

StatusOr<std::vector<CalibratedView>> ReadTransforms(const std::string& path) {
  const StatusOr<std::string> bytes = ReadFile(path, kMaxTransformsBytes);
  if (!bytes.ok()) return bytes.status();
  return ParseTransforms(path, *bytes);
}

StatusOr<std::vector<CalibratedView>> ParseTransforms(
    const std::string& path, const std::string& bytes) {
  const Json file = ParseShallow(bytes);
  if (!file.is_object()) return InvalidInput(path, "expected a JSON object");
  const auto frames = file.find("frames");
  if (frames == file.end() || !frames->is_array() || frames->empty() ||
      frames->size() > kMaxViews) {
    return InvalidInput(path + ": frames",
                        "expected a list of 1 to " + std::to_string(kMaxViews));
  }
  std::vector<CalibratedView> views;
  for (size_t i = 0; i < frames->size(); ++i) {
    const Json& frame = (*frames)[i];
    const std::string where = path + ": frames[" + std::to_string(i) + "]";
    const bool map = frame.is_object();
    const auto image = map ? frame.find("file_path") : frame.end();
    if (!map || image == frame.end() || !image->is_string()) {
      return InvalidInput(where, "expected a map with a text file_path");
    }
    CalibratedView view;
    view.image = image->get<std::string>();
    IBRDF_RETURN_IF_ERROR(ReadTransformMatrix(where + ".transform_matrix",
                                              frame, &view.world_from_camera));
    IBRDF_RETURN_IF_ERROR(TransformsLens(path, file, frame).Read(&view));
    views.push_back(std::move(view));
  }
  if (!NameViews(&views)) {
    return InvalidInput(path + ": frames",
                        "expected every file_path to name another file");
  }
  return views;
}

std::string TransformsText(const std::vector<CalibratedView>& views) {
  Json frames = Json::array();
  for (const CalibratedView& view : views) {
    Json frame = {{"file_path", view.image}};
    for (int i = 0; i < 4; ++i) {
      const Eigen::RowVector4d row = view.world_from_camera.row(i);
      frame["transform_matrix"].push_back({row[0], row[1], row[2], row[3]});
    }
    if (view.height > 0.0) {
      frame["w"] = view.width;
      frame["h"] = view.height;
      frame["fl_x"] = view.focal.x();
      frame["fl_y"] = view.focal.y();
      frame["cx"] = view.centre.x();
      frame["cy"] = view.centre.y();
    } else {
      frame["camera_angle_x"] = 2.0 * std::atan(0.5 / view.focal.x());
    }
    frames.push_back(std::move(frame));
  }
  const Json file = {{"frames", std::move(frames)}};
  return file.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ibrdf
