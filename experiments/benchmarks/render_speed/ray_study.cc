#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/visibility/visibility_grid.h"

namespace ibrdf {
namespace {

constexpr int kRounds = 5;
constexpr int kPoints = 256;

// Embree by itself with the triangles and the settings of Scene.
class PlainEmbree {
 public:
  explicit PlainEmbree(const TriangleMesh& mesh)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const std::array<int, 3>& t : mesh.triangles) {
      for (const int v : t) {
        low = low.cwiseMin(mesh.vertices[v].cast<double>());
        high = high.cwiseMax(mesh.vertices[v].cast<double>());
      }
    }
    center_ = 0.5 * (low + high);
    radius_ = 0.5 * (high - low).norm();
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
        3 * sizeof(float), mesh.vertices.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
        3 * sizeof(unsigned), mesh.triangles.size()));
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Eigen::Vector3d p = Local(mesh.vertices[v].cast<double>());
      for (int k = 0; k < 3; ++k) {
        vertices[3 * v + k] = static_cast<float>(p[k]);
      }
    }
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        indices[3 * t + k] = static_cast<unsigned>(mesh.triangles[t][k]);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  PlainEmbree(const PlainEmbree&) = delete;
  PlainEmbree& operator=(const PlainEmbree&) = delete;
  ~PlainEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  Eigen::Vector3d Local(const Eigen::Vector3d& p) const {
    return (p - center_) / radius_;
  }
  RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
  Eigen::Vector3d center_;
  double radius_ = 1.0;
};

struct ShadowRay {
  int point;
  Eigen::Vector3d direction;
};

// Rays of the lattice of VisibilityGrid above the horizon, by point.
std::vector<ShadowRay> LatticeRays(const std::vector<ShadingPoint>& points) {
  std::vector<ShadowRay> rays;
  for (size_t i = 0; i < points.size(); ++i) {
    for (int r = 0; r < 32; ++r) {
      for (int c = 0; c < 64; ++c) {
        const Eigen::Vector3d d = MapDirection(r + 0.5, c + 0.5, 32, 64);
        if (points[i].normal.cast<double>().dot(d) <= 0.0) continue;
        rays.push_back({static_cast<int>(i), d});
      }
    }
  }
  return rays;
}

template <typename Packet, int kSize>
void SetLane(const RTCRay& ray, int lane, Packet* packet) {
  packet->org_x[lane] = ray.org_x;
  packet->org_y[lane] = ray.org_y;
  packet->org_z[lane] = ray.org_z;
  packet->dir_x[lane] = ray.dir_x;
  packet->dir_y[lane] = ray.dir_y;
  packet->dir_z[lane] = ray.dir_z;
  packet->tnear[lane] = 0.0f;
  packet->time[lane] = 0.0f;
  packet->tfar[lane] = std::numeric_limits<float>::infinity();
  packet->mask[lane] = ~0u;
  packet->id[lane] = 0;
  packet->flags[lane] = 0;
}

// Packets of neighbouring rays; fills hidden [rays].
template <typename Packet, int kSize, typename Call>
void Packets(const std::vector<RTCRay>& rays, const Call& call,
             std::vector<char>* hidden) {
  alignas(64) Packet packet;
  alignas(64) int valid[kSize];
  for (size_t begin = 0; begin < rays.size(); begin += kSize) {
    const size_t count = std::min<size_t>(kSize, rays.size() - begin);
    for (int k = 0; k < kSize; ++k) {
      const bool used = static_cast<size_t>(k) < count;
      valid[k] = used ? -1 : 0;
      SetLane<Packet, kSize>(rays[begin + (used ? k : 0)], k, &packet);
    }
    call(valid, &packet);
    for (size_t k = 0; k < count; ++k) {
      (*hidden)[begin + k] = packet.tfar[k] < 0.0f ? 1 : 0;
    }
  }
}

std::vector<RTCRay> EmbreeRays(const PlainEmbree& plain,
                               const std::vector<ShadingPoint>& points,
                               const std::vector<ShadowRay>& list) {
  std::vector<RTCRay> rays(list.size());
  for (size_t k = 0; k < list.size(); ++k) {
    const Eigen::Vector3f o =
        plain.Local(points[list[k].point].position).cast<float>();
    const Eigen::Vector3f d = list[k].direction.cast<float>();
    RTCRay ray{};
    ray.org_x = o.x();
    ray.org_y = o.y();
    ray.org_z = o.z();
    ray.dir_x = d.x();
    ray.dir_y = d.y();
    ray.dir_z = d.z();
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    rays[k] = ray;
  }
  return rays;
}

// The rays of a shape in the library's form and in Embree's. Each function that
// fills hidden [rays] traces them in another way.
class ShapeRays {
 public:
  ShapeRays(const std::string& meshes, const std::string& name)
      : scene_(LoadShape(meshes, name)),
        plain_(LoadMesh(meshes, name)),
        points_(SpreadPoints(PointsByAngle(scene_, 128, 1), kPoints)),
        list_(LatticeRays(points_)),
        rays_(EmbreeRays(plain_, points_, list_)) {}

  const Scene& scene() const { return scene_; }
  const std::vector<ShadingPoint>& points() const { return points_; }
  size_t count() const { return rays_.size(); }

  void ByScene(std::vector<char>* hidden) const {
    for (size_t k = 0; k < count(); ++k) {
      (*hidden)[k] =
          scene_.Occluded(points_[list_[k].point].position, list_[k].direction)
              ? 1
              : 0;
    }
  }
  void Singly(std::vector<char>* hidden) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t k = 0; k < count(); ++k) {
      RTCRay ray = rays_[k];
      rtcOccluded1(plain_.scene(), &context, &ray);
      (*hidden)[k] = ray.tfar < 0.0f ? 1 : 0;
    }
  }
  void ByEight(std::vector<char>* hidden) const {
    RTCIntersectContext context = Coherent();
    Packets<RTCRay8, 8>(
        rays_,
        [&](const int* valid, RTCRay8* packet) {
          rtcOccluded8(valid, plain_.scene(), &context, packet);
        },
        hidden);
  }
  void BySixteen(std::vector<char>* hidden) const {
    RTCIntersectContext context = Coherent();
    Packets<RTCRay16, 16>(
        rays_,
        [&](const int* valid, RTCRay16* packet) {
          rtcOccluded16(valid, plain_.scene(), &context, packet);
        },
        hidden);
  }
  void ByStream(std::vector<char>* hidden) const {
    constexpr size_t kStream = 1024;
    RTCIntersectContext context = Coherent();
    std::vector<RTCRay> block;
    for (size_t k = 0; k < count(); k += kStream) {
      const size_t end = std::min(k + kStream, count());
      block.assign(rays_.begin() + k, rays_.begin() + end);
      rtcOccluded1M(plain_.scene(), &context, block.data(),
                    static_cast<unsigned>(end - k), sizeof(RTCRay));
      for (size_t i = k; i < end; ++i) {
        (*hidden)[i] = block[i - k].tfar < 0.0f ? 1 : 0;
      }
    }
  }

 private:
  static RTCIntersectContext Coherent() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
  }

  const Scene scene_;
  const PlainEmbree plain_;
  const std::vector<ShadingPoint> points_;
  const std::vector<ShadowRay> list_;
  const std::vector<RTCRay> rays_;
};

// One way to trace the rays, its answers and the least seconds of all rounds.
struct Way {
  std::string name;
  void (ShapeRays::*trace)(std::vector<char>*) const;
  std::vector<char> hidden = {};
  double seconds = std::numeric_limits<double>::infinity();

  double DiffersIn(const Way& other) const {
    double sum = 0.0;
    for (size_t k = 0; k < hidden.size(); ++k) {
      sum += hidden[k] != other.hidden[k] ? 1.0 : 0.0;
    }
    return sum;
  }
};

// The library's own traversal, which casts fewer rays.
struct GridTrace {
  int64_t rays = 0;
  double seconds = std::numeric_limits<double>::infinity();
};

// The ways and the grid take turns, round by round.
GridTrace TimeRounds(const ShapeRays& rays, std::vector<Way>* ways) {
  GridTrace trace;
  const VisibilityGrid grid(rays.scene(), 128);
  VisibilityGrid::Scratch scratch;
  VisibilityGrid::Bits bits;
  for (int round = 0; round < kRounds; ++round) {
    for (Way& way : *ways) {
      way.hidden.resize(rays.count());
      way.seconds = std::min(way.seconds,
                             Seconds([&] { (rays.*way.trace)(&way.hidden); }));
    }
    trace.seconds = std::min(trace.seconds, Seconds([&] {
                               trace.rays = 0;
                               for (const ShadingPoint& p : rays.points()) {
                                 grid.Trace(p, &scratch, &bits, &trace.rays);
                               }
                             }));
  }
  return trace;
}

void StudyShape(const std::string& meshes, const std::string& name) {
  const ShapeRays rays(meshes, name);
  std::vector<Way> ways = {{"scene_occluded", &ShapeRays::ByScene},
                           {"occluded1", &ShapeRays::Singly},
                           {"occluded8", &ShapeRays::ByEight},
                           {"occluded16", &ShapeRays::BySixteen},
                           {"occluded1M", &ShapeRays::ByStream}};
  const GridTrace trace = TimeRounds(rays, &ways);
  const auto rate = [&](const std::string& quantity, double seconds,
                        double number) {
    Row("rays", name, quantity + "_per_us", number / seconds * 1e-6);
  };
  const auto count = static_cast<double>(rays.count());
  const auto traced = static_cast<double>(trace.rays);
  Row("rays", name, "lattice_rays", count);
  rate(ways[0].name, ways[0].seconds, count);
  for (const int k : {1, 2, 3, 4}) {
    rate("embree_" + ways[k].name, ways[k].seconds, count);
  }
  rate("grid_trace", trace.seconds, traced);
  Row("rays", name, "rays_per_traced_point", traced / kPoints);
  for (const int k : {2, 3, 4, 1}) {
    Row("rays", name, ways[k].name + "_differs_in", ways[k].DiffersIn(ways[0]));
  }
}

}  // namespace

void RayStudy(const std::string& meshes) {
  for (const char* name :
       {"torus", "spot_low_resolution", "bunny", "armadillo"}) {
    StudyShape(meshes, name);
  }
}

}  // namespace ibrdf
