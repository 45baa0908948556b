// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartReplacement.h"

#include "lintel/inertial/Propagation.h"
#include "window/WindowStamps.h"

namespace lintel {

namespace {

void replacePosesBetween(const SlidingWindow& window, const WindowFrame& from, const WindowFrame& to,
                         const StateCovariance& covariance, const StartMemory& memory, WindowUpdate& update) {
  if (!to.imu) return;
  const InertialState state = stateOf(from);
  const std::vector<std::int64_t> times_ns = memory.skippedBetween(from.t_ns, to.t_ns);
  const std::vector<Preintegration> imu = integratedTo(state.bias, withAxes(*to.imu, window.imuAxes()), times_ns);
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    const InertialState there = propagated(state, imu[i]);
    update.replaced.push_back({times_ns[i], there.T_w_b, poseOfImage(window, there, gyroAtEnd(imu[i])),
                               propagatedCovariance(state, imu[i], covariance)});
  }
}

}  // namespace

std::vector<const WindowFrame*> framesToReplace(const SlidingWindow& window, std::int64_t from_ns) {
  std::vector<const WindowFrame*> frames;
  for (const WindowFrame& frame : window.frames)
    if (frame.t_ns >= from_ns && frame.t_ns < window.frames.back().t_ns) frames.push_back(&frame);
  return frames;
}

void replacePoses(const SlidingWindow& window, const std::vector<const WindowFrame*>& frames,
                  const std::vector<StateCovariance>& covariances, const StartMemory& memory, WindowUpdate& update) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    update.replaced.push_back({frames[i]->t_ns, frames[i]->T_w_b(),
                               poseOfImage(window, stateOf(*frames[i]), frames[i]->gyro), covariances[i]});
    const WindowFrame& next = i + 1 < frames.size() ? *frames[i + 1] : window.frames.back();
    replacePosesBetween(window, *frames[i], next, covariances[i], memory, update);
  }
}

}  // namespace lintel
