// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SceneLibrary.h"

#include <stdexcept>

#include "Scenes.h"

namespace lintel {

namespace {

SceneKind room() {
  return {"room",
          "a furnished room: planks, posters, shelves, boxes",
          {Eigen::Vector3d(-4, -3, 0), Eigen::Vector3d(4, 3, 3.5)},
          {},
          {1.6, 1.6, 1.0},
          buildRoom};
}

SceneKind hall() {
  SceneKind kind{"hall",
                 "a large hall: columns, roof beams, racks, crates, pipes",
                 {Eigen::Vector3d(-9, -6, 0), Eigen::Vector3d(9, 6, 6.5)},
                 {},
                 {3.5, 3.5, 1.5},
                 buildHall};
  kind.figure.centre = {0, 0, 2.2};
  kind.figure.half_extent = {4.5, 2.5, 0.9};
  kind.figure.period_s = 32;
  return kind;
}

SceneKind corridor() {
  SceneKind kind{"corridor",
                 "little texture, many long parallel lines",
                 {Eigen::Vector3d(-12, -1.6, 0), Eigen::Vector3d(12, 1.6, 2.8)},
                 {},
                 {3.0, 1.2, 1.0},
                 buildCorridor};
  kind.figure.centre = {0, 0, 1.4};
  kind.figure.half_extent = {7.5, 0.6, 0.4};
  kind.figure.period_s = 50;
  kind.figure.turn_rate_rad_s = 0;
  return kind;
}

SceneKind braces() {
  return {"braces",
          "skewed walls, struts, fans of poles, tumbled boxes: next to nothing parallel",
          {Eigen::Vector3d(-4.5, -3.5, 0), Eigen::Vector3d(4.5, 3.5, 3.8)},
          {},
          {1.8, 1.8, 1.1},
          buildBraces};
}

}  // namespace

const std::vector<SceneKind>& sceneKinds() {
  static const std::vector<SceneKind> kinds{room(), hall(), corridor(), braces()};
  return kinds;
}

const SceneKind& sceneKind(const std::string& name) {
  std::string names;
  for (const SceneKind& kind : sceneKinds()) {
    if (kind.name == name) return kind;
    names += " " + kind.name;
  }
  throw std::invalid_argument("no scene '" + name + "'; there are:" + names);
}

}  // namespace lintel
