// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include "lintel/mapping/LineMap.h"

namespace lintel {

inline void addLine(LineMap& map, const Eigen::Vector3d& a, const Eigen::Vector3d& b, int group) {
  MapLine line;
  line.id = 10 + map.lines.size();
  line.segment_w = {a, b};
  line.group = group;
  line.constrained = group >= 0 && map.lines.size() % 4 == 0;
  line.degenerate = group < 0 && map.lines.size() % 3 == 0;
  line.mapped = map.lines.size() % 5 == 2;
  line.sigma_direction_rad = 0.001 * (1 + static_cast<double>(map.lines.size() % 7));
  line.sigma_distance_m = 0.003 * (1 + static_cast<double>(map.lines.size() % 11));
  line.first_t_ns = 1403636579763555584, line.last_t_ns = 1403636589763555584;
  for (std::uint64_t k = 0; k < 2 + map.lines.size() % 9; ++k) line.observations.push_back({k, {1, 2}, {3, 4}});
  map.lines.push_back(line);
}

inline void addBox(LineMap& map, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Eigen::Vector3d a = low, b = low;
      a[u] = b[u] = corner & 1 ? high[u] : low[u];
      a[v] = b[v] = corner & 2 ? high[v] : low[v];
      b[axis] = high[axis];
      addLine(map, a, b, axis);
    }
  }
}

/// A room of 8 m x 6 m x 3 m with a table, shelves, a window, a leaning ladder, two runaway lines; a camera goes
/// around.
inline LineMap sampleRoom() {
  LineMap map;
  map.source = "sample room";
  map.configuration = "none: 0\n";
  map.rig.camera = {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  addBox(map, {-4, -3, 0}, {4, 3, 3});
  addBox(map, {-1, -0.5, 0.7}, {1, 0.5, 0.75});
  for (int leg = 0; leg < 4; ++leg)
    addLine(map, {leg & 1 ? 0.95 : -0.95, leg & 2 ? 0.45 : -0.45, 0},
            {leg & 1 ? 0.95 : -0.95, leg & 2 ? 0.45 : -0.45, 0.7}, 2);
  for (int shelf = 0; shelf < 5; ++shelf) addBox(map, {3.6, -2, 0.4 + 0.45 * shelf}, {3.98, 1, 0.43 + 0.45 * shelf});
  addBox(map, {-2, 2.98, 1}, {1, 3, 2.2});
  addLine(map, {-0.5, 2.99, 1}, {-0.5, 2.99, 2.2}, 2);
  addLine(map, {-3.5, -2.9, 2.4}, {-2.6, -1.8, 0}, -1);
  addLine(map, {-3.1, -2.9, 2.4}, {-2.2, -1.8, 0}, -1);
  for (int rung = 1; rung < 7; ++rung) {
    const double s = rung / 7.0;
    addLine(map, {-3.5 + 0.9 * s, -2.9 + 1.1 * s, 2.4 - 2.4 * s}, {-3.1 + 0.9 * s, -2.9 + 1.1 * s, 2.4 - 2.4 * s}, 0);
  }
  addLine(map, {20, 30, 4}, {90, 20, 40}, -1);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::uint64_t i = 0; i < 300; ++i) {
    MapPoint point;
    point.id = i, point.sigma_distance_m = 0.02;
    point.p_w = {4 * u(random), i % 2 ? 3.0 : -3.0, 1.5 + 1.5 * u(random)};
    point.observations = {{0, {1, 2}}, {1, {1, 2}}, {2, {1, 2}}};
    map.points.push_back(point);
  }
  Eigen::Matrix3d R_b_c;  // the camera looks along the body's x
  R_b_c << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  map.rig.T_b_c.q = Eigen::Quaterniond(R_b_c);
  for (int i = 0; i < 200; ++i) {
    const double a = 2 * M_PI * i / 200;
    const Pose T_w_b{Eigen::Quaterniond(Eigen::AngleAxisd(a + 0.3, Eigen::Vector3d::UnitZ())),
                     {-2 * std::cos(a), -1.6 * std::sin(a), 1.4 + 0.1 * std::sin(5 * a)}};
    const std::int64_t t_ns = 1403636579763555584 + 50000000LL * i;
    map.trajectory.emplace_back(t_ns, T_w_b);
    if (i % 10 == 0)
      map.keyframes.push_back({static_cast<std::uint64_t>(i / 10), t_ns, T_w_b, Eigen::Vector3d::Zero(),
                               Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  }
  return map;
}

/// `count` short lines in a hall, for sizes and times.
inline LineMap manyLines(int count) {
  LineMap map;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-30, 30), d(-0.5, 0.5);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a(u(random), u(random), 0.1 * u(random));
    addLine(map, a, a + Eigen::Vector3d(d(random), d(random), d(random)), i % 4 - 1);
  }
  return map;
}

}  // namespace lintel
