// SPDX-License-Identifier: BSD-3-Clause
#include "Furniture.h"
#include "Scenes.h"

namespace lintel {

using Eigen::Vector3d;

namespace {

/// Girders across the hall on columns, with a zigzag between their chords.
void girders(SceneAssembler& s, int steel) {
  const Vector3d low = s.hull().min(), high = s.hull().max();
  for (double x = low.x() + 1.5; x < high.x() - 1; x += 3.4) {
    s.bar({x, low.y(), high.z() - 0.15}, {x, high.y(), high.z() - 0.15}, 0.14, steel, "beam");
    s.bar({x, low.y(), high.z() - 0.85}, {x, high.y(), high.z() - 0.85}, 0.12, steel, "beam");
    bool up = true;
    for (double y = low.y() + 0.2; y + 0.8 < high.y(); y += 0.8, up = !up) {
      s.bar({x, y, high.z() - (up ? 0.85 : 0.15)}, {x, y + 0.8, high.z() - (up ? 0.15 : 0.85)}, 0.06, steel, "truss");
    }
    for (const double y : {low.y() + 0.15, high.y() - 0.15}) {
      s.box({x - 0.15, y - 0.15, low.z()}, {x + 0.15, y + 0.15, high.z()}, steel, "column");
    }
  }
}

void conduits(SceneAssembler& s, const WallFrame& wall, int material) {
  for (const double y : {0.55, 0.62, 0.8}) {
    const double at = wall.height_m * y;
    wallBox(s, wall, {0.3, at, 0.05}, {wall.length_m - 0.3, at + 0.09, 0.14}, material, "pipe", s.uniform(0.6, 1.3));
  }
  wallBox(s, wall, {0, 1.1, 0}, {wall.length_m, 1.22, 0.004}, material, "stripe", 1.5);
}

}  // namespace

Scene buildHall(const SceneRequest& request) {
  SceneAssembler s(request);
  const int wall = s.material(Pattern::kPlaster, 0.45), floor = s.material(Pattern::kTerrazzo, 0.38);
  const int roof = s.material(Pattern::kPlaster, 0.35), steel = s.material(Pattern::kPaint, 0.5, 2, 512);
  const int wood = s.material(Pattern::kWood, 0.45, 2, 512), carton = s.material(Pattern::kCarton, 0.5, 2);
  s.shell(wall, floor, roof, 0);
  girders(s, steel);
  for (const WallFrame& w : wallFrames(s.hull())) {
    conduits(s, w, steel);
    for (double x = 0.8; x + 2.2 < w.length_m; x += 3.1) {
      shelf(s, w, x, 2.0, 2.3, 0.7, steel, carton);
      picture(s, w, x + 0.2, 2.45, 1.3, 0.8, wood);
    }
  }
  const Vector3d low = s.hull().min(), high = s.hull().max(), middle = s.hull().center(), size = s.hull().sizes();
  for (int i = 0; i < 26; ++i) {
    const double x = s.uniform(low.x() + 1.5, high.x() - 1.5), y = s.uniform(low.y() + 1.5, high.y() - 1.5);
    stack(s, {x, y}, s.uniform(0.6, 1.1), i % 3 ? wood : carton, "crate");
  }
  for (const double x : {-0.3, 0.0, 0.3}) {
    for (const double y : {-0.2, 0.2})
      s.lamp({middle.x() + x * size.x(), middle.y() + y * size.y(), high.z() - 1.0}, 4.0);
  }
  s.ambient(0.5);
  return s.finish();
}

}  // namespace lintel
