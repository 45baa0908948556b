// SPDX-License-Identifier: BSD-3-Clause
#include "Furniture.h"
#include "Scenes.h"

namespace lintel {

using Eigen::Vector3d;

namespace {

void runAlong(SceneAssembler& s, const WallFrame& wall, int dark, int light) {
  wallBox(s, wall, {0, 0, 0}, {wall.length_m, 0.1, 0.015}, dark, "skirting");
  wallBox(s, wall, {0, 0.92, 0}, {wall.length_m, 1.04, 0.03}, dark, "rail");
  wallBox(s, wall, {0, 1.5, 0}, {wall.length_m, 1.56, 0.003}, dark, "stripe", 1.3);
  wallBox(s, wall, {0, wall.height_m - 0.35, 0}, {wall.length_m, wall.height_m - 0.22, 0.12}, light, "duct");
}

void door(SceneAssembler& s, const WallFrame& wall, double x, int frame, int leaf) {
  wallBox(s, wall, {x, 0, 0}, {x + 0.1, 2.1, 0.06}, frame, "frame");
  wallBox(s, wall, {x + 1.0, 0, 0}, {x + 1.1, 2.1, 0.06}, frame, "frame");
  wallBox(s, wall, {x, 2.1, 0}, {x + 1.1, 2.2, 0.06}, frame, "frame");
  wallBox(s, wall, {x + 0.1, 0.01, 0}, {x + 1.0, 2.1, 0.035}, leaf, "door", s.uniform(0.8, 1.2));
}

}  // namespace

Scene buildCorridor(const SceneRequest& request) {
  SceneAssembler s(request);
  const int wall = s.material(Pattern::kPaint, 0.62), floor = s.material(Pattern::kPaint, 0.35);
  const int ceiling = s.material(Pattern::kPaint, 0.7), dark = s.material(Pattern::kPaint, 0.22, 2, 512);
  const int light = s.material(Pattern::kPaint, 0.85, 2, 512), lamp = s.material(Pattern::kPaint, 1.6, 2, 512);
  const int wood = s.material(Pattern::kWood, 0.35, 2, 512);
  s.shell(wall, floor, ceiling, 0);
  const auto walls = wallFrames(s.hull());
  for (const WallFrame& w : walls) {
    runAlong(s, w, dark, light);
    for (double x = s.uniform(0.8, 2.0); x + 1.5 < w.length_m; x += s.uniform(2.8, 4.2)) {
      door(s, w, x, light, wood);
      if (s.random().uniform() < 0.35) picture(s, w, x + 1.4, 1.65, 0.5, 0.4, dark);  // few, so that points are scarce
    }
  }
  const Vector3d low = s.hull().min(), high = s.hull().max(), middle = s.hull().center();
  for (const double side : {-0.28, 0.28}) {
    const double y = middle.y() + side * s.hull().sizes().y();
    s.box({low.x(), y - 0.04, low.z()}, {high.x(), y + 0.04, low.z() + 0.003}, light, "stripe");
  }
  for (double x = low.x() + 1.5; x < high.x() - 1.5; x += 3) {
    s.box({x, middle.y() - 0.15, high.z() - 0.05}, {x + 1.2, middle.y() + 0.15, high.z()}, lamp, "lamp");
    s.lamp({x + 0.6, middle.y(), high.z() - 0.4}, 0.7);
  }
  s.ambient(0.4);
  return s.finish();
}

}  // namespace lintel
