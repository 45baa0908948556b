// SPDX-License-Identifier: BSD-3-Clause
#include "StartPoses.h"

#include <algorithm>

#include "ImuWay.h"

namespace lintel {

namespace {

using TimedPose = std::pair<std::int64_t, Pose>;

bool isEarlier(const TimedPose& a, const TimedPose& b) { return a.first < b.first; }

/// The frames without a pose, of those from the keyframe `from` until before `to`.
std::vector<std::int64_t> withoutPose(const std::vector<std::int64_t>& frames_ns, const std::vector<TimedPose>& poses,
                                      const RetiredKeyframe& from, const RetiredKeyframe& to) {
  std::vector<std::int64_t> times_ns;
  const auto first = std::lower_bound(frames_ns.begin(), frames_ns.end(), from.t_ns);
  const auto last = std::lower_bound(first, frames_ns.end(), to.t_ns);
  std::copy_if(first, last, std::back_inserter(times_ns), [&](std::int64_t t_ns) {
    return !std::binary_search(poses.begin(), poses.end(), TimedPose{t_ns, {}}, isEarlier);
  });
  return times_ns;
}

}  // namespace

void addPosesOfStarts(const std::vector<std::int64_t>& frames_ns, MapMaterial& material) {
  std::vector<TimedPose> added;
  for (std::size_t k = 1; k < material.keyframes.size(); ++k) {
    const RetiredKeyframe &from = material.keyframes[k - 1], &to = material.keyframes[k];
    if (!to.imu || !(to.imu->dt_s() > 0)) continue;
    const std::vector<std::int64_t> times_ns = withoutPose(frames_ns, material.trajectory, from, to);
    if (times_ns.empty()) continue;
    const std::vector<Pose> poses = posesBetween(from, to, times_ns);
    for (std::size_t i = 0; i < times_ns.size(); ++i) added.emplace_back(times_ns[i], poses[i]);
  }
  const auto middle = static_cast<std::ptrdiff_t>(material.trajectory.size());
  material.trajectory.insert(material.trajectory.end(), added.begin(), added.end());
  std::inplace_merge(material.trajectory.begin(), material.trajectory.begin() + middle, material.trajectory.end(),
                     isEarlier);
}

}  // namespace lintel
