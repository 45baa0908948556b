// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SceneAssembler.h"

namespace lintel {

/// One wall of the hull as a place to put things: a frame at its lower left corner as seen from inside, x along the
/// wall, y up, z into the room.
struct WallFrame {
  Pose T_w_l;
  double length_m = 0, height_m = 0;
};

/// The four walls of an axis-parallel hull.
std::array<WallFrame, 4> wallFrames(const Eigen::AlignedBox3d& hull);

/// A box in a wall's frame by its lowest and highest corner.
bool wallBox(SceneAssembler& scene, const WallFrame& wall, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             int material, const std::string& kind, double tint = 1);

/// A floor of planks along x, each with its own tone and two true edges.
void plankFloor(SceneAssembler& scene, int material, double width_m);

/// A window: bright pane, frame and cross bars.
void window(SceneAssembler& scene, const WallFrame& wall, double x, double y, double width, double height, int frame,
            int pane);

/// A framed picture, a little before the wall.
void picture(SceneAssembler& scene, const WallFrame& wall, double x, double y, double width, double height, int frame);

/// An open shelf with boards and boxes or books on them.
void shelf(SceneAssembler& scene, const WallFrame& wall, double x, double width, double height, double depth, int board,
           int content);

/// A table with four legs and things on it.
void table(SceneAssembler& scene, const Eigen::Vector2d& at, double yaw_rad, int board, int things);

/// A stack of one to three boxes, each turned a little.
void stack(SceneAssembler& scene, const Eigen::Vector2d& at, double size_m, int material, const std::string& kind);

}  // namespace lintel
