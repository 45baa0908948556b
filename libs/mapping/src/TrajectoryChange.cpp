// SPDX-License-Identifier: BSD-3-Clause
#include "TrajectoryChange.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// Yaw and translation from where some keyframes were to where they are: the means.
class CommonChange {
 public:
  void add(const Pose& before, const Pose& after) {
    const Eigen::Quaterniond turn = after.q * before.q.conjugate();
    // the rotation about z that is nearest to it
    cosine_ += turn.w() * turn.w() - turn.z() * turn.z();
    sine_ += 2 * turn.w() * turn.z();
    before_sum_ += before.p;
    after_sum_ += after.p;
    count_ += 1;
  }

  Pose pose() const {
    const Eigen::Quaterniond yaw(Eigen::AngleAxisd(std::atan2(sine_, cosine_), Eigen::Vector3d::UnitZ()));
    return {yaw, after_sum_ / count_ - yaw * (before_sum_ / count_)};
  }

 private:
  double cosine_ = 0, sine_ = 0, count_ = 0;
  Eigen::Vector3d before_sum_ = Eigen::Vector3d::Zero(), after_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace

TrajectoryChange trajectoryChange(const std::vector<RetiredKeyframe>& before, const std::vector<RetiredKeyframe>& after,
                                  const std::vector<MapPiece>& pieces) {
  const auto worldOf = [&](const RetiredKeyframe& k) {
    return pieces.empty() ? 0 : pieces[pieceOf(pieces, k.id)].world;
  };
  std::map<int, CommonChange> common;  // by world
  for (std::size_t k = 0; k < before.size(); ++k) common[worldOf(before[k])].add(before[k].T_w_b, after[k].T_w_b);
  TrajectoryChange change;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Pose was = common[worldOf(before[k])].pose() * before[k].T_w_b;
    if (k > 0 && before[k].imu) change.travelled_m += (before[k].T_w_b.p - before[k - 1].T_w_b.p).norm();
    change.moved_m = std::max(change.moved_m, (after[k].T_w_b.p - was.p).norm());
    change.turned_rad = std::max(change.turned_rad, logRotation(was.q.conjugate() * after[k].T_w_b.q).norm());
  }
  return change;
}

}  // namespace lintel
