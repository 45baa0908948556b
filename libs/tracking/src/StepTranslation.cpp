// SPDX-License-Identifier: BSD-3-Clause
#include "StepTranslation.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/Quantiles.h"

namespace lintel {
namespace {

constexpr double kPointNoise_px = 0.3;  ///< of a point's place in the image, whatever the focal length
constexpr double kStill_px = 0.3;       ///< median motion below this noise has no direction
constexpr std::size_t kMinPoints = 5;   ///< with a known depth, to carry the unit on: a median of fewer is not robust
constexpr double kLengthDrift = 0.03;   ///< relative growth of a depth's uncertainty per step: the length's error
constexpr double kGate = 4;             ///< standard deviations; a measurement beyond is not used

}  // namespace

/// One point in both frames, as the translation sees it.
struct StepTranslation::Ray {
  TrackId id;
  Eigen::Vector3d x, motion;          ///< in the turned old frame, and the motion from there
  std::optional<InverseDepth> depth;  ///< in the turned old frame
};

std::vector<StepTranslation::Ray> StepTranslation::raysOf(const std::vector<Pair>& pairs,
                                                          const Eigen::Quaterniond& R_c1_c0) const {
  const Eigen::Matrix3d R = R_c1_c0.toRotationMatrix();
  std::vector<Ray> rays;
  rays.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    Eigen::Vector3d f = R * pair.x0.head<2>().homogeneous();
    if (wide_) f = R * pair.x0;
    const double z = wide_ ? 1 : std::max(f.z(), 0.1);
    const Eigen::Vector3d x = wide_ ? f : Eigen::Vector3d(f.x() / z, f.y() / z, 1);
    Ray ray{pair.id, x, pair.x1 - x, std::nullopt};
    if (const auto known = points_.find(pair.id); known != points_.end())
      ray.depth = InverseDepth{known->second.w / z, known->second.variance / (z * z)};
    rays.push_back(ray);
  }
  return rays;
}

double StepTranslation::lengthOf(const std::vector<Ray>& rays, const Eigen::Vector3d& direction) const {
  std::vector<std::pair<double, double>> lengths;  // with their weights
  double sum = 0;
  for (const Ray& ray : rays) {
    if (!ray.depth || !(ray.depth->w > 3 * std::sqrt(ray.depth->variance))) continue;
    const Eigen::Vector3d e = parallax(ray.x, direction);
    const double moved = ray.motion.dot(e) / std::max(e.squaredNorm(), 1e-9);  // length * inverse depth now
    const double length = moved / (ray.depth->w * std::max(1 - moved * along(ray.x, direction), 0.2));
    const double weight = ray.depth->w * e.norm();
    lengths.emplace_back(length, weight);
    sum += weight;
  }
  if (lengths.size() < kMinPoints) return -1;
  std::sort(lengths.begin(), lengths.end());
  double below = 0;
  for (const auto& [length, weight] : lengths)
    if ((below += weight) >= 0.5 * sum) return length;
  return -1;
}

void StepTranslation::updatePoints(const std::vector<Ray>& rays, const Eigen::Vector3d& direction, double length) {
  std::map<TrackId, InverseDepth> points;
  std::vector<double> depths;
  for (const Ray& ray : rays) {
    std::optional<InverseDepth> depth = ray.depth;
    if (depth) {
      depth->w = carriedInverseDepth(depth->w, along(ray.x, length * direction));
      depth->variance += kLengthDrift * kLengthDrift * depth->w * depth->w;
    }
    const Eigen::Vector3d e = length * parallax(ray.x, direction);
    const double squares = e.squaredNorm();
    if (squares > 1e-12) {
      const double w = ray.motion.dot(e) / squares;
      const double variance = kPointNoise_px * kPointNoise_px / (focal_px_ * focal_px_ * squares);
      if (!depth) {
        depth = InverseDepth{w, variance};
      } else if (std::pow(w - depth->w, 2) < kGate * kGate * (variance + depth->variance)) {
        const double gain = depth->variance / (depth->variance + variance);
        depth->w += gain * (w - depth->w);
        depth->variance *= 1 - gain;
      }
    }
    if (!depth) continue;
    points[ray.id] = *depth;
    depths.push_back(depth->w);
  }
  points_ = std::move(points);
  typical_ = depths.empty() ? 0 : upperMedian(depths);
}

void StepTranslation::update(const std::vector<Pair>& pairs, const Eigen::Quaterniond& R_c1_c0,
                             const std::optional<Eigen::Vector3d>& direction_c1) {
  const std::vector<Ray> rays = raysOf(pairs, R_c1_c0);
  std::vector<double> moved;
  moved.reserve(rays.size());
  for (const Ray& ray : rays) moved.push_back(ray.motion.norm());
  if (!direction_c1 || rays.size() < kMinPoints) {
    points_.clear();
    typical_ = 0;
    ++epoch_;
    t_c1_.setZero();
    return;
  }
  if (upperMedian(moved) * focal_px_ < kStill_px) {
    t_c1_.setZero();
    updatePoints(rays, *direction_c1, 0);
    return;
  }
  Eigen::Vector3d direction = *direction_c1;
  double forward = 0;  // depths are positive
  for (const Ray& ray : rays) forward += parallax(ray.x, direction).dot(ray.motion);
  if (forward < 0) direction = -direction;
  double length = lengthOf(rays, direction);
  if (!(length > 0)) {
    points_.clear();
    ++epoch_;
    length = 1;
    std::vector<Ray> fresh = rays;
    for (Ray& ray : fresh) ray.depth.reset();
    t_c1_ = direction;
    updatePoints(fresh, direction, length);
    return;
  }
  t_c1_ = length * direction;
  updatePoints(rays, direction, length);
}

}  // namespace lintel
