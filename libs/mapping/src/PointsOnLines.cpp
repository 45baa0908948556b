// SPDX-License-Identifier: BSD-3-Clause
#include "PointsOnLines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lintel {

namespace {

// Pixels of any image: they are errors of the trackers of points and lines.
constexpr double kOn_px = 1.5;       // from a view's segment; more is beside it
constexpr double kBeyond_px = 5;     // its ends: corners are there
constexpr int kLeastShared = 3;      // keyframes that saw both
constexpr double kLeastShare = 0.9;  // of those, in which the point is on the line
constexpr double kMostSigma = 0.05;  // of a point's place, of its distance
constexpr double kAgree = 2.5;       // standard deviations between points on one line

/// Distance of a pixel from a segment; infinity beyond its ends. Through a wide lens a segment is an arc of a great
/// circle.
double distanceFrom(const KeyframeCameras& cameras, const LineView& view, const Eigen::Vector2d& px) {
  const Eigen::Vector2d start_px = view.start_px.cast<double>(), end_px = view.end_px.cast<double>();
  if (cameras.camera().wide()) {
    const Eigen::Vector3d start = cameras.ray(start_px), end = cameras.ray(end_px), x = cameras.ray(px);
    const Eigen::Vector3d normal = start.cross(end).normalized(), along = normal.cross(start);
    const double length = std::atan2(along.dot(end), start.dot(end)), place = std::atan2(along.dot(x), start.dot(x));
    const double reach = kBeyond_px / cameras.camera().meanFocal();
    if (!(place >= -reach && place <= length + reach) || length * cameras.camera().meanFocal() < 1)
      return std::numeric_limits<double>::infinity();
    return std::abs(normal.dot(x)) * cameras.camera().meanFocal();
  }
  const Eigen::Vector2d along = end_px - start_px;
  const double length2 = along.squaredNorm(), u = (px - start_px).dot(along);
  const double reach = kBeyond_px * std::sqrt(length2);
  if (!(u >= -reach && u <= length2 + reach) || length2 < 1) return std::numeric_limits<double>::infinity();
  return std::abs((px - start_px).dot(Eigen::Vector2d(-along.y(), along.x()))) / std::sqrt(length2);
}

double distanceAcross(const PointOnLine& a, const PointOnLine& b, const Eigen::Vector3d& direction_w) {
  return (a.p_w - b.p_w).cross(direction_w).norm();
}

}  // namespace

PointsOnLines::PointsOnLines(const KeyframeCameras& cameras, const std::vector<PointRecord>& points)
    : cameras_(cameras), points_(points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].known) continue;
    for (const PointView& v : points[i].views) {
      if (!v.inlier) continue;
      if (v.keyframe >= seen_.size()) seen_.resize(v.keyframe + 1);
      seen_[v.keyframe].push_back({i, v.px.cast<double>()});
    }
  }
}

std::vector<PointOnLine> PointsOnLines::seenOn(const LineRecord& line, const Eigen::Vector3d& direction_w) const {
  struct Count {
    int shared = 0, on = 0;
  };
  std::map<std::size_t, Count> counts;
  FrameId keyframe = 0;
  for (const LineView& v : line.views) {
    if (!v.inlier || v.keyframe >= seen_.size()) continue;
    keyframe = v.keyframe;
    for (const Sighting& s : seen_[v.keyframe]) {
      Count& count = counts[s.point];
      ++count.shared;
      count.on += distanceFrom(cameras_, v, s.px) <= kOn_px;
    }
  }
  std::vector<PointOnLine> result;
  for (const auto& [i, count] : counts) {
    if (count.shared < kLeastShared || count.on < kLeastShare * count.shared) continue;
    const PointRecord& point = points_[i];
    const Eigen::Vector3d arm = point.p_w - cameras_.T_w_c(keyframe).p;
    const double distance = arm.norm();
    if (!(point.sigma_distance_m <= kMostSigma * distance)) continue;
    const double along_ray = point.sigma_distance_m * arm.cross(direction_w).norm() / distance;
    result.push_back({point.p_w, std::max(along_ray, kOn_px / cameras_.camera().meanFocal() * distance)});
  }
  return result;
}

std::vector<PointOnLine> PointsOnLines::on(const LineRecord& line, const Eigen::Vector3d& direction_w) const {
  const std::vector<PointOnLine> seen = seenOn(line, direction_w);
  std::vector<PointOnLine> best;
  for (const PointOnLine& seed : seen) {
    std::vector<PointOnLine> together;
    for (const PointOnLine& p : seen)
      if (distanceAcross(seed, p, direction_w) <= kAgree * std::hypot(seed.sigma_m, p.sigma_m)) together.push_back(p);
    if (together.size() > best.size()) best = std::move(together);
  }
  return best;
}

}  // namespace lintel
