// SPDX-License-Identifier: BSD-3-Clause
#include "TwoViewMotion.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lintel/core/RandomSequence.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr std::uint64_t kSeed = 20210530;  // of the samples
using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr std::size_t kMinPairs = 8;     // five unknowns, and redundancy to detect outliers
constexpr double kConverged_rad = 1e-5;  // less than a hundredth of a pixel
constexpr double kRobustScale = 2;       // standard deviations from which on a point loses weight (Cauchy)
constexpr double kDirectionPrior = 1;    // damping of the direction [1/rad^2]: far below what a translation gives

struct Rays {
  Eigen::Vector3d f0, f1;  ///< z = 1 or unit length; f0 turned into frame 1 by the predicted rotation
};

/// A ray after a turn, of length 1 or z = 1 again.
Eigen::Vector3d turnedRay(const Eigen::Vector3d& f0, bool wide) { return wide ? f0 : f0 / std::max(f0.z(), 1e-3); }

/// By what x . line is a distance of x from the epipolar line: a line of the plane z = 1, or a great circle.
double lineSize(const Eigen::Vector3d& line, bool wide) { return wide ? line.norm() : line.head<2>().norm(); }

std::vector<Rays> turnedRays(const std::vector<TwoViewPair>& pairs, const Eigen::Matrix3d& R, bool wide) {
  std::vector<Rays> rays;
  rays.reserve(pairs.size());
  for (const TwoViewPair& pair : pairs) {
    Eigen::Vector3d f0 = R * pair.x0.head<2>().homogeneous();
    if (wide) f0 = R * pair.x0;
    rays.push_back({turnedRay(f0, wide), pair.x1});
  }
  return rays;
}

/// Signed distance of f1 from the epipolar line of f0, as rays. Never more than the distance from f0 to f1,
/// because the line passes through f0: a point that only follows the rotation fits any translation.
double epipolarDistance(const Rays& ray, const Eigen::Vector3d& t, bool wide) {
  const Eigen::Vector3d line = t.cross(ray.f0);
  return line.dot(ray.f1) / std::max(lineSize(line, wide), 1e-9);
}

double truncatedCost(const std::vector<Rays>& rays, const Eigen::Vector3d& t, double threshold, bool wide) {
  double cost = 0;
  for (const Rays& ray : rays) {
    const double r = epipolarDistance(ray, t, wide) / threshold;
    cost += std::min(r * r, 1.0);
  }
  return cost;
}

Eigen::Vector3d bestDirection(const std::vector<Rays>& rays, double threshold, const TwoViewParams& params) {
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  double best_cost = truncatedCost(rays, best, threshold, params.wide);
  RandomSequence sequence(kSeed);
  for (int h = 0; h < params.hypotheses; ++h) {
    const Rays& a = rays[sequence.below(rays.size())];
    const Rays& b = rays[sequence.below(rays.size())];
    const Eigen::Vector3d t = a.f0.cross(a.f1).cross(b.f0.cross(b.f1));
    const double norm = t.norm();
    if (!(norm > 1e-12)) continue;
    const double cost = truncatedCost(rays, t / norm, threshold, params.wide);
    if (cost < best_cost) {
      best_cost = cost;
      best = t / norm;
    }
  }
  return best;
}

/// Normal equations of the epipolar distances over (rotation correction, direction on its tangent plane), Cauchy
/// weights; image part only.
struct NormalEquations {
  Matrix5d H = Matrix5d::Zero();
  Vector5d g = Vector5d::Zero();
};

NormalEquations linearise(const std::vector<Rays>& rays, const Eigen::Vector3d& delta, const Eigen::Vector3d& t,
                          const Eigen::Matrix<double, 3, 2>& B, double noise, bool wide) {
  NormalEquations out;
  const Eigen::Quaterniond dR = expRotation(delta);
  for (const Rays& ray : rays) {
    const Eigen::Vector3d f0 = dR * ray.f0;
    const Eigen::Vector3d m = f0.cross(ray.f1);
    const double scale = 1.0 / (std::max(lineSize(t.cross(f0), wide), 1e-3) * noise);
    const double r = t.dot(m) * scale;
    Vector5d J;
    J.head<3>() = f0.cross(ray.f1.cross(t)) * scale;
    J.tail<2>() = B.transpose() * m * scale;
    const double weight = 1.0 / (1.0 + r * r / (kRobustScale * kRobustScale));
    out.H += weight * J * J.transpose();
    out.g += weight * J * r;
  }
  return out;
}

void refine(const std::vector<Rays>& rays, const Eigen::Matrix3d& R_information, const TwoViewParams& params,
            TwoViewMotion& motion) {
  const double noise = params.noise_px / params.focal_px;
  for (int iteration = 0; iteration < 6; ++iteration) {
    const Eigen::Matrix<double, 3, 2> B = tangentBasis(motion.direction);
    NormalEquations eq = linearise(rays, motion.delta, motion.direction, B, noise, params.wide);
    // Without translation the direction is free: the damping holds it, and its freedom is taken out of the rotation's
    // information by the Schur complement below.
    const Eigen::Matrix2d H_tt =
        eq.H.bottomRightCorner<2, 2>() + Eigen::Matrix2d::Identity() * (1e-6 * eq.H.trace() + 1e-9);
    const Eigen::Matrix<double, 3, 2> H_rt = eq.H.topRightCorner<3, 2>();
    motion.information = eq.H.topLeftCorner<3, 3>() - H_rt * H_tt.inverse() * H_rt.transpose();
    eq.H.topLeftCorner<3, 3>() += R_information;
    eq.g.head<3>() += R_information * motion.delta;
    eq.H.bottomRightCorner<2, 2>() += Eigen::Matrix2d::Identity() * kDirectionPrior;
    const Vector5d step = -eq.H.ldlt().solve(eq.g);
    if (!step.allFinite()) return;
    motion.delta = logRotation(expRotation(step.head<3>()) * expRotation(motion.delta));
    motion.direction = (motion.direction + B * step.tail<2>()).normalized();
    if (step.norm() < kConverged_rad) break;
  }
}

}  // namespace

TwoViewMotion twoViewMotion(const std::vector<TwoViewPair>& pairs, const Eigen::Quaterniond& R_predicted,
                            const Eigen::Matrix3d& R_information, const TwoViewParams& params) {
  TwoViewMotion motion;
  motion.inlier.assign(pairs.size(), 1);
  motion.inliers = static_cast<int>(pairs.size());
  if (pairs.size() < kMinPairs) return motion;

  std::vector<Rays> rays = turnedRays(pairs, R_predicted.toRotationMatrix(), params.wide);
  const double threshold = params.threshold_px / params.focal_px;
  // An uncertain rotation moves every point: the tolerance of the hypotheses is larger by that.
  const double rotation_sigma = std::sqrt(R_information.inverse().trace() / 3);
  motion.direction = bestDirection(rays, threshold + rotation_sigma, params);
  refine(rays, R_information, params, motion);

  const Eigen::Quaterniond dR = expRotation(motion.delta);
  const double width = kRobustScale * params.noise_px / params.focal_px;
  motion.inliers = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Rays turned{turnedRay(dR * rays[i].f0, params.wide), rays[i].f1};
    const double distance = epipolarDistance(turned, motion.direction, params.wide);
    motion.inlier[i] = std::abs(distance) < threshold ? 1 : 0;
    motion.inliers += motion.inlier[i];
    motion.cost += kRobustScale * kRobustScale * std::log1p(distance * distance / (width * width));
  }
  return motion;
}

}  // namespace lintel
