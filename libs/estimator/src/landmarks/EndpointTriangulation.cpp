// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/EndpointTriangulation.h"

#include <algorithm>
#include <cmath>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

// Pixels of any image: they are errors of the tracker, and its border.
constexpr double kBorder_px = 12;           // nearer to the image's border an end may be cut
constexpr double kSigmaAlong_px = 2;        // of an end along its line, at best
constexpr double kMaxError_px = 3;          // rms; above, the end is no fixed point
constexpr double kMaxRelativeSigma = 0.15;  // of the depth
constexpr std::size_t kLeastSightings = 4;  // three unknowns, and redundancy to detect outliers

struct SeenPoint {
  EndsVerdict verdict = EndsVerdict::kNoCorners;
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
  double sigma_m = 0;  // along the newest ray
};

SeenPoint triangulateEnd(const CameraPoses& poses, const LineTrack& track, bool start) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();  // the point nearest to all rays
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  std::vector<std::pair<Pose, Eigen::Vector3d>> views;
  for (const LineSighting& s : track.sightings) {
    if (!poses.camera().contains(start ? s.start_px : s.end_px, kBorder_px)) continue;
    const Pose& T_w_c = poses.T_w_c(s.frame);
    const Eigen::Vector3d seen = (start ? s.start : s.end).corrected(poses.correction());
    const Eigen::Vector3d ray = T_w_c.q * seen.normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * T_w_c.p;
    views.emplace_back(T_w_c, seen);
  }
  if (views.size() < kLeastSightings || views.size() + 1 < track.sightings.size()) return {};
  const Eigen::Vector3d p_w = solveLdlt(A, b);
  if (!p_w.allFinite()) return {};
  double sum = 0;
  for (const auto& [T_w_c, seen] : views) {
    const Eigen::Vector3d p_c = T_w_c.inverse() * p_w;
    if (poses.camera().depth(p_c, seen) < 0.05) return {EndsVerdict::kTooEarly};
    sum += (poses.camera().rayTo(p_c) - seen).squaredNorm();
  }
  const double focal = poses.camera().meanFocal();
  if (std::sqrt(sum / static_cast<double>(views.size())) * focal > kMaxError_px) return {};
  const Eigen::Vector3d newest = p_w - views.back().first.p;
  const double depth = newest.norm(), sigma_m = kSigmaAlong_px / focal * depth;  // of the point across a ray
  const Eigen::Vector3d ray = newest / depth;
  const double information = ray.dot(A * ray);
  const double sigma_along = sigma_m / std::sqrt(std::max(information, 1e-12));
  if (sigma_along > kMaxRelativeSigma * depth) return {EndsVerdict::kTooEarly};
  return {EndsVerdict::kCorners, p_w, sigma_along};
}

}  // namespace

SeenEnds triangulateEnds(const CameraPoses& poses, const LineTrack& track) {
  SeenEnds ends;
  const SeenPoint start = triangulateEnd(poses, track, true), end = triangulateEnd(poses, track, false);
  ends.verdict = std::min(start.verdict, end.verdict);
  const double length = (end.p_w - start.p_w).norm();
  if (ends.verdict != EndsVerdict::kCorners || length < 1e-3) return ends;
  ends.start_w = start.p_w;
  ends.end_w = end.p_w;
  ends.sigma_direction_rad = std::hypot(start.sigma_m, end.sigma_m) / length;
  ends.sigma_distance_m = 0.5 * std::hypot(start.sigma_m, end.sigma_m);
  return ends;
}

}  // namespace lintel
