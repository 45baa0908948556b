// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartBuffer.h"

#include "lintel/estimator/WindowUpdate.h"
#include "window/WindowRetirement.h"

namespace lintel {

namespace {

constexpr double kLongest_s = 12;  // almost three full buffers of a 20 Hz camera

}  // namespace

std::size_t frameToThinOut(const SlidingWindow& buffer) {
  const auto& frames = buffer.frames;
  if (1e-9 * static_cast<double>(frames.back().t_ns - frames.front().t_ns) > kLongest_s) return 0;
  std::size_t best = 1;
  for (std::size_t k = 1; k + 1 < frames.size(); ++k)
    if (frames[k + 1].t_ns - frames[k - 1].t_ns < frames[best + 1].t_ns - frames[best - 1].t_ns) best = k;
  return best;
}

void leaveOut(std::size_t k, SlidingWindow& buffer) {
  const FrameId leaving = buffer.frames[k].id;
  if (k == 0) {
    buffer.frames[1].imu.reset();
  } else {
    buffer.frames[k + 1].joinInterval(buffer.frames[k]);
  }
  WindowUpdate nothing;
  retireTracks(buffer, leaving, false, nothing);
  buffer.removeFrame(leaving, false);
}

SlidingWindow newestHalf(SlidingWindow buffer) {
  for (std::size_t n = buffer.frames.size() / 2; n > 0; --n) leaveOut(0, buffer);
  return buffer;
}

}  // namespace lintel
