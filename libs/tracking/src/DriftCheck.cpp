// SPDX-License-Identifier: BSD-3-Clause
#include "DriftCheck.h"

namespace lintel {
namespace {

constexpr double kRotationSigma_rad =
    1e-3;  ///< of the chained rotations of half a second: half a pixel at the reference focal length

}  // namespace

void DriftCheck::push(const std::vector<PointObservation>& points, const Eigen::Quaterniond& R_c1_c0) {
  for (Entry& entry : entries_) entry.R_c_ct = (R_c1_c0 * entry.R_c_ct).normalized();
  entries_.push_back({points, Eigen::Quaterniond::Identity()});
  if (static_cast<int>(entries_.size()) > gap_frames_ + 1) entries_.pop_front();
}

std::vector<TrackId> DriftCheck::drifting() const {
  std::vector<TrackId> ids;
  if (static_cast<int>(entries_.size()) <= gap_frames_) return ids;
  std::vector<TwoViewPair> pairs;
  std::vector<TrackId> paired;
  auto then = entries_.front().points.begin();
  const auto then_end = entries_.front().points.end();
  for (const PointObservation& now : entries_.back().points) {
    while (then != then_end && then->id < now.id) ++then;
    if (then == then_end || then->id != now.id) continue;
    pairs.push_back({then->ray, now.ray});
    paired.push_back(now.id);
  }
  const Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / (kRotationSigma_rad * kRotationSigma_rad);
  const TwoViewMotion motion = twoViewMotion(pairs, entries_.front().R_c_ct, information, params_);
  if (2 * static_cast<std::size_t>(motion.inliers) < pairs.size())
    return ids;  // no motion explains most tracks: none is rejected
  for (std::size_t i = 0; i < paired.size(); ++i)
    if (!motion.inlier[i]) ids.push_back(paired[i]);
  return ids;
}

}  // namespace lintel
