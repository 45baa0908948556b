// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// What cannot be evaluated: one line naming the file, the line and the remedy.
class EvaluationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// (time [ns], T_w_b), times never descending (a system that was reset may give two poses for one time).
using StampedPoses = std::vector<std::pair<std::int64_t, Pose>>;

/// Reads a trajectory in one of two forms, told apart by the first row; lines that start with # are comments:
///   TUM:   `t x y z qx qy qz qw`, t in seconds, separated by blanks
///   EuRoC: `t,x,y,z,qw,qx,qy,qz[,…]`, t in integer nanoseconds, separated by commas
///   (state_groundtruth_estimate0/data.csv)
/// Positions in metres; quaternions are normalised. Times are kept to the nanosecond.
/// Throws EvaluationError on an unreadable file, a malformed row, or a time that goes back.
StampedPoses readTrajectory(const std::string& path);

/// Poses whose times are another clock's (the IMU's, as in EuRoC's ground truth), with the stamps that images of these
/// times have: an image with stamp t shows the world at t + `time_offset_s`.
StampedPoses atImageStamps(StampedPoses poses, double time_offset_s);

}  // namespace lintel
