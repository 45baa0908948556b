// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SurfaceDistance.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Dense>
#include <array>
#include <assimp/Importer.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "EmbreeApi.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

namespace {

constexpr float kFarthest_m = 10;

using Triangle = std::array<Eigen::Vector3d, 3>;

std::vector<Triangle> readTriangles(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr)
    throw std::runtime_error(path + ": is no mesh that can be read (" + importer.GetErrorString() +
                             "); give the true surfaces as PLY");
  std::vector<Triangle> triangles;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3) continue;
      Triangle triangle;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& v = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
        triangle[k] = {v.x, v.y, v.z};
      }
      triangles.push_back(triangle);
    }
  }
  if (triangles.empty()) throw std::runtime_error(path + ": holds no triangles; give the true surfaces as PLY");
  return triangles;
}

/// To the plane where the foot of the perpendicular lies in the triangle, else to the nearest side.
double distanceTo(const Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = normal.squaredNorm() > 0;
  double nearest_side = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = t[k], &b = t[(k + 1) % 3];
    inside = inside && (b - a).cross(p - a).dot(normal) >= 0;
    const double distance = a == b ? (p - a).norm() : distanceToSegment(p, {a, b});
    nearest_side = std::min(nearest_side, distance);
  }
  return inside ? std::abs((p - t[0]).dot(normal)) / normal.norm() : nearest_side;
}

}  // namespace

/// Embree finds the triangles near a point; how far they are is computed here.
class SurfaceDistance::Impl {
 public:
  explicit Impl(std::vector<Triangle> triangles)
      : triangles_(std::move(triangles)), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), 3 * triangles_.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), triangles_.size()));
    if (!vertices || !indices) throw std::runtime_error("Embree: no memory for the true surfaces");
    for (std::size_t i = 0; i < 3 * triangles_.size(); ++i) {
      indices[i] = static_cast<unsigned>(i);
      for (int k = 0; k < 3; ++k)
        vertices[3 * i + static_cast<std::size_t>(k)] = static_cast<float>(triangles_[i / 3][i % 3][k]);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Impl() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t triangles() const { return triangles_.size(); }

  double nearest(const Eigen::Vector3d& p) const {
    Search search{&triangles_, p, std::numeric_limits<double>::infinity()};
    RTCPointQuery query{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0,
                        kFarthest_m};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, &Impl::visit, &search);
    return search.nearest_m <= kFarthest_m ? search.nearest_m : std::numeric_limits<double>::infinity();
  }

 private:
  struct Search {
    const std::vector<Triangle>* triangles;
    Eigen::Vector3d p;
    double nearest_m;
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<Search*>(arguments->userPtr);
    const double distance_m = distanceTo((*search.triangles)[arguments->primID], search.p);
    if (distance_m >= search.nearest_m) return false;
    search.nearest_m = distance_m;
    const auto radius = static_cast<float>(distance_m * 1.0001 + 1e-6);  // floats round
    if (radius >= arguments->query->radius) return false;
    arguments->query->radius = radius;
    return true;
  }

  std::vector<Triangle> triangles_;
  RTCDevice device_;
  RTCScene scene_;
};

SurfaceDistance::SurfaceDistance(const std::string& mesh_file)
    : impl_(std::make_unique<Impl>(readTriangles(mesh_file))) {}
SurfaceDistance::~SurfaceDistance() = default;
std::size_t SurfaceDistance::triangles() const { return impl_->triangles(); }
double SurfaceDistance::operator()(const Eigen::Vector3d& p_w) const { return impl_->nearest(p_w); }

}  // namespace lintel
