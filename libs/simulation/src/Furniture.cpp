// SPDX-License-Identifier: BSD-3-Clause
#include "Furniture.h"

#include <array>

#include "lintel/geometry/Rotation.h"

namespace lintel {

using Eigen::Vector3d;

std::array<WallFrame, 4> wallFrames(const Eigen::AlignedBox3d& hull) {
  const Vector3d &a = hull.min(), &b = hull.max();
  const Vector3d size = hull.sizes();
  const std::array<Vector3d, 4> corner{a, Vector3d(b.x(), a.y(), a.z()), Vector3d(b.x(), b.y(), a.z()),
                                       Vector3d(a.x(), b.y(), a.z())};
  std::array<WallFrame, 4> walls;
  for (int i = 0; i < 4; ++i) {
    // clockwise seen from above: only so x (along), y (up) and z (into the room) are right-handed
    const Vector3d& from = corner[(i + 1) % 4];
    const Vector3d along = (corner[i] - from).normalized();
    Eigen::Matrix3d R;
    R << along, Vector3d::UnitZ(), along.cross(Vector3d::UnitZ());
    walls[i] = {Pose{Eigen::Quaterniond(R), from}, i % 2 == 0 ? size.x() : size.y(), size.z()};
  }
  return walls;
}

bool wallBox(SceneAssembler& scene, const WallFrame& wall, const Vector3d& low, const Vector3d& high, int material,
             const std::string& kind, double tint) {
  return scene.box(wall.T_w_l * Pose{Eigen::Quaterniond::Identity(), 0.5 * (low + high)}, high - low, material, kind,
                   tint);
}

void plankFloor(SceneAssembler& scene, int material, double width_m) {
  const Vector3d low = scene.hull().min(), size = scene.hull().sizes();
  const int count = std::max(1, static_cast<int>(size.y() / width_m));
  const double width = size.y() / count;
  for (int i = 0; i < count; ++i) {
    const Vector3d corner = low + Vector3d(0, i * width, 0), along(size.x(), 0, 0);
    scene.patch(corner, along, {0, width, 0}, material, (i % 2 ? 0.82 : 1.08) * scene.uniform(0.92, 1.08));
    if (i > 0) scene.line(corner, corner + along, "plank");
  }
}

void window(SceneAssembler& scene, const WallFrame& wall, double x, double y, double width, double height, int frame,
            int pane) {
  const double bar = 0.07, depth = 0.06;
  wallBox(scene, wall, {x, y, -0.02}, {x + width, y + height, 0.015}, pane, "pane", 1.0);
  wallBox(scene, wall, {x - bar, y - bar, 0}, {x + width + bar, y, depth + 0.1}, frame,
          "frame");  // the sill stands out
  wallBox(scene, wall, {x - bar, y + height, 0}, {x + width + bar, y + height + bar, depth}, frame, "frame");
  wallBox(scene, wall, {x - bar, y, 0}, {x, y + height, depth}, frame, "frame");
  wallBox(scene, wall, {x + width, y, 0}, {x + width + bar, y + height, depth}, frame, "frame");
  const double middle = x + 0.5 * width;
  wallBox(scene, wall, {middle - 0.5 * bar, y, 0}, {middle + 0.5 * bar, y + height, 0.8 * depth}, frame, "frame");
}

void picture(SceneAssembler& scene, const WallFrame& wall, double x, double y, double width, double height, int frame) {
  const double depth = 0.025;
  if (!wallBox(scene, wall, {x - 0.04, y - 0.04, 0}, {x + width + 0.04, y + height + 0.04, depth}, frame, "frame"))
    return;
  const auto& R = wall.T_w_l.q;
  scene.poster(wall.T_w_l * Vector3d(x, y, depth + 0.002), R * Vector3d(width, 0, 0), R * Vector3d(0, height, 0),
               scene.uniform(0.4, 0.75), "poster");
}

void shelf(SceneAssembler& scene, const WallFrame& wall, double x, double width, double height, double depth, int board,
           int content) {
  const double t = 0.03;
  if (!wallBox(scene, wall, {x, 0, 0}, {x + t, height, depth}, board, "shelf")) return;
  wallBox(scene, wall, {x + width - t, 0, 0}, {x + width, height, depth}, board, "shelf");
  const int boards = std::max(2, static_cast<int>(height / 0.42));
  const double gap = (height - t) / boards;
  for (int i = 0; i <= boards; ++i) {
    const double y = i * gap;
    wallBox(scene, wall, {x + t, y, 0}, {x + width - t, y + t, depth}, board, "shelf", 1.1);
    if (i == boards) break;
    for (double at = x + t + 0.02; at < x + width - 0.2;) {
      const double w = scene.uniform(0.05, 0.3), h = gap * scene.uniform(0.45, 0.85),
                   d = depth * scene.uniform(0.5, 0.95);
      wallBox(scene, wall, {at, y + t, 0.01}, {std::min(at + w, x + width - t - 0.01), y + t + h, d}, content, "box",
              scene.uniform(0.35, 1.4));
      at += w + scene.uniform(0.005, 0.12);
    }
  }
}

void table(SceneAssembler& scene, const Eigen::Vector2d& at, double yaw_rad, int board, int things) {
  const Pose T_w_l{expRotation(yaw_rad * Vector3d::UnitZ()), {at.x(), at.y(), scene.hull().min().z()}};
  const auto put = [&](const Vector3d& middle, const Vector3d& size, int material, const char* kind, double tint,
                       double yaw) {
    return scene.box(T_w_l * Pose{expRotation(yaw * Vector3d::UnitZ()), middle}, size, material, kind, tint);
  };
  if (!put({0, 0, 0.73}, {1.4, 0.75, 0.04}, board, "table", 1.1, 0)) return;
  for (const double x : {-0.64, 0.64}) {
    for (const double y : {-0.32, 0.32}) put({x, y, 0.355}, {0.06, 0.06, 0.71}, board, "table", 0.8, 0);
  }
  for (int i = 0; i < 4; ++i) {
    const Vector3d size(scene.uniform(0.12, 0.3), scene.uniform(0.1, 0.25), scene.uniform(0.06, 0.3));
    const double y = scene.uniform(-0.15, 0.15), yaw = scene.uniform(-0.4, 0.4);
    put({-0.5 + 0.33 * i, y, 0.751 + 0.5 * size.z()}, size, things, "box", scene.uniform(0.4, 1.3), yaw);
  }
}

void stack(SceneAssembler& scene, const Eigen::Vector2d& at, double size_m, int material, const std::string& kind) {
  double z = scene.hull().min().z() + 0.001;
  const int count = 1 + scene.random().index(3);
  for (int i = 0; i < count; ++i) {
    const double x = size_m * scene.uniform(0.8, 1.2), y = size_m * scene.uniform(0.7, 1.1),
                 h = size_m * scene.uniform(0.5, 0.9);
    const double yaw = scene.uniform(-0.5, 0.5);
    const Pose T_w_l{expRotation(yaw * Vector3d::UnitZ()), {at.x(), at.y(), z + 0.5 * h}};
    if (!scene.box(T_w_l, {x, y, h}, material, kind, scene.uniform(0.6, 1.25))) return;
    z += h + 0.001;
    size_m *= 0.85;
  }
}

}  // namespace lintel
