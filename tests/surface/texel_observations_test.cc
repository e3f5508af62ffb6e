#include "ibrdf/surface/texel_observations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/surface/charts.h"
#include "ibrdf/surface/prefiltered_map.h"
#include "tests/support/shapes.h"

namespace ibrdf {
namespace {

constexpr int kSize = 96;

Camera From(const Eigen::Vector3d& from) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = from;
  camera.fov_degrees = 40.0;
  return camera;
}

// Radiance that is a smooth function of the place on the surface.
Eigen::Array3f Paint(const Eigen::Vector3d& p) {
  return Eigen::Array3d(2.0 + p.x(), 2.0 + p.y() * p.z(), 2.0 - p.z())
      .cast<float>();
}

ObservedView Photograph(const Scene& scene, const Camera& camera) {
  ObservedView view;
  view.camera = camera;
  view.radiance = Image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Ray ray = CameraRay(camera, x + 0.5, y + 0.5, kSize, kSize);
      SurfaceHit hit;
      if (!scene.Intersect(ray, camera.type == CameraType::kOrthographic,
                           &hit)) {
        continue;
      }
      Eigen::Map<Eigen::Array3f>(view.radiance.At(x, y)) =
          Paint(ray.origin + hit.distance * ray.direction);
    }
  }
  return view;
}

// Light of one gradient.
Image Light() {
  Image map(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3d d = MapDirection(y + 0.5, x + 0.5, 32, 64);
      Eigen::Map<Eigen::Array3f>(map.At(x, y)) =
          (2.0 + d.array()).cast<float>();
    }
  }
  return map;
}

struct Object {
  Scene scene = Scene::UnitSphere();
  SurfaceAtlas atlas;
};

Object Sphere(int width) {
  return {Scene::UnitSphere(),
          SurfaceAtlas::OfSphere({0, 0, 0}, 1.0, width, width / 2)};
}

Object Torus(int size) {
  TriangleMesh mesh = TorusMesh(48, 24);
  AddCharts(&mesh);
  return {Scene::FromMesh(mesh).value(),
          SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, size, size).value()};
}

TexelObserver Observer(const Object& object, std::vector<ObservedView> views,
                       const ObserverOptions& options = {}) {
  return TexelObserver::Make(object.scene, object.atlas, std::move(views),
                             Light(), options)
      .value();
}

TexelObservations All(const TexelObserver& observer) {
  return observer.Observe(0,
                          static_cast<int64_t>(observer.atlas().texels.size()));
}

TEST(TexelObserver, SamplesAreWhatTheSurfaceSends) {
  for (const Object& object : {Sphere(40), Torus(64)}) {
    Camera square;  // orthographic
    std::vector<ObservedView> views;
    for (const Camera& camera :
         {From({0, 0, 5}), From({3, 3, 2}), From({-2, -4, 1}), square}) {
      views.push_back(Photograph(object.scene, camera));
    }
    const TexelObserver observer = Observer(object, views);
    const TexelObservations seen = All(observer);
    int samples = 0;
    for (int t = 0; t < seen.num_texels; ++t) {
      const SurfaceTexel& texel = object.atlas.texels[t];
      const Eigen::Array3f paint = Paint(texel.position);
      for (int k = 0; k < seen.num_views; ++k) {
        const size_t at = static_cast<size_t>(t) * seen.num_views + k;
        const Eigen::Array3f L =
            Eigen::Map<const Eigen::Array3f>(&seen.outgoing[3 * at]);
        if (seen.weight[at] == 0.0f) {
          EXPECT_TRUE((L == 0.0f).all());
          continue;
        }
        ++samples;
        EXPECT_EQ(1, seen.visible[at]);
        // Pixels are 0.05 wide, and the paint bends by 1 a unit.
        ASSERT_LT((L - paint).abs().maxCoeff(), 0.02f) << t << " " << k;
      }
    }
    // A view sees less than half of a surface, without its silhouettes; of the
    // torus the last one sees a part.
    EXPECT_GT(2 * samples, seen.num_texels);
    EXPECT_LT(samples, 2 * seen.num_texels);
  }
}

TEST(TexelObserver, DirectionsAndLightAreInTheTexelsFrame) {
  const Object object = Sphere(24);
  const Eigen::Vector3d from(1, 2, 4);
  const TexelObservations seen =
      All(Observer(object, {Photograph(object.scene, From(from))}));
  for (int t = 0; t < seen.num_texels; ++t) {
    const SurfaceTexel& texel = object.atlas.texels[t];
    const Eigen::Map<const Eigen::Vector3f> w(&seen.directions[3 * size_t(t)]);
    const Eigen::Vector3d world =
        (texel.tangent * w.x() + texel.bitangent * w.y() + texel.normal * w.z())
            .cast<double>();
    EXPECT_TRUE(world.isApprox((from - texel.position).normalized(), 1e-5));
    EXPECT_EQ(seen.visible[t] != 0, w.z() > 1e-3f);
    if (w.z() <= 1e-3f) continue;
    const Eigen::Vector3d n = texel.normal.cast<double>();
    const Eigen::Vector3d mirror = 2.0 * n.dot(world) * n - world;
    const Eigen::Array3f L =
        Eigen::Map<const Eigen::Array3f>(&seen.incoming[3 * size_t(t)]);
    // The map is bilinear between texels.
    EXPECT_LT((L - (2.0 + mirror.array()).cast<float>()).abs().maxCoeff(),
              5e-3f);
  }
}

TEST(TexelObserver, TheObjectHidesItself) {
  const Object object = Torus(80);
  const Eigen::Vector3d from(4, 0.4, 0);  // the far side is behind the near one
  ObserverOptions options;
  const TexelObservations seen =
      All(Observer(object, {Photograph(object.scene, From(from))}, options));
  options.shadowed_light = true;
  const TexelObservations shadowed =
      All(Observer(object, {Photograph(object.scene, From(from))}, options));
  int hidden = 0, dark = 0;
  for (int t = 0; t < seen.num_texels; ++t) {
    const SurfaceTexel& texel = object.atlas.texels[t];
    const bool above = seen.directions[3 * size_t(t) + 2] > 1e-3f;
    EXPECT_TRUE(above || seen.visible[t] == 0);
    hidden += above && seen.visible[t] == 0;
    dark += above && shadowed.incoming[3 * size_t(t)] == 0.0f &&
            seen.incoming[3 * size_t(t)] > 0.0f;
    if (seen.visible[t] == 0) continue;
    // The first thing on the way from the camera.
    const Eigen::Vector3d way = texel.position - from;
    SurfaceHit hit;
    if (object.scene.Intersect({from, way.normalized()}, false, &hit)) {
      EXPECT_GT(hit.distance, way.norm() - 0.02) << t;
    }
  }
  EXPECT_GT(hidden, seen.num_texels / 20);
  EXPECT_GT(dark, seen.num_texels / 20);
}

TEST(TexelObserver, WhatIsNoSampleIsLeftOut) {
  const Object object = Sphere(40);
  const ObservedView whole = Photograph(object.scene, From({0, 0, 5}));
  const auto count = [&](const ObservedView& view) {
    const TexelObservations seen = All(Observer(object, {view}));
    int samples = 0;
    for (const float w : seen.weight) samples += w > 0.0f;
    for (const float v : seen.outgoing) EXPECT_TRUE(std::isfinite(v));
    return samples;
  };
  const int all = count(whole);
  EXPECT_GT(all, 100);
  ObservedView masked = whole;
  masked.samples = Mask(kSize, kSize, 0);
  EXPECT_EQ(0, count(masked));
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize / 2; ++x) {
      masked.samples.inside[static_cast<size_t>(y) * kSize + x] = 1;
    }
  }
  EXPECT_NEAR(0.5 * all, count(masked), 0.1 * all);
  ObservedView broken = whole;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize / 2; ++x) {
      broken.radiance.At(x, y)[y % 3] =
          y % 2 == 0 ? -1.0f : std::numeric_limits<float>::infinity();
    }
  }
  EXPECT_EQ(count(masked) / 10, (count(broken) + 5) / 10);
}

// Pixels at an edge of the object, against the ground or itself, mix two
// surfaces.
TEST(TexelObserver, SilhouettesAreNoSamples) {
  const Object object = Torus(32);
  const TexelObserver observer =
      Observer(object, {Photograph(object.scene, From({4, 1, 0}))});
  const Mask& usable = observer.usable(0);
  int usable_count = 0, edges = 0;
  for (int y = 1; y + 1 < kSize; ++y) {
    for (int x = 1; x + 1 < kSize; ++x) {
      const auto distance = [&](int u, int v) {
        SurfaceHit hit;
        const Ray ray =
            CameraRay(From({4, 1, 0}), u + 0.5, v + 0.5, kSize, kSize);
        return object.scene.Intersect(ray, false, &hit) ? hit.distance : 1e3;
      };
      const bool in = usable.inside[static_cast<size_t>(y) * kSize + x] != 0;
      usable_count += in;
      double jump = 0.0;
      for (const auto& [u, v] :
           {std::pair(x - 1, y), {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
        jump = std::max(jump, std::abs(distance(u, v) - distance(x, y)));
      }
      // Half of the ring's thickness.
      if (jump > 0.4) {
        ++edges;
        EXPECT_FALSE(in) << x << " " << y;
      }
    }
  }
  EXPECT_GT(edges, 100);
  EXPECT_GT(usable_count, 500);
}

TEST(TexelObserver, BlocksAndThreadsMakeNoDifference) {
  const Object object = Torus(32);
  std::vector<ObservedView> views = {Photograph(object.scene, From({4, 1, 0})),
                                     Photograph(object.scene, From({0, 3, 3}))};
  ObserverOptions one;
  one.num_threads = 1;
  const TexelObservations whole = All(Observer(object, views, one));
  const TexelObserver observer = Observer(object, views);
  TexelObservations joined;
  for (int64_t begin = 0; begin < whole.num_texels; begin += 100) {
    const TexelObservations block = observer.Observe(
        begin, std::min<int64_t>(begin + 100, whole.num_texels));
    joined.directions.insert(joined.directions.end(), block.directions.begin(),
                             block.directions.end());
    joined.outgoing.insert(joined.outgoing.end(), block.outgoing.begin(),
                           block.outgoing.end());
    joined.incoming.insert(joined.incoming.end(), block.incoming.begin(),
                           block.incoming.end());
    joined.weight.insert(joined.weight.end(), block.weight.begin(),
                         block.weight.end());
  }
  EXPECT_EQ(whole.directions, joined.directions);
  EXPECT_EQ(whole.outgoing, joined.outgoing);
  EXPECT_EQ(whole.incoming, joined.incoming);
  EXPECT_EQ(whole.weight, joined.weight);
}

TEST(TexelObserver, RefusesBadViews) {
  const Object object = Sphere(8);
  const ObservedView good = Photograph(object.scene, From({0, 0, 5}));
  const auto error = [&](std::vector<ObservedView> views) {
    return TexelObserver::Make(object.scene, object.atlas, std::move(views),
                               Light(), {})
        .status()
        .message();
  };
  EXPECT_EQ("views: expected one or more", error({}));
  ObservedView bad = good;
  bad.camera.to = bad.camera.from;
  EXPECT_EQ("view 1: expected a valid camera", error({good, bad}));
  bad = good;
  bad.samples = Mask(3, 3, 1);
  EXPECT_EQ("view 0: expected an image, and a mask of its size", error({bad}));
}

}  // namespace
}  // namespace ibrdf
