#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/approximation/gaussian_transport.h"
#include "ibrdf/approximation/harmonic_transport.h"
#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/render/reference_radiance.h"
#include "ibrdf/render/reference_renderer.h"

namespace ibrdf {
namespace {

constexpr double kPreviewError = 3e-3;
constexpr int kRounds = 2;
// Points that errors are found at, others than those that RenderByNormal holds
// out; points whose time stands for all.
constexpr size_t kFew = 200, kTimed = 1024;
constexpr int kOrders[] = {2, 4, 8};
constexpr int kSpreads[] = {64, 128, 256};

// Points of 128x128 pixels, one each, seen from far away or from 4 radii.
std::vector<ShadingPoint> Points(const Scene& scene, bool perspective) {
  if (!perspective) return PointsByAngle(scene, 128, 1);
  Camera camera;
  camera.type = CameraType::kPerspective;
  return FindShadingPoints(scene, camera, 128, 128, Mask(), 1).value();
}

// One thread.
class Tiers {
 public:
  Tiers(const Light& light, const Look& look)
      : map_(light.map), table_(look.table) {
    ReferenceOptions options = Coarser({});
    options.num_threads = 1;
    preview_ = std::make_unique<ReferenceRenderer>(map_, options);
    grid_ = BrdfGrid::FromMerl(table_, {});
  }

  void Quadrature(const std::vector<ShadingPoint>& points, double* L_o) const {
    preview_->Render(points, table_, L_o);
  }
  void ByNormal(const std::vector<ShadingPoint>& points, double* L_o) const {
    ReflectanceMapOptions options;
    options.log_error = kPreviewError;
    RenderByNormal(points, ReferenceRadiance(*preview_, table_), {}, options,
                   L_o)
        .value();
  }
  void Harmonics(int order, const std::vector<ShadingPoint>& points,
                 double* L_o) const {
    HarmonicOptions options;
    options.order = order;
    options.view_angles = 24;
    options.num_threads = 1;
    HarmonicTransport(points, map_.height, map_.width, options)
        .Render(grid_, map_.rgb.data(), L_o);
  }
  // The fit, the tables and the points.
  void Gaussians(int spread, const std::vector<ShadingPoint>& points,
                 double* L_o) const {
    GaussianFitOptions fit;
    fit.spread = spread;
    GaussianOptions options;
    options.num_threads = 1;
    const GaussianLight light(map_, fit);
    const GaussianTransport transport(light.lobes(), options);
    const GaussianTransport::Tables tables = transport.Tabulate(
        [this](double theta_h, double theta_d, double phi_d) {
          return InterpolateMerl(table_, theta_h, theta_d, phi_d);
        });
    transport.Render(points, tables, light.Fit(map_.rgb.data()), L_o);
  }

 private:
  const Image& map_;
  const MerlTable& table_;
  std::unique_ptr<const ReferenceRenderer> preview_;
  BrdfGrid grid_;
};

struct Way {
  std::string name;
  std::function<void(const std::vector<ShadingPoint>&, double*)> render;
  double seconds = 1e300;  // of the image
};

// An orthographic camera's points may be rendered by their normal. The tiers
// must outlive the ways.
std::vector<Way> Ways(const Tiers& tiers, bool perspective) {
  std::vector<Way> ways = {
      {"quadrature", [&tiers](const auto& some, double* L_o) {
         tiers.Quadrature(some, L_o);
       }}};
  if (!perspective) {
    ways.push_back({"by_normal", [&tiers](const auto& some, double* L_o) {
                      tiers.ByNormal(some, L_o);
                    }});
  }
  for (const int order : kOrders) {
    ways.push_back({"order_" + std::to_string(order),
                    [&tiers, order](const auto& some, double* L_o) {
                      tiers.Harmonics(order, some, L_o);
                    }});
  }
  for (const int spread : kSpreads) {
    ways.push_back({"gaussians_" + std::to_string(spread),
                    [&tiers, spread](const auto& some, double* L_o) {
                      tiers.Gaussians(spread, some, L_o);
                    }});
  }
  return ways;
}

// The ways take turns. The quadrature takes every point alike, so that some
// stand for all.
void TimeWays(const std::vector<ShadingPoint>& points, std::vector<Way>* ways) {
  std::vector<double> L_o(3 * points.size());
  const std::vector<ShadingPoint> timed = SpreadPoints(points, kTimed);
  for (int round = 0; round < kRounds; ++round) {
    for (Way& way : *ways) {
      const bool all = way.name != "quadrature";
      const double seconds =
          Seconds([&] { way.render(all ? points : timed, L_o.data()); });
      way.seconds = std::min(
          way.seconds, all ? seconds
                           : seconds * static_cast<double>(points.size()) /
                                 static_cast<double>(timed.size()));
    }
  }
}

// L_o [few, 3] of some of the points.
std::vector<double> RenderFew(const Way& way,
                              const std::vector<ShadingPoint>& points,
                              const std::vector<ShadingPoint>& few) {
  std::vector<double> at_few(3 * few.size());
  if (way.name != "by_normal") {
    way.render(few, at_few.data());
    return at_few;
  }
  // Few points are not interpolated.
  std::vector<double> L_o(3 * points.size());
  way.render(points, L_o.data());
  for (size_t k = 0, i = 0; k < few.size(); ++k) {
    while (points[i].index != few[k].index) ++i;
    std::copy_n(&L_o[3 * i], 3, &at_few[3 * k]);
  }
  return at_few;
}

void StudyImage(const std::string& name,
                const std::vector<ShadingPoint>& points, const Light& light,
                const Look& look, bool perspective) {
  const Tiers tiers(light, look);
  std::vector<Way> ways = Ways(tiers, perspective);
  const std::vector<ShadingPoint> few = SpreadPoints(points, kFew);
  std::vector<double> truth(3 * few.size());
  ReferenceRenderer(light.map, {}).Render(few, look.table, truth.data());
  TimeWays(points, &ways);
  Row("gaussians", name, "points", static_cast<double>(points.size()));
  for (const Way& way : ways) {
    Row("gaussians", name, way.name + "_log_error",
        LogError(RenderFew(way, points, few), truth));
    Row("gaussians", name, way.name + "_ms", 1e3 * way.seconds);
  }
}

}  // namespace

void GaussianStudy(const std::string& meshes) {
  std::vector<Look> looks = Materials();
  CookTorrance rough;
  rough.roughness = Eigen::Array3d::Constant(0.4);
  looks.insert(looks.begin() + 1, {"rough_0.4", SampleMerl(rough.Function())});
  for (const char* shape : {"sphere", "spot_low_resolution"}) {
    const Scene scene = LoadShape(meshes, shape);
    for (const bool perspective : {false, true}) {
      const std::vector<ShadingPoint> points = Points(scene, perspective);
      for (const Light& light : Lights()) {
        for (const Look& look : looks) {
          StudyImage(std::string(shape) +
                         (perspective ? " perspective " : " orthographic ") +
                         look.name + " " + light.name,
                     points, light, look, perspective);
        }
      }
    }
  }
}

}  // namespace ibrdf
