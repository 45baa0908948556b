// SPDX-License-Identifier: BSD-3-Clause
#include "RefinedComparison.h"

#include <cmath>
#include <cstdint>

#include "lintel/core/Formatted.h"
#include "lintel/geometry/Alignment.h"

namespace lintel {

namespace {

// A causal trajectory that is farther off than this has failed: it drifted, or its scale is wrong.
constexpr double kLargest_m = 0.03, kLargestShare = 0.01;  // and of the way

/// Positions of both trajectories at the times in [first_ns, last_ns] that both have.
struct Matched {
  std::vector<Eigen::Vector3d> causal, refined;
};

Matched match(const std::vector<OdometryPose>& causal, const std::vector<OdometryPose>& refined, std::int64_t first_ns,
              std::int64_t last_ns) {
  Matched matched;
  auto next = refined.begin();
  for (const OdometryPose& pose : causal) {
    if (pose.t_ns < first_ns || pose.t_ns > last_ns) continue;
    while (next != refined.end() && next->t_ns < pose.t_ns) ++next;
    if (next == refined.end()) break;
    if (next->t_ns != pose.t_ns) continue;
    matched.causal.push_back(pose.T_w_b.p);
    matched.refined.push_back(next->T_w_b.p);
  }
  return matched;
}

}  // namespace

RefinedComparison compareWithRefined(const std::vector<OdometryPose>& causal, const std::vector<OdometryPose>& refined,
                                     const std::vector<MapPiece>& pieces) {
  std::vector<Matched> parts;
  for (const MapPiece& piece : pieces) parts.push_back(match(causal, refined, piece.first_ns, piece.last_ns));
  if (pieces.empty()) parts.push_back(match(causal, refined, INT64_MIN, INT64_MAX));
  RefinedComparison comparison;
  double sum_m2 = 0, count = 0;
  for (const Matched& part : parts) {
    if (part.causal.empty()) continue;
    const Similarity T = alignPositions(AlignmentKind::kYaw, part.causal, part.refined);
    for (std::size_t i = 0; i < part.causal.size(); ++i) {
      sum_m2 += (part.refined[i] - T * part.causal[i]).squaredNorm();
      if (i > 0) comparison.path_m += (part.refined[i] - part.refined[i - 1]).norm();
    }
    count += static_cast<double>(part.causal.size());
  }
  if (count > 0) comparison.rms_m = std::sqrt(sum_m2 / count);
  return comparison;
}

std::string contradictionOf(const OdometryResult& result) {
  const RefinedComparison c = compareWithRefined(result.trajectory, result.refined_trajectory, result.map.pieces);
  if (c.rms_m <= kLargest_m + kLargestShare * c.path_m) return {};
  return formatted(
      "the causal trajectory is %.2f m (rms, over %.1f m) away from the refined one, which agrees with images "
      "and IMU: use the refined trajectory and the map; or start where it moves more strongly (--from)",
      c.rms_m, c.path_m);
}

}  // namespace lintel
