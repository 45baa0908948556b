// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "Furniture.h"
#include "Scenes.h"

namespace lintel {

using Eigen::Vector3d;

namespace {

struct RoomMaterials {
  int wall, ceiling, plank, wood, dark_wood, white, pane, carton;
};

RoomMaterials roomMaterials(SceneAssembler& s) {
  return {s.material(Pattern::kPlaster, 0.55),      s.material(Pattern::kPlaster, 0.7),
          s.material(Pattern::kWood, 0.42),         s.material(Pattern::kWood, 0.5, 2, 512),
          s.material(Pattern::kWood, 0.25, 2, 512), s.material(Pattern::kPaint, 0.85, 2, 512),
          s.material(Pattern::kPaint, 1.5, 2, 512), s.material(Pattern::kCarton, 0.45, 2)};
}

void ceilingBeams(SceneAssembler& s, int material) {
  const Vector3d low = s.hull().min(), high = s.hull().max();
  for (double x = low.x() + 0.8; x < high.x() - 0.4; x += 1.3) {
    s.box({x, low.y(), high.z() - 0.2}, {x + 0.14, high.y(), high.z()}, material, "beam", s.uniform(0.85, 1.15));
  }
}

/// Skirting and picture rail along the wall, then furniture and pictures in sections of about two metres.
void furnishWall(SceneAssembler& s, const WallFrame& wall, const RoomMaterials& m, int number) {
  wallBox(s, wall, {0, 0, 0}, {wall.length_m, 0.11, 0.02}, m.dark_wood, "skirting");
  wallBox(s, wall, {0, wall.height_m - 0.42, 0}, {wall.length_m, wall.height_m - 0.37, 0.03}, m.dark_wood, "rail");
  const int sections = std::max(1, static_cast<int>(wall.length_m / 1.9));
  const double width = wall.length_m / sections;
  for (int i = 0; i < sections; ++i) {
    const double x = i * width + 0.25, w = width - 0.5;
    switch ((i + 2 * number) % 4) {
      case 0:
        window(s, wall, x + 0.15, 1.0, w - 0.3, 1.3, m.white, m.pane);
        break;
      case 1:
        shelf(s, wall, x, w, 1.7, 0.32, m.wood, m.carton);
        picture(s, wall, x + 0.2, 1.95, w - 0.4, 0.7, m.dark_wood);
        break;
      case 2:
        picture(s, wall, x, 1.1, 0.45 * w, 0.9, m.white);
        picture(s, wall, x + 0.58 * w, 1.3, 0.4 * w, 0.6, m.dark_wood);
        wallBox(s, wall, {x, 0, 0}, {x + w, 0.55, 0.4}, m.wood, "cupboard");
        break;
      default:
        wallBox(s, wall, {x, 0, 0}, {x + 0.09, 2.1, 0.05}, m.white, "frame");  // a door
        wallBox(s, wall, {x + 0.95, 0, 0}, {x + 1.04, 2.1, 0.05}, m.white, "frame");
        wallBox(s, wall, {x, 2.1, 0}, {x + 1.04, 2.2, 0.05}, m.white, "frame");
        wallBox(s, wall, {x + 0.09, 0.01, 0}, {x + 0.95, 2.1, 0.015}, m.dark_wood, "door", 1.5);
        picture(s, wall, x + 0.25, 1.25, 0.5, 0.55, m.white);
    }
  }
}

}  // namespace

Scene buildRoom(const SceneRequest& request) {
  SceneAssembler s(request);
  const RoomMaterials m = roomMaterials(s);
  s.shell(m.wall, -1, m.ceiling, 0);
  plankFloor(s, m.plank, 0.32);
  ceilingBeams(s, m.dark_wood);
  const auto walls = wallFrames(s.hull());
  for (int i = 0; i < 4; ++i) furnishWall(s, walls[static_cast<std::size_t>(i)], m, i);
  const Vector3d low = s.hull().min(), high = s.hull().max(), middle = s.hull().center(), size = s.hull().sizes();
  table(s, {middle.x() - 0.1 * size.x(), middle.y()}, 0.35, m.wood, m.carton);
  table(s, {high.x() - 0.9, low.y() + 0.8}, 1.45, m.dark_wood, m.carton);
  for (const double x : {low.x() + 0.5, high.x() - 0.5}) {
    for (const double y : {low.y() + 0.5, high.y() - 0.5}) stack(s, {x, y}, 0.55, m.carton, "box");
  }
  stack(s, {middle.x() + 0.25 * size.x(), middle.y() + 0.2 * size.y()}, 0.45, m.carton, "box");
  for (const double x : {-0.25, 0.25}) s.lamp({middle.x() + x * size.x(), middle.y(), high.z() - 0.5}, 1.6);
  s.lamp({middle.x(), low.y() + 0.8, middle.z() + 0.5}, 0.5);
  s.ambient(0.4);
  return s.finish();
}

}  // namespace lintel
