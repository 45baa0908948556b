// SPDX-License-Identifier: BSD-3-Clause
#include "RayCaster.h"

#include <limits>
#include <stdexcept>

#include "EmbreeApi.h"

namespace lintel {

struct RayCaster::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

namespace {

void setCorner(float* vertices, std::size_t index, const Eigen::Vector3d& p) {
  for (int i = 0; i < 3; ++i) vertices[3 * index + static_cast<std::size_t>(i)] = static_cast<float>(p[i]);
}

RTCGeometry quadsOf(RTCDevice device, const Scene& scene) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  const std::size_t n = scene.patches.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * n));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), n));
  if (!vertices || !indices) throw std::runtime_error("Embree: no memory for the scene");
  for (std::size_t i = 0; i < n; ++i) {
    const Patch& p = scene.patches[i];
    const Eigen::Vector3d u = p.corner + p.edge_u, v = p.corner + p.edge_v;
    setCorner(vertices, 4 * i, p.corner);
    setCorner(vertices, 4 * i + 1, u);
    setCorner(vertices, 4 * i + 2,
              p.triangle ? v : Eigen::Vector3d(u + p.edge_v));  // a quad with two equal corners is a triangle
    setCorner(vertices, 4 * i + 3, v);
    for (unsigned k = 0; k < 4; ++k) indices[4 * i + k] = static_cast<unsigned>(4 * i) + k;
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace

RayCaster::RayCaster(const Scene& scene) : embree_(std::make_unique<Embree>()) {
  if (scene.patches.empty()) throw std::invalid_argument("RayCaster: an empty scene");
  embree_->device = rtcNewDevice("threads=1");  // a small scene; the same tree every time
  if (!embree_->device) throw std::runtime_error("Embree: no device");
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between neighbouring patches
  RTCGeometry geometry = quadsOf(embree_->device, scene);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
  if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE) throw std::runtime_error("Embree: the scene was refused");
}

RayCaster::~RayCaster() = default;

void RayCaster::cast(const Eigen::Vector3f& origin, const Packet& directions, std::array<RayHit, kPacket>& hits) const {
  alignas(32) const int valid[kPacket] = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCRayHit8 query;
  for (int i = 0; i < kPacket; ++i) {
    query.ray.org_x[i] = origin.x();
    query.ray.org_y[i] = origin.y();
    query.ray.org_z[i] = origin.z();
    query.ray.dir_x[i] = directions.x[i];
    query.ray.dir_y[i] = directions.y[i];
    query.ray.dir_z[i] = directions.z[i];
    query.ray.tnear[i] = 0.02f;
    query.ray.tfar[i] = std::numeric_limits<float>::infinity();
    query.ray.time[i] = 0;
    query.ray.mask[i] = ~0u;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  intersectPacket(valid, embree_->scene, query);
  for (int i = 0; i < kPacket; ++i) {
    if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
      hits[i] = {};
    } else {
      hits[i] = {static_cast<int>(query.hit.primID[i]), query.hit.u[i], query.hit.v[i], query.ray.tfar[i]};
    }
  }
}

bool RayCaster::occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance_m) const {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  if (length <= 2 * tolerance_m) return false;
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(way.x() / length);
  ray.dir_y = static_cast<float>(way.y() / length);
  ray.dir_z = static_cast<float>(way.z() / length);
  ray.tnear = static_cast<float>(tolerance_m);
  ray.tfar = static_cast<float>(length - tolerance_m);
  ray.mask = ~0u;
  testOcclusion(embree_->scene, ray);
  return ray.tfar < 0;
}

}  // namespace lintel
