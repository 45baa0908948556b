// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLine.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/ParamRange.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {
namespace {

/// Through the centroid along the strongest direction of scatter; direction kept towards `hint`.
void totalLeastSquares(const std::vector<Eigen::Vector2d>& points, RobustLine& fit) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.inlier[i]) mean += points[i] / fit.inliers;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.inlier[i]) scatter += (points[i] - mean) * (points[i] - mean).transpose();
  const Eigen::Vector2d d = symmetricEigen(scatter).vectors.col(1);
  std::size_t first = 0, last = points.size() - 1;
  while (!fit.inlier[first]) ++first;
  while (!fit.inlier[last]) --last;
  fit.line = {mean + d * d.dot(points[first] - mean), mean + d * d.dot(points[last] - mean)};
}

}  // namespace

LineCamera::LineCamera(const PinholeRadtan& camera)
    : camera_(camera), focal_(camera.meanFocal()), pixel_scale_(pixelScale(camera)) {
  for (const double x : {0.0, camera.width - 1.0})
    for (const double y : {0.0, camera.height - 1.0})
      max_radius_ = std::max(max_radius_, 1.02 * fromImage({x, y}).norm());
}

Eigen::Matrix2d LineCamera::imageJacobian(const Eigen::Vector2d& u) const {
  Eigen::Matrix2d J = camera_.distortJacobian(u / focal_) / focal_;
  J.row(0) *= camera_.fx;
  J.row(1) *= camera_.fy;
  return J;
}

ImageLine LineCamera::turned(const ImageLine& line, const Eigen::Quaterniond& R_c1_c0) const {
  // Ends may lie outside the image, where the lens model folds back: they stay in undistorted pixels.
  const auto turn = [&](const Eigen::Vector2d& u) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = R_c1_c0 * (u / focal_).homogeneous();
    return focal_ * ray.head<2>() / std::max(ray.z(), 0.1);
  };
  return {turn(line.start), turn(line.end)};
}

bool LineCamera::sees(const Eigen::Vector2d& u, double border_px) const {
  return mayBeSeen(u) && camera_.contains(toImage(u), border_px);
}

std::optional<ImageLine> LineCamera::clip(const ImageLine& line, double border_px) const {
  constexpr int kSteps = 16;  // the part in the image is looked for in such pieces; a lens bends it little
  const auto seen = [&](double share) { return sees(line.at(share), border_px); };
  int first = 0, last = kSteps;
  while (first <= kSteps && !seen(static_cast<double>(first) / kSteps)) ++first;
  if (first > kSteps) return std::nullopt;
  while (!seen(static_cast<double>(last) / kSteps)) --last;
  // The border lies between a seen and an unseen step.
  const auto bisect = [&](double in, double out) {
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (in + out);
      (seen(middle) ? in : out) = middle;
    }
    return in;
  };
  const double s0 =
      first == 0 ? 0.0 : bisect(static_cast<double>(first) / kSteps, static_cast<double>(first - 1) / kSteps);
  const double s1 =
      last == kSteps ? 1.0 : bisect(static_cast<double>(last) / kSteps, static_cast<double>(last + 1) / kSteps);
  return ImageLine{line.at(s0), line.at(s1)};
}

LineRelation relate(const ImageLine& line, const ImageLine& other) {
  const Eigen::Vector2d d = line.direction(), n = line.normal(), e = other.direction();
  const double s0 = d.dot(other.start - line.start), s1 = d.dot(other.end - line.start);
  LineRelation relation;
  relation.angle_rad = std::abs(std::atan2(d.x() * e.y() - d.y() * e.x(), d.dot(e)));
  relation.distance_px = std::max(std::abs(n.dot(other.start - line.start)), std::abs(n.dot(other.end - line.start)));
  relation.overlap_px = std::min(line.length(), std::max(s0, s1)) - std::max(0.0, std::min(s0, s1));
  return relation;
}

std::optional<RobustLine> fitRobustLine(const std::vector<Eigen::Vector2d>& points, double tolerance_px) {
  RobustLine best;
  double best_cost = 1e18;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const ImageLine line{points[i], points[j]};
      if (line.length() < 4 * tolerance_px) continue;
      const Eigen::Vector2d n = line.normal();
      double cost = 0;
      for (const Eigen::Vector2d& p : points) cost += std::min(std::abs(n.dot(p - points[i])) / tolerance_px, 1.0);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best.line = line;
    }
  if (best_cost > 1e17) return std::nullopt;
  for (int round = 0; round < 2; ++round) {
    const Eigen::Vector2d n = best.line.normal();
    best.inlier.assign(points.size(), 0);
    best.inliers = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      best.inlier[i] = std::abs(n.dot(points[i] - best.line.start)) < tolerance_px;
      best.inliers += best.inlier[i];
    }
    if (best.inliers < 3 || 2 * best.inliers < static_cast<int>(points.size())) return std::nullopt;
    totalLeastSquares(points, best);
    if (best.line.length() < 1e-6) return std::nullopt;
  }
  return best;
}

}  // namespace lintel
