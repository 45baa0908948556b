// SPDX-License-Identifier: BSD-3-Clause
#include "PointsTurn.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr std::size_t kLeastPairs = 15, kMostPairs = 60;
constexpr int kRounds = 4, kHypotheses = 20;
constexpr double kSureCost = 9;            // chi-square by which one of two rotations is clearly the better
constexpr double kTranslation_rad = 0.05;  // by which translation may pass for rotation: 1 m/s at 1 m in 50 ms

/// The rotation R_c1_c0 that moves points as they were seen to move, robustly, no translation considered.
Eigen::Quaterniond rotationAlone(const std::vector<TwoViewPair>& pairs, bool wide) {
  Eigen::Quaterniond R_c1_c0 = Eigen::Quaterniond::Identity();
  double width = 1;  // of the robust loss: everything counts at first
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    std::vector<double> distances;
    for (const TwoViewPair& pair : pairs) {
      const Eigen::Vector3d f = R_c1_c0 * pair.x0;
      const double z = std::max(f.z(), 1e-3);
      Eigen::Vector3d e = f - pair.x1;  // on the sphere, else on the plane z = 1
      Eigen::Matrix3d projection = Eigen::Matrix3d::Identity();
      if (!wide) {
        e << f.head<2>() / z - pair.x1.head<2>(), 0;
        projection << 1 / z, 0, -f.x() / (z * z), 0, 1 / z, -f.y() / (z * z), 0, 0, 0;
      }
      const Eigen::Matrix3d J = -projection * skew(f);
      const double weight = 1 / (1 + e.squaredNorm() / (width * width));
      H += weight * J.transpose() * J;
      b += weight * J.transpose() * e;
      distances.push_back(e.norm());
    }
    R_c1_c0 = (expRotation(-H.ldlt().solve(b)) * R_c1_c0).normalized();
    width = std::max(1e-4, 2 * upperMedian(distances));
  }
  return R_c1_c0;
}

/// A rotation between the views with the direction of translation that fits best.
struct Fit {
  CameraTurn turn;
  int inliers = 0;
  double cost = 0;
};

Fit fitFrom(const Eigen::Quaterniond& R_c1_c0, const std::vector<TwoViewPair>& pairs, const TwoViewParams& params) {
  const Eigen::Matrix3d loose = Eigen::Matrix3d::Identity() / (kTranslation_rad * kTranslation_rad);
  const TwoViewMotion motion = twoViewMotion(pairs, R_c1_c0, loose, params);
  CameraTurn turn;
  turn.rotation = -logRotation(expRotation(motion.delta) * R_c1_c0);
  turn.sigma = (motion.information + loose).inverse().diagonal().cwiseSqrt();
  return {turn, motion.inliers, motion.cost};
}

std::vector<TwoViewPair> evenly(const std::vector<TwoViewPair>& pairs) {
  const std::size_t step = (pairs.size() + kMostPairs - 1) / kMostPairs;
  std::vector<TwoViewPair> chosen;
  for (std::size_t i = 0; i < pairs.size(); i += step) chosen.push_back(pairs[i]);
  return chosen;
}

}  // namespace

std::optional<CameraTurn> turnOfPoints(const std::vector<TwoViewPair>& pairs, const TwoViewParams& camera) {
  if (pairs.size() < kLeastPairs) return std::nullopt;
  const std::vector<TwoViewPair> chosen = evenly(pairs);
  TwoViewParams params;
  params.focal_px = camera.focal_px;
  params.wide = camera.wide;
  params.hypotheses = kHypotheses;
  Fit best = fitFrom(rotationAlone(chosen, camera.wide), chosen, params);
  Fit other = fitFrom(Eigen::Quaterniond::Identity(), chosen, params);
  if (other.cost < best.cost) std::swap(best, other);
  if (2 * static_cast<std::size_t>(best.inliers) < chosen.size()) return std::nullopt;
  if (other.cost < best.cost + kSureCost) best.turn.sigma += (best.turn.rotation - other.turn.rotation).cwiseAbs();
  return best.turn;
}

}  // namespace lintel
