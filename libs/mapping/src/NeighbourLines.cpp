// SPDX-License-Identifier: BSD-3-Clause
#include "NeighbourLines.h"

#include <algorithm>
#include <cmath>

#include "SpatialIndex.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr double kNeighbourReach_m = 0.3;
constexpr double kMostLineSamples = 2000;  // of very long lines
constexpr double kSharpness_m = 0.002;     // edges are not sharper than that
constexpr double kLeastCrossSine = 0.34;   // 20 degrees

/// Distance of two segments.
double distanceOf(const SpatialLine& a, const SpatialLine& b) {
  const Eigen::Vector3d arm = b.middle_w - a.middle_w;
  const double cosine = a.direction_w.dot(b.direction_w), sine2 = 1 - cosine * cosine;
  const auto on = [](double along, const SpatialLine& line) { return std::clamp(along, -line.half_m, line.half_m); };
  double s = sine2 > 1e-9 ? (arm.dot(a.direction_w) - cosine * arm.dot(b.direction_w)) / sine2 : 0;
  s = on(s, a);
  const double t = on((a.at(s) - b.middle_w).dot(b.direction_w), b);
  s = on((b.at(t) - a.middle_w).dot(a.direction_w), a);
  return (a.at(s) - b.at(t)).norm();
}

}  // namespace

SpatialLine::SpatialLine(const MapLine& line)
    : middle_w(line.segment_w.midpoint()),
      direction_w(line.segment_w.direction()),
      half_m(0.5 * line.segment_w.length()),
      across(tangentBasis(direction_w)),
      covariance(line.covariance.cast<double>()) {
  if (!covariance.isZero()) return;
  covariance.diagonal().head<2>().setConstant(line.sigma_distance_m * line.sigma_distance_m);
  covariance.diagonal().tail<2>().setConstant(line.sigma_direction_rad * line.sigma_direction_rad);
}

Eigen::Matrix2d SpatialLine::covarianceAt(double along_m) const {
  Eigen::Matrix<double, 2, 4> J;
  J << Eigen::Matrix2d::Identity(), along_m * Eigen::Matrix2d::Identity();
  return J * covariance * J.transpose() + kSharpness_m * kSharpness_m * Eigen::Matrix2d::Identity();
}

double SpatialLine::varianceAt(double along_m, const Eigen::Vector3d& n) const {
  const Eigen::Vector2d part = across.transpose() * n;
  return part.dot(covarianceAt(along_m) * part);
}

std::vector<LineNeighbours> neighboursOf(const std::vector<SpatialLine>& lines) {
  SpatialIndex index(kNeighbourReach_m);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double steps = std::min(kMostLineSamples, 1 + std::floor(4 * lines[i].half_m / kNeighbourReach_m));
    for (int k = 0; k <= static_cast<int>(steps); ++k) index.add(i, lines[i].at(lines[i].half_m * (2 * k / steps - 1)));
  }
  std::vector<LineNeighbours> neighbours(lines.size());
  index.eachPair([&](std::size_t a, std::size_t b) {
    if (!(distanceOf(lines[a], lines[b]) <= kNeighbourReach_m)) return;
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  });
  for (LineNeighbours& of_one : neighbours) std::sort(of_one.begin(), of_one.end());
  return neighbours;
}

bool approachOf(const SpatialLine& a, const SpatialLine& b, Approach& approach) {
  const Eigen::Vector3d cross = a.direction_w.cross(b.direction_w);
  const double sine2 = cross.squaredNorm();
  if (!(sine2 >= kLeastCrossSine * kLeastCrossSine)) return false;
  const Eigen::Vector3d arm = b.middle_w - a.middle_w;
  approach.along_a_m = arm.cross(b.direction_w).dot(cross) / sine2;
  approach.along_b_m = arm.cross(a.direction_w).dot(cross) / sine2;
  approach.normal_w = cross / std::sqrt(sine2);
  approach.gap_m = std::abs(arm.dot(approach.normal_w));
  return true;
}

}  // namespace lintel
