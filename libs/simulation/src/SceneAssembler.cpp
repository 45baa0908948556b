// SPDX-License-Identifier: BSD-3-Clause
#include "SceneAssembler.h"

#include <Eigen/LU>
#include <array>

#include "lintel/geometry/Rotation.h"

namespace lintel {

using Eigen::Vector3d;

namespace {

struct Plane {
  Vector3d point, normal;  // normal into the room
};

Vector3d meet(const Plane& a, const Plane& b, const Plane& c) {
  Eigen::Matrix3d N;
  N << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  return N.inverse() * Vector3d(a.normal.dot(a.point), b.normal.dot(b.point), c.normal.dot(c.point));
}

}  // namespace

SceneAssembler::SceneAssembler(const SceneRequest& request) : request_(request), random_(request.seed, 0x7363656e65) {}

int SceneAssembler::material(Pattern pattern, double albedo, double tile_m, int resolution_px) {
  scene_.materials.push_back({pattern, albedo, tile_m, resolution_px, random_.bits()});
  return static_cast<int>(scene_.materials.size()) - 1;
}

void SceneAssembler::patch(const Vector3d& corner, const Vector3d& u, const Vector3d& v, int material, double tint,
                           bool triangle) {
  const double s = random_.uniform(0, 8), t = random_.uniform(0, 8);
  scene_.patches.push_back({corner, u, v, triangle, material, tint, {s, t}});
}

void SceneAssembler::poster(const Vector3d& corner, const Vector3d& u, const Vector3d& v, double albedo,
                            const std::string& kind) {
  const double side = std::max(u.norm(), v.norm());
  const int picture = material(Pattern::kPoster, albedo, side, 512);
  scene_.patches.push_back({corner, u, v, false, picture, 1.0, {0, 0}});
  line(corner, corner + u, kind);
  line(corner + v, corner + u + v, kind);
  line(corner, corner + v, kind);
  line(corner + u, corner + u + v, kind);
}

void SceneAssembler::line(const Vector3d& a, const Vector3d& b, const std::string& kind) {
  scene_.lines.push_back({{a, b}, kind});
}

bool SceneAssembler::inTheWay(const Pose& T_w_l, const Vector3d& low, const Vector3d& high) const {
  const Pose T_l_w = T_w_l.inverse();
  const Eigen::AlignedBox3d box(low, high);
  for (const Vector3d& p_w : request_.path) {
    if (box.exteriorDistance(T_l_w * p_w) < request_.clearance_m) return true;
  }
  return false;
}

bool SceneAssembler::box(const Pose& T_w_l, const Vector3d& size, int material, const std::string& kind, double tint) {
  const Vector3d half = 0.5 * size;
  if (inTheWay(T_w_l, -half, half)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const Vector3d eb = Vector3d::Unit(b) * size[b], ec = Vector3d::Unit(c) * size[c];
    Vector3d upper = -half;
    upper[axis] = half[axis];
    patch(T_w_l * upper, T_w_l.q * eb, T_w_l.q * ec, material, tint);
    patch(T_w_l * Vector3d(-half), T_w_l.q * ec, T_w_l.q * eb, material, tint);
    for (int edge = 0; edge < 4; ++edge) {
      Vector3d from = -half, to;
      if (edge & 1) from[b] = half[b];
      if (edge & 2) from[c] = half[c];
      to = from;
      to[axis] = half[axis];
      line(T_w_l * from, T_w_l * to, kind);
    }
  }
  return true;
}

bool SceneAssembler::box(const Vector3d& low, const Vector3d& high, int material, const std::string& kind,
                         double tint) {
  return box(Pose{Eigen::Quaterniond::Identity(), 0.5 * (low + high)}, high - low, material, kind, tint);
}

bool SceneAssembler::bar(const Vector3d& a, const Vector3d& b, double thickness, int material, const std::string& kind,
                         double tint) {
  const Pose T_w_l{rotationBetween(Vector3d::UnitX(), b - a), 0.5 * (a + b)};
  return box(T_w_l, {(b - a).norm(), thickness, thickness}, material, kind, tint);
}

bool SceneAssembler::ramp(const Pose& T_w_l, const Vector3d& size, int material, const std::string& kind) {
  if (inTheWay(T_w_l, {0, 0, 0}, size)) return false;
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  const auto& R = T_w_l.q;
  patch(T_w_l * Vector3d::Zero(), R * (x + z), R * y, material);   // the slope
  patch(T_w_l * x, R * y, R * z, material);                        // the high end
  patch(T_w_l * x, R * z, R * Vector3d(-x), material, 0.9, true);  // sides
  patch(T_w_l * Vector3d(x + y), R * Vector3d(-x), R * z, material, 0.9, true);
  const std::array<Vector3d, 6> p{T_w_l * Vector3d::Zero(), T_w_l * x,
                                  T_w_l * Vector3d(x + z),  T_w_l * y,
                                  T_w_l * Vector3d(x + y),  T_w_l * Vector3d(x + y + z)};
  for (int i = 0; i < 3; ++i) {
    line(p[i], p[(i + 1) % 3], kind);
    line(p[3 + i], p[3 + (i + 1) % 3], kind);
    line(p[i], p[3 + i], kind);
  }
  return true;
}

void SceneAssembler::shell(int wall_material, int floor_material, int ceiling_material, double skew_rad) {
  const Vector3d low = hull().min(), high = hull().max(), middle = hull().center(), size = hull().sizes();
  std::array<Plane, 4> walls;  // counter-clockwise, from x high
  const std::array<Vector3d, 4> outward{Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitX(), -Vector3d::UnitY()};
  for (int i = 0; i < 4; ++i) {
    const double turn = uniform(-skew_rad, skew_rad), tilt = uniform(0, skew_rad);
    const Vector3d along = Vector3d::UnitZ().cross(outward[i]);
    const Eigen::Quaterniond R = expRotation(turn * Vector3d::UnitZ()) * expRotation(-tilt * along);
    const double reach = std::abs(outward[i].dot(0.5 * size)) * (1 + skew_rad);  // skewed walls must not cut the volume
    walls[i] = {middle + reach * outward[i], R * Vector3d(-outward[i])};
  }
  const Plane floor{low, Vector3d::UnitZ()}, ceiling{high, -Vector3d::UnitZ()};
  const double beyond = 0.4 * size.norm();  // surfaces overlap behind the edges, where they are hidden
  for (int i = 0; i < 4; ++i) {
    const Plane &before = walls[(i + 3) % 4], &after = walls[(i + 1) % 4];
    const Vector3d a = meet(walls[i], before, floor), b = meet(walls[i], after, floor);
    const Vector3d c = meet(walls[i], before, ceiling), d = meet(walls[i], after, ceiling);
    const Vector3d along = (b - a).normalized(), up = along.cross(walls[i].normal).normalized();
    const double length = (b - a).norm() + 2 * beyond, height = (c - a).norm() + 1;
    patch(a - beyond * along - 0.5 * up, up * height, along * length, wall_material);
    line(a, b, "hull");
    line(c, d, "hull");
    line(b, d, "hull");
  }
  const Vector3d corner = low - Vector3d(beyond, beyond, 0);
  const Vector3d x((size.x() + 2 * beyond), 0, 0), y(0, size.y() + 2 * beyond, 0);
  if (floor_material >= 0) patch(corner, x, y, floor_material);
  patch({corner.x(), corner.y(), high.z()}, y, x, ceiling_material);
}

}  // namespace lintel
