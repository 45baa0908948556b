// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/GravityAlignment.h"

#include <Eigen/LU>
#include <cmath>
#include <map>

#include "initialisation/GyroAlignment.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Body position at a frame: p = M (v, g) + alpha, in body axes of the first frame.
struct Motion {
  double t = 0;
  Eigen::Quaterniond R;
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero(), beta = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_offset;  // camera centre = p + offset
  Matrix36 M;
};

std::vector<Motion> integrate(const SlidingWindow& window) {
  const std::vector<Eigen::Quaterniond> R = integratedRotations(window);
  std::vector<Motion> motions(window.frames.size());
  for (std::size_t k = 0; k < motions.size(); ++k) {
    Motion& m = motions[k];
    m.R = R[k];
    if (k > 0) {
      const Preintegration& imu = *window.frames[k].imu;
      const Motion& before = motions[k - 1];
      m.t = before.t + imu.dt_s();
      m.alpha = before.alpha + before.beta * imu.dt_s() + before.R * imu.deltaP();
      m.beta = before.beta + before.R * imu.deltaV();
    }
    m.centre_offset = m.R * window.T_b_c().p;
    m.M << m.t * Eigen::Matrix3d::Identity(), 0.5 * m.t * m.t * Eigen::Matrix3d::Identity();
  }
  return motions;
}

/// A ray of a point: the direction in axes of the first body frame, and the frame it is seen from.
struct Ray {
  std::size_t frame = 0;
  Eigen::Vector3d direction;
};

struct PointSystem {
  double depth = 1;   // along the first ray, from the round before
  double weight = 1;  // robust
  std::vector<Ray> rays;
};

/// One round: normal equations in (v, g) with every depth eliminated.
void accumulate(const PointSystem& point, const std::vector<Motion>& motions, Matrix6& A, Vector6& b, Vector6& cross,
                double& depth_information, double& depth_b) {
  const Motion& host = motions[point.rays[0].frame];
  Vector6 h = Vector6::Zero();  // mixed second derivative with the depth
  double hh = 0, hb = 0;
  for (std::size_t i = 1; i < point.rays.size(); ++i) {
    const Motion& target = motions[point.rays[i].frame];
    const Eigen::Matrix3d S = skew(point.rays[i].direction) * (point.weight / std::max(point.depth, 0.1));
    // S (c_host + z r_host - c_target) = 0
    const Matrix36 J = S * (host.M - target.M);
    const Eigen::Vector3d jz = S * point.rays[0].direction;
    const Eigen::Vector3d r = S * (host.alpha + host.centre_offset - target.alpha - target.centre_offset);
    A += J.transpose() * J;
    b -= J.transpose() * r;
    h += J.transpose() * jz;
    hh += jz.squaredNorm();
    hb -= jz.dot(r);
  }
  cross = h;
  depth_information = hh;
  depth_b = hb;
}

std::vector<PointSystem> collectPoints(const SlidingWindow& window, const std::vector<Motion>& motions) {
  std::map<FrameId, std::size_t> index;
  for (std::size_t i = 0; i < window.frames.size(); ++i) index[window.frames[i].id] = i;
  std::vector<PointSystem> points;
  for (const auto& [id, track] : window.points) {
    if (track.sightings.size() < 4) continue;
    PointSystem point;
    for (const PointSighting& s : track.sightings) {
      const std::size_t k = index.at(s.frame);
      point.rays.push_back({k, motions[k].R * (window.T_b_c().q * s.observation.ray.normalized())});
    }
    points.push_back(std::move(point));
  }
  return points;
}

/// Depth and mean angular error of a point for a solution; a point behind the camera gets no weight.
void reweigh(PointSystem& point, const std::vector<Motion>& motions, const Vector6& x, double width_rad) {
  const auto centre = [&](const Motion& m) -> Eigen::Vector3d { return m.M * x + m.alpha + m.centre_offset; };
  const Eigen::Vector3d host = centre(motions[point.rays[0].frame]), ray = point.rays[0].direction;
  double jj = 0, jr = 0;
  for (std::size_t i = 1; i < point.rays.size(); ++i) {
    const Eigen::Matrix3d S = skew(point.rays[i].direction);
    const Eigen::Vector3d j = S * ray, r = S * (host - centre(motions[point.rays[i].frame]));
    jj += j.squaredNorm();
    jr += j.dot(r);
  }
  const double depth = jj > 1e-12 ? -jr / jj : 50;
  double error = 0;
  for (std::size_t i = 1; i < point.rays.size(); ++i) {
    const Eigen::Vector3d p = host + std::max(depth, 0.1) * ray - centre(motions[point.rays[i].frame]);
    error += point.rays[i].direction.cross(p.normalized()).norm();
  }
  error /= static_cast<double>(point.rays.size() - 1) * width_rad;
  point.depth = std::min(std::max(depth, 0.3), 50.0);
  point.weight = depth > 0 ? 1 / std::sqrt(1 + error * error) : 0.1;
}

}  // namespace

Vector6 solveWithGravityNorm(const Matrix6& A, const Vector6& b, double gravity_m_s2) {
  // v eliminated: (D - mu I) g = d with |g| fixed; mu below the smallest eigenvalue is the global minimum
  const Eigen::Matrix3d Avv_inverse = A.topLeftCorner<3, 3>().inverse(), Agv = A.bottomLeftCorner<3, 3>();
  const Eigen::Matrix3d D = A.bottomRightCorner<3, 3>() - Agv * Avv_inverse * Agv.transpose();
  const Eigen::Vector3d d = b.tail<3>() - Agv * Avv_inverse * b.head<3>();
  const SymmetricEigen<3> eigen = symmetricEigen<3>(0.5 * (D + D.transpose()));
  const Eigen::Vector3d e = eigen.vectors.transpose() * d, l = eigen.values;
  const auto normAt = [&](double mu) { return (e.array() / (l.array() - mu)).matrix().norm(); };
  double high = l[0] - 1e-12 * std::max(1.0, std::abs(l[0])), span = std::max(1e-6, std::abs(l[2]));
  double low = l[0] - span;
  while (normAt(low) > gravity_m_s2) low = l[0] - (span *= 2);
  for (int i = 0; i < 200 && high - low > 1e-15 * span; ++i) {
    const double middle = 0.5 * (low + high);
    (normAt(middle) > gravity_m_s2 ? high : low) = middle;
  }
  const double mu = 0.5 * (low + high);
  Vector6 x;
  x.tail<3>() = eigen.vectors * (e.array() / (l.array() - mu)).matrix();
  x.head<3>() = Avv_inverse * (b.head<3>() - Agv.transpose() * x.tail<3>());
  return x;
}

GravityAlignment alignGravity(const SlidingWindow& window) {
  constexpr double kWidth_rad = 0.004;  // about two pixels of EuRoC's camera
  GravityAlignment result;
  const std::vector<Motion> motions = integrate(window);
  std::vector<PointSystem> points = collectPoints(window, motions);
  if (points.size() < 15) return result;
  Vector6 x = Vector6::Zero();
  for (int round = 0; round < 6; ++round) {
    Matrix6 A = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    for (const PointSystem& point : points) {
      Vector6 h;
      double hh = 0, hb = 0;
      accumulate(point, motions, A, b, h, hh, hb);
      if (hh < 1e-12) continue;
      A -= h * h.transpose() / hh;
      b -= h * (hb / hh);
    }
    if (symmetricEigen<Eigen::Dynamic>(A).values[0] < 1e-14) return result;
    x = solveWithGravityNorm(A, b, window.frames.back().imu->gravity_m_s2());
    if (!x.allFinite()) return result;
    for (PointSystem& point : points) reweigh(point, motions, x, kWidth_rad * (round < 2 ? 4 : 1));
  }
  result.v_b0 = x.head<3>();
  result.g_b0 = x.tail<3>();
  for (const Motion& m : motions) {
    result.p_b0_bk.push_back(m.M * x + m.alpha);
    result.v_b0_bk.push_back(result.v_b0 + result.g_b0 * m.t + m.beta);
  }
  result.ok = true;
  return result;
}

}  // namespace lintel
