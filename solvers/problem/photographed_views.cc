#include "ibrdf/solvers/problem/photographed_views.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/solvers/problem/load_photograph.h"
#include "ibrdf/solvers/problem/load_views.h"

namespace ibrdf {
namespace {
namespace fs = std::filesystem;

// Where a view's camera comes from, and its files.
struct ViewSource {
  std::string name, file, mask;
  Camera camera;                               // of a list
  std::optional<double> exposure;              // of a list; unset: the image's
  const CalibratedView* calibrated = nullptr;  // of a file
};

// The same word of several files.
class SharedWarnings {
 public:
  void Add(const std::string& file, const std::string& warning) {
    std::string text = warning;
    const size_t at = text.find(file);
    if (at != std::string::npos) text.erase(at, file.size());
    for (Shared& other : all_) {
      if (other.text != text) continue;
      ++other.further;
      return;
    }
    all_.push_back({text, warning, 0});
  }

  void AppendTo(std::vector<std::string>* warnings) const {
    for (const Shared& one : all_) {
      warnings->push_back(one.first +
                          (one.further == 0
                               ? ""
                               : "; and so of " + std::to_string(one.further) +
                                     " other views"));
    }
  }

 private:
  struct Shared {
    std::string text, first;
    int further;
  };
  std::vector<Shared> all_;
};

std::vector<ViewSource> ListedSources(const ViewsSpec& views) {
  std::vector<ViewSource> out;
  for (const ViewSpec& view : views.list) {
    out.push_back(
        {view.name, view.file, view.mask, view.camera, view.exposure, nullptr});
  }
  return out;
}

std::vector<ViewSource> CalibratedSources(
    const ViewsSpec& views, const std::vector<CalibratedView>& calibrated) {
  fs::path folder = views.images;
  if (folder.empty()) {
    folder = views.colmap.empty() ? fs::path(views.transforms).parent_path()
                                  : fs::path(views.colmap);
  }
  std::vector<ViewSource> out;
  for (const CalibratedView& view : calibrated) {
    ViewSource source;
    source.name = view.name;
    fs::path file = folder / view.image;
    // Blender's scripts leave it out.
    if (!file.has_extension()) file += ".png";
    source.file = file.string();
    if (!views.masks.empty()) {
      source.mask = (fs::path(views.masks) / (view.name + ".png")).string();
    }
    source.calibrated = &view;
    out.push_back(std::move(source));
  }
  return out;
}

StatusOr<ViewPhotograph> ReadView(const Problem& problem,
                                  const ViewSource& source,
                                  SharedWarnings* warnings) {
  ImageSpec spec = problem.image;
  spec.file = source.file;
  spec.mask = source.mask;
  spec.exposure = source.exposure.value_or(spec.exposure);
  StatusOr<Photograph> photograph = LoadPhotograph(spec);
  if (!photograph.ok()) return photograph.status();
  for (const std::string& warning : photograph->warnings) {
    warnings->Add(source.file, warning);
  }
  ViewPhotograph out{source.name, source.file, source.mask, source.camera,
                     *std::move(photograph)};
  if (source.calibrated == nullptr) return out;
  const Image& radiance = out.photograph.radiance;
  const StatusOr<Camera> camera =
      CameraOf(*source.calibrated, radiance.width, radiance.height);
  if (!camera.ok()) {
    return InvalidInput(source.file, camera.status().message());
  }
  out.camera = *camera;
  return out;
}

}  // namespace

Status ReadViewPhotographs(const Problem& problem,
                           const std::function<Status(ViewPhotograph)>& take,
                           std::vector<std::string>* warnings) {
  const ViewsSpec& views = problem.views;
  std::vector<CalibratedView> calibrated;
  if (views.list.empty()) {
    StatusOr<std::vector<CalibratedView>> read = ReadCalibratedViews(
        views.transforms, views.colmap, problem.geometry.up);
    if (!read.ok()) return read.status();
    calibrated = *std::move(read);
  }
  SharedWarnings shared;
  for (const ViewSource& source : views.list.empty()
                                      ? CalibratedSources(views, calibrated)
                                      : ListedSources(views)) {
    StatusOr<ViewPhotograph> view = ReadView(problem, source, &shared);
    if (!view.ok()) return view.status();
    IBRDF_RETURN_IF_ERROR(take(*std::move(view)));
  }
  shared.AppendTo(warnings);
  return OkStatus();
}

StatusOr<std::vector<PhotographedView>> LoadPhotographedViews(
    const Problem& problem, std::vector<std::string>* warnings) {
  std::vector<PhotographedView> out;
  IBRDF_RETURN_IF_ERROR(ReadViewPhotographs(
      problem,
      [&](ViewPhotograph view) {
        out.push_back({view.name, view.file, view.camera,
                       KnownRadiance(view.photograph),
                       std::move(view.photograph.mask)});
        return OkStatus();
      },
      warnings));
  return out;
}

}  // namespace ibrdf
