// SPDX-License-Identifier: BSD-3-Clause
#include "KeyframeClusters.h"

#include <cstdint>

namespace lintel {

namespace {

/// Whether the IMU leads from the keyframe before to this one.
bool follows(const RetiredKeyframe& keyframe) { return keyframe.imu && keyframe.imu->dt_s() > 0; }

std::vector<std::size_t> anchorPlaces(const std::vector<RetiredKeyframe>& keyframes, double interval_s) {
  // stamps of images vary by some milliseconds
  const auto interval_ns = static_cast<std::int64_t>(1e9 * interval_s + 1e7);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const bool inside = k > 0 && k + 1 < keyframes.size() && follows(keyframes[k]) && follows(keyframes[k + 1]);
    if (!inside || keyframes[k + 1].t_ns - keyframes[places.back()].t_ns > interval_ns) places.push_back(k);
  }
  return places;
}

}  // namespace

std::vector<Anchors> anchorsOf(const std::vector<RetiredKeyframe>& keyframes, double interval_s) {
  const std::vector<std::size_t> places = anchorPlaces(keyframes, interval_s);
  std::vector<Anchors> anchors;
  std::size_t next = 0;  // the first anchor not before the keyframe
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (places[next] < k) ++next;
    if (places[next] == k) {
      anchors.push_back({k, k});
      continue;
    }
    const std::size_t before = places[next - 1], after = places[next];
    const bool earlier = keyframes[k].t_ns - keyframes[before].t_ns <= keyframes[after].t_ns - keyframes[k].t_ns;
    anchors.push_back(earlier ? Anchors{before, after} : Anchors{after, before});
  }
  return anchors;
}

std::vector<Anchors> fewAnchors(const std::vector<RetiredKeyframe>& keyframes, int most, double interval_s) {
  constexpr double kLongest_s = 10;  // between anchors: beyond it the odometry does not carry a pose well enough
  while (most > 0 && interval_s < kLongest_s &&
         anchorPlaces(keyframes, interval_s).size() > static_cast<std::size_t>(most))
    interval_s += 0.1;
  return anchorsOf(keyframes, interval_s);
}

}  // namespace lintel
