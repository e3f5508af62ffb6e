#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

// Points that errors and times are taken of; times are scaled to the image.
constexpr int kPoints = 384;
constexpr int kSize = 256;
constexpr double kWanted = 0.01;
constexpr float kCosine70 = 0.34202014f;

struct Setting {
  int rings, far_width;
};
constexpr Setting kDefault = {20, 64};

// A shape under every light with every material. A case is a light and a
// material: its number is light * materials + material.
class Cases {
 public:
  Cases(const std::string& meshes, const std::string& shape)
      : shape_(shape),
        scene_(LoadShape(meshes, shape)),
        all_(PointsByAngle(scene_, kSize, 1)),
        points_(SpreadPoints(all_, kPoints)) {
    for (const Look& look : looks_) {
      grids_.push_back(BrdfGrid::FromMerl(look.table, {}));
    }
  }

  const std::string& shape() const { return shape_; }
  const Scene& scene() const { return scene_; }
  const std::vector<ShadingPoint>& points() const { return points_; }
  double image_points() const { return static_cast<double>(all_.size()); }
  // Seconds of the image, of a call for the points.
  double ImageSeconds(const std::function<void()>& call) const {
    return image_points() / kPoints * Seconds(call);
  }

  size_t count() const { return lights_.size() * looks_.size(); }
  const Image& map(size_t k) const { return lights_[k / looks_.size()].map; }
  const MerlTable& table(size_t k) const {
    return looks_[k % looks_.size()].table;
  }
  const BrdfGrid& grid(size_t k) const { return grids_[k % looks_.size()]; }
  std::string Name(size_t k) const {
    return shape_ + " " + looks_[k % looks_.size()].name + " " +
           lights_[k / looks_.size()].name;
  }

 private:
  const std::string shape_;
  const Scene scene_;
  const std::vector<ShadingPoint> all_, points_;
  const std::vector<Light> lights_ = Lights();
  const std::vector<Look> looks_ = Materials();
  std::vector<BrdfGrid> grids_;
};

// The grid must outlive the function.
BrdfFunction FunctionOf(const BrdfGrid& grid) {
  return [&grid](double theta_h, double theta_d, double phi_d) {
    return grid.Evaluate(theta_h, theta_d, phi_d);
  };
}

// The radiance [3] of the points that are seen at less than 70 degrees.
std::vector<double> Facing(const std::vector<ShadingPoint>& points,
                           const std::vector<double>& L_o) {
  std::vector<double> out;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].normal.dot(points[i].wo) < kCosine70) continue;
    out.insert(out.end(), &L_o[3 * i], &L_o[3 * i] + 3);
  }
  return out;
}

// The truth of a case: the reference with the grid for BRDF, so that what
// differs is the quadrature. The grid's own error is a row by itself.
std::vector<double> StudyReference(const Cases& cases, size_t k,
                                   const ReferenceRenderer& renderer) {
  const std::vector<ShadingPoint>& points = cases.points();
  const MerlTable& table = cases.table(k);
  const std::string name = cases.Name(k);
  std::vector<double> by_table(3 * points.size()), by_grid(by_table.size()),
      by_fine(by_table.size());
  const double seconds = cases.ImageSeconds(
      [&] { renderer.Render(points, table, by_table.data()); });
  Row("one_percent", name, "reference_seconds", seconds);
  renderer.Render(points, FunctionOf(cases.grid(k)), by_grid.data());
  Row("one_percent", name, "grid_log_error", LogError(by_grid, by_table));
  Row("one_percent", name, "grid_log_error_below_70_degrees",
      LogError(Facing(points, by_grid), Facing(points, by_table)));
  const BrdfGrid fine = BrdfGrid::FromMerl(table, {144, 64, 24});
  renderer.Render(points, FunctionOf(fine), by_fine.data());
  Row("one_percent", name, "fine_grid_log_error", LogError(by_fine, by_table));
  return by_grid;
}

// The truth of each case.
std::vector<std::vector<double>> StudyReferences(const Cases& cases) {
  ReferenceOptions options;
  if (cases.scene().CastsShadows()) {
    options.shadows =
        std::make_shared<VisibilityGrid>(cases.scene(), kReferenceShadowRows);
  }
  std::vector<std::vector<double>> truth;
  std::unique_ptr<const ReferenceRenderer> renderer;
  for (size_t k = 0; k < cases.count(); ++k) {
    // Cases of one light are neighbours and share its renderer.
    if (k == 0 || &cases.map(k) != &cases.map(k - 1)) {
      renderer = std::make_unique<ReferenceRenderer>(cases.map(k), options);
    }
    truth.push_back(StudyReference(cases, k, *renderer));
  }
  return truth;
}

struct Shadows {
  std::shared_ptr<const Visibility> visibility;  // null: the shape casts none
  double seconds = 0.0;
};

Shadows StudyRays(const Cases& cases) {
  Shadows shadows;
  if (cases.scene().CastsShadows()) {
    shadows.seconds = cases.ImageSeconds([&] {
      shadows.visibility = std::make_shared<Visibility>(
          cases.scene(), cases.points(), VisibilityOptions());
    });
  }
  Row("one_percent", cases.shape(), "points", cases.image_points());
  Row("one_percent", cases.shape(), "seconds_of_rays", shadows.seconds);
  return shadows;
}

// What a setting makes of a case.
struct Outcome {
  Setting setting{};
  double seconds = 0.0, render_seconds = 0.0, error = 0.0;
};

// The fastest that is good enough; else the most exact. `best`: of 0 seconds
// where nothing came before.
bool IsBetter(const Outcome& outcome, const Outcome& best) {
  if (best.seconds == 0.0) return true;
  const bool good = outcome.error <= kWanted;
  const bool was_good = best.error <= kWanted;
  return good ? !was_good || outcome.seconds < best.seconds
              : !was_good && outcome.error < best.error;
}

// The outcome of each case.
std::vector<Outcome> StudySetting(const Cases& cases,
                                  const std::vector<std::vector<double>>& truth,
                                  const Shadows& shadows,
                                  const Setting& setting) {
  TransportOptions options;
  options.quadrature.near_rings = setting.rings;
  options.quadrature.near_ring_samples = setting.rings * 56 / 20;
  options.quadrature.far_width = setting.far_width;
  options.visibility = shadows.visibility;
  const Image& map = cases.map(0);  // all have one size
  std::unique_ptr<Transport> transport;
  const double build = cases.ImageSeconds([&] {
    transport = std::make_unique<Transport>(cases.points(), map.height,
                                            map.width, options);
  });
  std::vector<double> L_o(3 * cases.points().size());
  std::vector<Outcome> outcomes;
  for (size_t k = 0; k < truth.size(); ++k) {
    const double render = cases.ImageSeconds([&] {
      transport->Render(cases.grid(k), cases.map(k).rgb.data(), L_o.data());
    });
    outcomes.push_back({setting, shadows.seconds + build + render, render,
                        LogError(L_o, truth[k])});
  }
  return outcomes;
}

// The best outcome of each case.
std::vector<Outcome> StudySettings(
    const Cases& cases, const std::vector<std::vector<double>>& truth,
    const Shadows& shadows) {
  std::vector<Outcome> best(truth.size());
  for (const int rings : {5, 10, 20, 40, 80}) {
    for (const int far_width : {16, 32, 64, 128, 256}) {
      const std::vector<Outcome> outcomes =
          StudySetting(cases, truth, shadows, {rings, far_width});
      for (size_t k = 0; k < outcomes.size(); ++k) {
        const Outcome& o = outcomes[k];
        if (IsBetter(o, best[k])) best[k] = o;
        if (rings != kDefault.rings || far_width != kDefault.far_width) {
          continue;
        }
        Row("one_percent", cases.Name(k), "default_log_error", o.error);
        Row("one_percent", cases.Name(k), "default_seconds", o.seconds);
      }
    }
  }
  return best;
}

void StudyShape(const std::string& meshes, const std::string& shape) {
  const Cases cases(meshes, shape);
  const std::vector<std::vector<double>> truth = StudyReferences(cases);
  const Shadows shadows = StudyRays(cases);
  const std::vector<Outcome> best = StudySettings(cases, truth, shadows);
  for (size_t k = 0; k < best.size(); ++k) {
    const std::string name = cases.Name(k);
    Row("one_percent", name, "best_rings", best[k].setting.rings);
    Row("one_percent", name, "best_far_width", best[k].setting.far_width);
    Row("one_percent", name, "best_log_error", best[k].error);
    Row("one_percent", name, "best_seconds", best[k].seconds);
    Row("one_percent", name, "best_seconds_of_render", best[k].render_seconds);
  }
}

}  // namespace

void OnePercentStudy(const std::string& meshes) {
  for (const char* shape :
       {"sphere", "torus", "spot_low_resolution", "bunny", "armadillo"}) {
    StudyShape(meshes, shape);
  }
}

}  // namespace ibrdf
