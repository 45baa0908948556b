// SPDX-License-Identifier: BSD-3-Clause
#include "PointErrors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel::truth {

void PointErrors::add(const FrameTracks& tracks) {
  const auto T_w_b = poses_.at(tracks.t_ns);
  if (!T_w_b) return;
  for (const PointObservation& p : tracks.points) tracks_[p.id].push_back({*T_w_b * rig_.T_b_c, p.ray});
}

/// Residuals [px] at the best place; empty when it is not in front of all cameras.
std::vector<Eigen::Vector2d> PointErrors::residualsOf(const Track& track) const {
  const double focal = rig_.camera.meanFocal();
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Sighting& s : track) {
    const Eigen::Vector3d ray = s.T_w_c.q * s.ray.normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * s.T_w_c.p;
  }
  Eigen::Vector3d p = solveLdlt(A, b);
  std::vector<Eigen::Vector2d> r(track.size());
  for (int iteration = 0; iteration < 8; ++iteration) {
    Eigen::Matrix3d H = 1e-6 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < track.size(); ++i) {
      const Eigen::Vector3d c = track[i].T_w_c.inverse() * p;
      if (rig_.camera.depth(c, track[i].ray) < 0.05) return {};
      // across the ray: in x and y, or in a basis of the plane tangent to the sphere
      const Eigen::Vector3d n = rig_.camera.rayTo(c);
      const bool wide = rig_.camera.wide();
      const Eigen::Matrix<double, 3, 2> B = wide ? tangentBasis(n) : Eigen::Matrix<double, 3, 2>::Identity();
      r[i] = focal * (B.transpose() * (n - track[i].ray));
      Eigen::Matrix<double, 2, 3> J = B.transpose();
      if (!wide) J.col(2) = -n.head<2>();
      J = focal / rig_.camera.depth(c, n) * J * track[i].T_w_c.R().transpose();
      const double w = 1 / (1 + r[i].squaredNorm());
      H += w * J.transpose() * J;
      g += w * J.transpose() * r[i];
    }
    p -= solveLdlt(H, g);
  }
  return r;
}

void PointErrors::printLengths(std::size_t from, std::size_t to) const {
  std::vector<double> all, steps;
  double correlated = 0, power = 0;
  int n = 0;
  for (const auto& [id, track] : tracks_) {
    if (track.size() < from || track.size() >= to) continue;
    const auto r = residualsOf(track);
    if (r.empty()) continue;
    ++n;
    for (const Eigen::Vector2d& residual : r) all.push_back(residual.norm());
    for (std::size_t i = 1; i < r.size(); ++i) {
      steps.push_back((r[i] - r[i - 1]).norm());
      if (r[i].norm() < 3 && r[i - 1].norm() < 3) correlated += r[i].dot(r[i - 1]), power += r[i].squaredNorm();
    }
  }
  std::printf(
      "point tracks of %3zu and more frames: %5d  error median %.3f px  step median %.3f px  correlation of "
      "consecutive "
      "ones %.2f\n",
      from, n, all.empty() ? 0 : upperMedian(all), steps.empty() ? 0 : upperMedian(steps),
      correlated / std::max(power, 1e-9));
}

/// The standard deviation in one coordinate, by their median, of the differences of residuals of a track so many images
/// apart: white noise is the same at any distance, a walk grows with it.
void PointErrors::printLags() const {
  constexpr std::size_t kShortest = 20;
  std::map<std::size_t, std::vector<double>> squares;
  for (const auto& [id, track] : tracks_) {
    if (track.size() < kShortest) continue;
    const auto r = residualsOf(track);
    for (const std::size_t lag : {1, 2, 4, 8, 16, 32, 64})
      for (std::size_t i = lag; i < r.size(); ++i) squares[lag].push_back((r[i] - r[i - lag]).squaredNorm());
  }
  std::printf("points, difference of the errors in images");
  for (auto& [lag, values] : squares)
    std::printf("  %zu apart %.3f px", lag, std::sqrt(upperMedian(values) / (2 * std::log(2.0))));
  std::printf("\n");
}

void PointErrors::print() const {
  constexpr std::size_t kLengths[] = {10, 20, 40, 80, 160, 100000};
  for (std::size_t k = 0; k + 1 < std::size(kLengths); ++k) printLengths(kLengths[k], kLengths[k + 1]);
  printLags();
}

}  // namespace lintel::truth
