// The readers of the sections `camera` and `views`.
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

void ReadPose(ProblemReader* reader, Camera* camera) {
  const char* const name = "world_from_camera";
  std::optional<Eigen::Matrix4d>& pose = camera->world_from_camera;
  reader->Read(name, &pose);
  if (!reader->Has(name)) return;
  for (const char* key : {"from", "to", "up"}) {
    if (reader->Has(key)) reader->Fail(key, "expected without a pose");
  }
  if (!pose.has_value()) return;
  const std::string fault = PoseFault(*pose);
  if (fault.empty()) {
    pose = NearestPose(*pose);
  } else {
    reader->Fail(name, fault);
  }
}

void ReadLens(ProblemReader* reader, Camera* camera) {
  reader->Read("fov_degrees", &camera->fov_degrees);
  reader->Read("focal_pixels", &camera->focal_pixels);
  reader->Read("centre_pixels", &camera->centre_pixels);
  if (reader->Has("focal_pixels") && reader->Has("fov_degrees")) {
    reader->Fail("fov_degrees", "expected without focal_pixels");
  }
}

// Reads one view of a list.
void ReadView(const ProblemReader& root, const std::string& shown,
              const ConfigNode& node, std::vector<ViewSpec>* views) {
  ConfigReader reader = root.Other(
      shown, node, {"name", "camera", "file", "mask", "labels", "exposure"});
  ViewSpec view;
  reader.Text("name", &view.name);
  if (!reader.Has("name")) reader.FailExpected("name", "the view's name");
  const std::string fault = ViewNameFault(view.name);
  if (!fault.empty()) reader.Fail("name", fault);
  for (const ViewSpec& other : *views) {
    if (other.name != view.name) continue;
    reader.Fail("name", "expected a name that no other view has");
  }
  ReadCamera(root.Like("camera", shown + ".camera", reader.Find("camera")),
             &view.camera);
  reader.Path("file", &view.file);
  reader.Path("mask", &view.mask);
  reader.Path("labels", &view.labels);
  if (reader.Has("exposure")) {
    reader.Number("exposure", problem_keys::kPositive,
                  &view.exposure.emplace());
  }
  for (const char* key : {"mask", "labels", "exposure"}) {
    if (reader.Has(key) && view.file.empty()) {
      reader.Fail(key, "expected beside the view's file");
    }
  }
  views->push_back(view);
}

void ReadViewList(const ConfigNode& node, ProblemReader* root,
                  ViewsSpec* views) {
  if (node.items.empty() || node.items.size() > kMaxViews) {
    root->FailExpected(
        "views", "a list of 1 to " + std::to_string(kMaxViews) + " views");
    return;
  }
  for (size_t i = 0; i < node.items.size(); ++i) {
    ReadView(*root, "views[" + std::to_string(i) + "]", node.items[i],
             &views->list);
  }
}

// The views of another program's file or model.
void ReadViewFiles(ProblemReader reader, ViewsSpec* views) {
  reader.Read("transforms", &views->transforms);
  reader.Read("colmap", &views->colmap);
  reader.Read("images", &views->images);
  reader.Read("masks", &views->masks);
  if (reader.Has("transforms") == reader.Has("colmap")) {
    reader.Fail("expected a list, or one of transforms and colmap");
  }
}

}  // namespace

void ReadCamera(ProblemReader reader, Camera* camera) {
  reader.Read("type", &camera->type);
  const bool perspective = camera->type == CameraType::kPerspective;
  for (const char* key :
       {"fov_degrees", "from", "to", "up", "focal_pixels", "centre_pixels"}) {
    reader.CheckNeeds(key, perspective);
  }
  ReadPose(&reader, camera);
  if (!perspective) return;
  ReadLens(&reader, camera);
  reader.Read("from", &camera->from);
  reader.Read("to", &camera->to);
  reader.Read("up", &camera->up);
  if (!IsValidCamera(*camera)) {
    reader.Fail(
        "expected `from` apart from `to` and `up` not parallel to the view");
  }
}

void ReadViews(ProblemReader* root, ViewsSpec* views) {
  const ConfigNode* node = root->Find("views");
  if (node == nullptr) return;
  if (root->Has("camera")) {
    root->Fail("views", "expected without camera");
  }
  if (node->kind == Kind::kList) {
    ReadViewList(*node, root, views);
  } else {
    ReadViewFiles(root->Below("views"), views);
  }
}

}  // namespace ibrdf
