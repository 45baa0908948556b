// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/CameraPoses.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace lintel {

CameraPoses::CameraPoses(const SlidingWindow& window) : window_(window) {
  poses_.reserve(window.frames.size());
  for (const WindowFrame& frame : window.frames) {
    const Pose T_w_c = window.T_w_c(frame);
    poses_.push_back(
        {frame.id,
         T_w_c,
         T_w_c.inverse(),
         {frame.pose.data(), window.extrinsics.data(), window.correction.data(), frame.bodyMotion(), false}});
  }
}

const CameraPoses::FramePose& CameraPoses::of(FrameId id) const {
  const auto it = std::find_if(poses_.begin(), poses_.end(), [id](const FramePose& pose) { return pose.id == id; });
  if (it == poses_.end()) throw std::out_of_range("CameraPoses: no frame " + std::to_string(id));
  return *it;
}

}  // namespace lintel
