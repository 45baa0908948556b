// SPDX-License-Identifier: BSD-3-Clause
#include "RobustLine.h"

#include <Eigen/Eigenvalues>
#include <cmath>

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
  const Eigen::Vector2d d = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(1);
  std::size_t first = 0, last = points.size() - 1;
  while (!fit.inlier[first]) ++first;
  while (!fit.inlier[last]) --last;
  fit.line = {mean + d * d.dot(points[first] - mean), mean + d * d.dot(points[last] - mean)};
}

}  // namespace

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
