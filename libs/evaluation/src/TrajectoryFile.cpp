// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrajectoryFile.h"

#include <cmath>

#include "lintel/core/TextRows.h"

namespace lintel {

namespace {

/// Columns 1 to 3 are the position; `w` is the column of qw and `x` that of qx.
Pose poseOf(const TextRows& rows, std::size_t w, std::size_t x) {
  const Eigen::Quaterniond q(rows.number(w), rows.number(x), rows.number(x + 1), rows.number(x + 2));
  if (std::abs(q.norm() - 1) > 0.05) rows.fail("the quaternion's norm is " + std::to_string(q.norm()) + ", not 1");
  return {q.normalized(), {rows.number(1), rows.number(2), rows.number(3)}};
}

std::pair<std::int64_t, Pose> stampedPoseOf(const TextRows& rows, bool is_euroc) {
  if (rows.commaSeparated() != is_euroc || rows.fields().size() < 8)
    rows.fail(is_euroc ? "an EuRoC state should be t_ns,x,y,z,qw,qx,qy,qz[,…]"
                       : "a TUM pose should be t x y z qx qy qz qw");
  if (is_euroc) return {rows.integer(0), poseOf(rows, 4, 5)};
  return {rows.secondsAsNanoseconds(0), poseOf(rows, 7, 4)};
}

}  // namespace

StampedPoses readTrajectory(const std::string& path) {
  TextRows rows(path, throwError<EvaluationError>);
  StampedPoses trajectory;
  bool is_euroc = false;
  while (rows.next()) {
    if (trajectory.empty()) is_euroc = rows.commaSeparated();
    const auto stamped = stampedPoseOf(rows, is_euroc);
    if (!trajectory.empty() && stamped.first < trajectory.back().first)
      rows.fail("the time goes back; sort the rows by time");
    trajectory.push_back(stamped);
  }
  if (trajectory.empty()) throw EvaluationError(path + ": holds no poses; give a TUM file or an EuRoC state CSV");
  return trajectory;
}

StampedPoses atImageStamps(StampedPoses poses, double time_offset_s) {
  const std::int64_t offset_ns = std::llround(1e9 * time_offset_s);
  for (auto& [t_ns, pose] : poses) t_ns -= offset_ns;
  return poses;
}

}  // namespace lintel
