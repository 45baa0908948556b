// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>

#include "SceneAssembler.h"
#include "Scenes.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

using Eigen::Vector3d;

namespace {

Vector3d inside(SceneAssembler& s, double border) {
  const Vector3d low = s.hull().min(), high = s.hull().max();
  Vector3d p;
  for (int i = 0; i < 3; ++i) p[i] = s.uniform(low[i] + border, high[i] - border);
  return p;
}

/// A point on one of the walls.
Vector3d onWall(SceneAssembler& s) {
  Vector3d p = inside(s, 0.0);
  const int axis = s.random().index(2);
  p[axis] = s.random().index(2) ? s.hull().min()[axis] + 0.1 : s.hull().max()[axis] - 0.1;
  return p;
}

void fan(SceneAssembler& s, int material) {
  const Vector3d foot = onWall(s);
  for (int i = 0; i < 5; ++i)
    s.bar(foot, foot + s.uniform(1.2, 2.4) * s.random().direction(), 0.05, material, "fan", s.uniform(0.5, 1.5));
}

}  // namespace

Scene buildBraces(const SceneRequest& request) {
  SceneAssembler s(request);
  const int wall = s.material(Pattern::kPlaster, 0.5), floor = s.material(Pattern::kTerrazzo, 0.42);
  const int steel = s.material(Pattern::kPaint, 0.45, 2, 512), wood = s.material(Pattern::kWood, 0.5, 2, 512);
  const int carton = s.material(Pattern::kCarton, 0.5, 2);
  s.shell(wall, floor, wall, 0.16);
  for (int i = 0; i < 46; ++i) {
    const Vector3d a = onWall(s), b = a + s.uniform(1.0, 3.2) * s.random().direction();
    s.bar(a, b, s.uniform(0.05, 0.12), i % 2 ? steel : wood, "brace", s.uniform(0.4, 1.5));
  }
  for (int i = 0; i < 7; ++i) fan(s, steel);
  for (int i = 0; i < 26; ++i) {
    const Vector3d turn = s.uniform(0, 3) * s.random().direction();
    const Vector3d size(s.uniform(0.2, 0.6), s.uniform(0.2, 0.6), s.uniform(0.2, 0.6));
    s.box(Pose{expRotation(turn), onWall(s)}, size, carton, "box", s.uniform(0.5, 1.3));
  }
  for (int i = 0; i < 5; ++i) {
    Vector3d at = inside(s, 1.0);
    at.z() = s.hull().min().z();
    s.ramp(Pose{expRotation(s.uniform(-3, 3) * Vector3d::UnitZ()), at},
           {s.uniform(0.8, 1.5), s.uniform(0.5, 0.9), s.uniform(0.2, 0.6)}, wood, "ramp");
  }
  const Vector3d middle = s.hull().center(), size = s.hull().sizes();
  for (const double x : {-0.25, 0.25}) s.lamp({middle.x() + x * size.x(), middle.y(), s.hull().max().z() - 0.5}, 1.7);
  s.ambient(0.4);
  return s.finish();
}

}  // namespace lintel
