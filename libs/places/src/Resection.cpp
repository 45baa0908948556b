// SPDX-License-Identifier: BSD-3-Clause
#include "Resection.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdint>

#include "lintel/core/RandomSequence.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr std::uint64_t kSeed = 20261123;  // of the samples
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Poses from which two points are seen in two directions; `bearing` in a frame whose z axis is vertical, turned from
/// the world by the unknown yaw: p_w = c + distance Rz(yaw) bearing. With q = Rz(-yaw) p_w and c' = Rz(-yaw) c, every
/// direction u across the bearing gives u (q - c') = 0, linear in cos, sin and c'. What is across the four equations'
/// columns of c' leaves one equation in cos and sin.
template <class Take>
void posesOfTwo(const std::array<Eigen::Vector3d, 2>& p_w, const std::array<Eigen::Vector3d, 2>& bearing, Take take) {
  Eigen::Matrix<double, 4, 3> M;
  Eigen::Matrix<double, 4, 3> known;  // factors of cos, sin and 1
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::Vector3d& p = p_w[static_cast<std::size_t>(i)];
    M.middleRows<2>(2 * i) = tangentBasis(bearing[static_cast<std::size_t>(i)]).transpose();
    for (Eigen::Index row = 2 * i; row < 2 * i + 2; ++row)
      known.row(row) << M(row, 0) * p.x() + M(row, 1) * p.y(), M(row, 0) * p.y() - M(row, 1) * p.x(), M(row, 2) * p.z();
  }
  Eigen::Vector4d across;
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix3d minor;
    for (int r = 0, k = 0; r < 4; ++r)
      if (r != i) minor.row(k++) = M.row(r);
    across[i] = (i % 2 == 0 ? 1 : -1) * minor.determinant();
  }
  const Eigen::RowVector3d e = across.transpose() * known;
  const double size = std::hypot(e[0], e[1]);
  if (!(size > 1e-12) || std::abs(e[2]) > size) return;
  const double middle = std::atan2(e[1], e[0]), half = std::acos(-e[2] / size);
  const Eigen::Matrix3d inverse = (M.transpose() * M).inverse();
  for (const double yaw : {middle + half, middle - half}) {
    const Eigen::Quaterniond R(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d c =
        inverse * M.transpose() * (known * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 1)).eval();
    if (c.allFinite()) take(Pose{R, R * c});
  }
}

/// Whether the point is seen within an angle whose cosine is given.
bool agrees(const Pose& T_w_c, const Sighting& s, double cosine) {
  const Eigen::Vector3d d = s.p_w - T_w_c.p;
  const double along = d.dot(T_w_c.q * s.bearing_c);
  return along > 0 && along * along >= cosine * cosine * d.squaredNorm();
}

std::vector<std::size_t> inliersOf(const Pose& T_w_c, const std::vector<Sighting>& sightings, double angle_rad) {
  std::vector<std::size_t> inliers;
  const double cosine = std::cos(angle_rad);
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (agrees(T_w_c, sightings[i], cosine)) inliers.push_back(i);
  return inliers;
}

Pose bestOfPairs(const std::vector<Sighting>& sightings, const Eigen::Quaterniond& R_w_c,
                 const ResectionParams& params) {
  Pose best;
  std::size_t most = 0;
  const double cosine = std::cos(params.coarse_rad);
  RandomSequence sequence(kSeed);
  for (int h = 0; h < params.hypotheses; ++h) {
    const Sighting &a = sightings[sequence.below(sightings.size())], &b = sightings[sequence.below(sightings.size())];
    if ((a.p_w - b.p_w).squaredNorm() < 1e-6) continue;
    posesOfTwo({a.p_w, b.p_w}, {R_w_c * a.bearing_c, R_w_c * b.bearing_c}, [&](const Pose& level) {
      const Pose T_w_c{level.q * R_w_c, level.p};
      if (!agrees(T_w_c, a, cosine) || !agrees(T_w_c, b, cosine)) return;
      std::size_t n = 0;
      for (const Sighting& s : sightings) n += agrees(T_w_c, s, cosine);
      if (n > most) most = n, best = T_w_c;
    });
  }
  return best;
}

/// One Gauss-Newton step over (rotation in the camera, position), Cauchy weights. Residual: B^T n with n the direction
/// of the point in the camera frame and B across the bearing.
void improve(const std::vector<Sighting>& sightings, const std::vector<std::size_t>& used, double sigma_rad,
             Pose& T_w_c) {
  Matrix6d H = 1e-9 * Matrix6d::Identity();
  Vector6d g = Vector6d::Zero();
  const Eigen::Matrix3d R_c_w = T_w_c.q.conjugate().toRotationMatrix();
  for (const std::size_t i : used) {
    const Sighting& s = sightings[i];
    const Eigen::Vector3d p_c = R_c_w * (s.p_w - T_w_c.p);
    const double distance = p_c.norm();
    const Eigen::Matrix<double, 2, 3> across = tangentBasis(s.bearing_c).transpose();
    const Eigen::Vector3d n = p_c / distance;
    const Eigen::Vector2d r = across * n / sigma_rad;
    Eigen::Matrix<double, 2, 6> J;
    J.leftCols<3>() = across * skew(n) / sigma_rad;
    J.rightCols<3>() = -across * (Eigen::Matrix3d::Identity() - n * n.transpose()) * R_c_w / (distance * sigma_rad);
    const double weight = 1 / (1 + r.squaredNorm());
    H += weight * J.transpose() * J;
    g += weight * J.transpose() * r;
  }
  const Vector6d step = -H.ldlt().solve(g);
  if (!step.allFinite()) return;
  T_w_c.q = (T_w_c.q * expRotation(step.head<3>())).normalized();
  T_w_c.p += step.tail<3>();
}

}  // namespace

std::optional<Resection> resect(const std::vector<Sighting>& sightings, const Eigen::Quaterniond& R_w_c,
                                const ResectionParams& params) {
  if (sightings.size() < 4) return std::nullopt;
  Resection result{bestOfPairs(sightings, R_w_c, params), {}};
  result.inliers = inliersOf(result.T_w_c, sightings, params.coarse_rad);
  for (int i = 0; i < 8 && result.inliers.size() >= 4; ++i) {
    improve(sightings, result.inliers, 0.5 * params.fine_rad, result.T_w_c);
    result.inliers = inliersOf(result.T_w_c, sightings, i < 3 ? params.coarse_rad : params.fine_rad);
  }
  if (result.inliers.size() < 4) return std::nullopt;
  return result;
}

}  // namespace lintel
