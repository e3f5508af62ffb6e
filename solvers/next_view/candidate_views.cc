#include "ibrdf/solvers/uncertainty_map/candidate_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/problem/load_views.h"

namespace ibrdf {
namespace {

constexpr char kOption[] = "command line: --candidates";
// Of a lens where no photograph has one.
constexpr double kFovDegrees = 30.0;
// Of the distance at which all of the surface is just seen.
constexpr double kMargin = 1.1;

struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

Ball BallAround(const SurfaceAtlas& atlas) {
  Eigen::Vector3d low = atlas.texels[0].position, high = low;
  for (const SurfaceTexel& texel : atlas.texels) {
    low = low.cwiseMin(texel.position);
    high = high.cwiseMax(texel.position);
  }
  Ball ball{0.5 * (low + high), 0.0};
  for (const SurfaceTexel& texel : atlas.texels) {
    ball.radius = std::max(ball.radius, (texel.position - ball.centre).norm());
  }
  return ball;
}

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

SphereLens LensOf(const std::vector<PhotographedView>& views,
                  const Ball& ball) {
  SphereLens out;
  out.view.width = views[0].radiance.width;
  out.view.height = views[0].radiance.height;
  int pinholes = 0;
  for (const PhotographedView& view : views) {
    if (view.camera.type != CameraType::kPerspective) continue;
    out.distance += (AxesOf(view.camera).centre - ball.centre).norm();
    if (pinholes++ > 0) continue;
    out.view.width = view.radiance.width;
    out.view.height = view.radiance.height;
    const PixelGrid grid =
        PixelGridOf(view.camera, view.radiance.width, view.radiance.height);
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
  out.distance = kMargin * ball.radius / std::sin(half);
  return out;
}

std::vector<CalibratedView> SphereCandidates(int count,
                                             const UncertaintyInputs& inputs) {
  const Ball ball = BallAround(inputs.surface.atlas);
  const SphereLens lens = LensOf(inputs.views, ball);
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
        LookAt(ball.centre + lens.distance * direction, ball.centre);
    out.push_back(std::move(view));
  }
  return out;
}

}  // namespace

StatusOr<std::vector<CalibratedView>> LoadCandidates(
    const std::string& text, const UncertaintyInputs& inputs, UpAxis up) {
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
    return SphereCandidates(count, inputs);
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

}  // namespace ibrdf
