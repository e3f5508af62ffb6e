#include "ibrdf/solvers/next_view/candidate_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/problem/load_views.h"
#include "ibrdf/uncertainty/best_view.h"

namespace ibrdf {
namespace {

constexpr char kOption[] = "command line: --candidates";
// A lens has this where no photograph has one.
constexpr double kFovDegrees = 30.0;
// A multiple of the distance at which all of the surface is just seen.
constexpr double kMargin = 1.1;

// A pinhole that looks at `centre` from `from`.
Eigen::Matrix4d LookAt(const Eigen::Vector3d& from,
                       const Eigen::Vector3d& centre) {
  const Eigen::Vector3d back = (from - centre).normalized();
  const Eigen::Vector3d up = std::abs(back.y()) > 0.99
                                 ? Eigen::Vector3d(0.0, 0.0, 1.0)
                                 : Eigen::Vector3d(0.0, 1.0, 0.0);
  const Eigen::Vector3d right = up.cross(back).normalized();
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.block<3, 1>(0, 0) = right;
  pose.block<3, 1>(0, 1) = back.cross(right);
  pose.block<3, 1>(0, 2) = back;
  pose.block<3, 1>(0, 3) = from;
  return pose;
}

// Lens and distance of a candidate on the sphere.
struct SphereLens {
  CalibratedView view;
  double distance = 0.0;
};

SphereLens LensOf(const CandidateSetting& setting) {
  const std::vector<SizedCamera>& views = setting.photographs;
  SphereLens out;
  out.view.width = views[0].width;
  out.view.height = views[0].height;
  int pinholes = 0;
  for (const SizedCamera& view : views) {
    if (view.camera.type != CameraType::kPerspective) continue;
    out.distance += (AxesOf(view.camera).centre - setting.centre).norm();
    if (pinholes++ > 0) continue;
    out.view.width = view.width;
    out.view.height = view.height;
    const PixelGrid grid = PixelGridOf(view.camera, view.width, view.height);
    out.view.focal = grid.side.cwiseInverse();
    out.view.centre = grid.centre;
  }
  if (pinholes > 0) {
    out.distance /= pinholes;
    return out;
  }
  const double half = 0.5 * kFovDegrees * kPi / 180.0;
  const double side = std::min(out.view.width, out.view.height);
  out.view.focal.setConstant(0.5 * side / std::tan(half));
  out.view.centre = {0.5 * out.view.width, 0.5 * out.view.height};
  out.distance = kMargin * setting.radius / std::sin(half);
  return out;
}

std::vector<CalibratedView> SphereCandidates(int count,
                                             const CandidateSetting& setting) {
  const SphereLens lens = LensOf(setting);
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  std::vector<CalibratedView> out;
  for (int i = 0; i < count; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / count;
    const double r = std::sqrt(std::max(0.0, 1.0 - y * y));
    const double phi = golden * i;
    const Eigen::Vector3d direction(r * std::sin(phi), y, r * std::cos(phi));
    CalibratedView view = lens.view;
    view.name = view.image = Format("candidate_%04d", i);
    view.world_from_camera =
        LookAt(setting.centre + lens.distance * direction, setting.centre);
    out.push_back(std::move(view));
  }
  return out;
}

// Where a camera stands, as a direction from the surface.
Eigen::Vector3d StandOf(const Camera& camera, const Eigen::Vector3d& middle) {
  const CameraAxes axes = AxesOf(camera);
  if (camera.type == CameraType::kOrthographic) {
    return axes.world_from_camera.col(2);
  }
  return (axes.centre - middle).normalized();
}

}  // namespace

StatusOr<std::vector<CalibratedView>> LoadCandidates(
    const std::string& text, const CandidateSetting& setting, UpAxis up) {
  const std::string sphere = "sphere:";
  const std::string range = " from 1 to " + std::to_string(kMostCandidates);
  if (text.rfind(sphere, 0) == 0) {
    const std::string digits = text.substr(sphere.size());
    const bool whole =
        !digits.empty() && digits.size() <= 6 &&
        std::all_of(digits.begin(), digits.end(),
                    [](unsigned char c) { return c >= '0' && c <= '9'; });
    const int count = whole ? std::stoi(digits) : 0;
    if (count < 1 || count > kMostCandidates) {
      return InvalidInput(kOption, "expected sphere:N with N" + range +
                                       ", found '" + text + "'");
    }
    return SphereCandidates(count, setting);
  }
  const bool colmap = std::filesystem::is_directory(text);
  StatusOr<std::vector<CalibratedView>> views =
      ReadCalibratedViews(colmap ? "" : text, colmap ? text : "", up);
  if (views.ok() && views->size() > kMostCandidates) {
    return InvalidInput(kOption, "expected cameras" + range + ", found " +
                                     std::to_string(views->size()));
  }
  return views;
}

StatusOr<SizedCamera> CandidateCamera(const CalibratedView& candidate,
                                      double aspect, int short_side) {
  if (candidate.height > 0.0) aspect = candidate.width / candidate.height;
  const auto longer = [&](double ratio) {
    return static_cast<int>(std::lround(ratio * short_side));
  };
  SizedCamera out;
  out.width = aspect > 1.0 ? longer(aspect) : short_side;
  out.height = aspect > 1.0 ? short_side : longer(1.0 / aspect);
  const StatusOr<Camera> camera = CameraOf(candidate, out.width, out.height);
  if (!camera.ok()) return camera.status();
  out.camera = *camera;
  return out;
}

std::vector<int> FarthestCandidates(
    const std::vector<CalibratedView>& candidates,
    const std::vector<SizedCamera>& photographs, const Eigen::Vector3d& middle,
    int count) {
  std::vector<Eigen::Vector3d> stands;
  std::vector<int> photographed;
  for (const SizedCamera& view : photographs) {
    photographed.push_back(static_cast<int>(stands.size()));
    stands.push_back(StandOf(view.camera, middle));
  }
  for (const CalibratedView& candidate : candidates) {
    stands.push_back(
        (candidate.world_from_camera.topRightCorner<3, 1>() - middle)
            .normalized());
  }
  const int num_photographed = static_cast<int>(photographed.size());
  std::vector<int> taken =
      FarthestPoints(stands, photographed, num_photographed + count);
  taken.erase(taken.begin(), taken.begin() + num_photographed);
  for (int& view : taken) view -= num_photographed;
  return taken;
}

std::string NextViewsText(const std::vector<CalibratedView>& candidates,
                          const std::vector<int>& chosen, UpAxis up) {
  std::vector<CalibratedView> views;
  for (const int i : chosen) {
    views.push_back(candidates[i]);
    Eigen::Matrix4d& pose = views.back().world_from_camera;
    pose = Turned(pose, YUpFrom(up).transpose());
  }
  return TransformsText(views);
}

}  // namespace ibrdf
