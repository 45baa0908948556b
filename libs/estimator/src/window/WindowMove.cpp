// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMove.h"

namespace lintel {

void moveWindow(SlidingWindow& window, const Pose& T) {
  for (WindowFrame& frame : window.frames) {
    frame.pose = toBlock(T * frame.T_w_b());
    frame.motion.segment<3>(kVelocityAt) = T.q * velocityOf(frame.motion.data());
  }
  for (auto& [id, track] : window.points) {
    if (!track.triangulated) continue;
    track.origin_w = T * track.origin_w;
    track.point.head<3>() = T.q * track.point.head<3>();
  }
  for (auto& [id, track] : window.lines) {
    if (!track.triangulated) continue;
    const PluckerLine line = lineFromBlock(track.line.data()).plucker();
    track.origin_w = T * track.origin_w;
    track.line = toBlock(toOrthonormal({T.q * line.n, T.q * line.d}));
  }
}

}  // namespace lintel
