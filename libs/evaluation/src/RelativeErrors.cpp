// SPDX-License-Identifier: BSD-3-Clause
#include "RelativeErrors.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// What the estimate got wrong between poses `from` and `to`: the identity if nothing.
Pose motionError(const PartneredPose& from, const PartneredPose& to) {
  const Pose true_motion = from.T_w_b.inverse() * to.T_w_b;
  const Pose estimated_motion = from.T_e_b.inverse() * to.T_e_b;
  return true_motion.inverse() * estimated_motion;
}

RelativeErrors errorsOf(double distance_m, const std::vector<Pose>& motion_errors) {
  std::vector<double> translation_m, rotation_rad;
  for (const Pose& error : motion_errors) {
    translation_m.push_back(error.p.norm());
    rotation_rad.push_back(logRotation(error.q).norm());
  }
  return {distance_m, false, statisticsOf(translation_m), statisticsOf(rotation_rad)};
}

}  // namespace

std::vector<RelativeErrors> relativeErrors(const std::vector<PartneredPose>& poses,
                                           const TrajectoryErrorParams& params) {
  if (poses.empty()) return {};
  std::vector<double> path_m(poses.size(), 0.0);  // true path up to each pose
  for (std::size_t i = 1; i < poses.size(); ++i)
    path_m[i] = path_m[i - 1] + (poses[i].T_w_b.p - poses[i - 1].T_w_b.p).norm();

  std::vector<RelativeErrors> result;
  for (const double distance_m : params.distances_m) {
    std::vector<Pose> errors;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto end =
          std::lower_bound(path_m.begin() + static_cast<std::ptrdiff_t>(i), path_m.end(), path_m[i] + distance_m);
      if (end == path_m.end()) break;
      if (*end - path_m[i] > distance_m * (1 + params.max_overshoot)) continue;  // the stretch leaps over a gap
      errors.push_back(motionError(poses[i], poses[static_cast<std::size_t>(end - path_m.begin())]));
    }
    result.push_back(errorsOf(distance_m, errors));
  }
  result.push_back(errorsOf(path_m.back(), {motionError(poses.front(), poses.back())}));
  result.back().whole_path = true;
  return result;
}

}  // namespace lintel
