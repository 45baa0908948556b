// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include "FaultEdits.h"
#include "lintel/mapping/MapFile.h"

namespace lintel::test {

namespace {

using MapChange = std::function<void(LineMap&)>;

/// What a whole map can lack, and numbers that its format allows and no flight has.
const std::map<std::string, MapChange>& changes() {
  static const std::map<std::string, MapChange> kChanges{
      {"no-keyframes", [](LineMap& m) { m.keyframes.clear(); }},
      {"no-lines", [](LineMap& m) { m.lines.clear(); }},
      {"no-points", [](LineMap& m) { m.points.clear(); }},
      {"no-trajectory",
       [](LineMap& m) {
         m.trajectory.clear();
         for (MapPiece& piece : m.pieces) piece.first_pose = 0;
       }},
      {"no-views", [](LineMap& m) { m.views.clear(); }},
      {"no-pieces", [](LineMap& m) { m.pieces.clear(), m.views.clear(); }},
      {"no-observations",
       [](LineMap& m) {
         for (MapLine& line : m.lines) line.observations.clear();
         for (MapPoint& point : m.points) point.observations.clear();
       }},
      {"one-keyframe", [](LineMap& m) { m.keyframes.resize(1); }},
      {"no-numbers", [](LineMap& m) { m.keyframes[1].T_w_b.p.x() = std::numeric_limits<double>::quiet_NaN(); }},
      {"far-off", [](LineMap& m) { m.keyframes[1].T_w_b.p.x() = 1e300; }},
      {"no-rotation", [](LineMap& m) { m.keyframes[1].T_w_b.q.coeffs().setZero(); }},
      {"no-camera", [](LineMap& m) { m.rig.camera = {}; }},
      {"no-focal-length", [](LineMap& m) { m.rig.camera.fx = 0; }},
      {"other-times", [](LineMap& m) {
         for (MapKeyframe& keyframe : m.keyframes) keyframe.t_ns += 1000;
       }}};
  return kChanges;
}

}  // namespace

void applyMapEdit(const std::string& map, const std::vector<std::string>& words) {
  LineMap changed = readMap(map);
  for (std::size_t i = 2; i < words.size(); ++i) changes().at(words[i])(changed);
  writeMap(changed, map);
}

}  // namespace lintel::test
