// SPDX-License-Identifier: BSD-3-Clause
#include "LineTriangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "LineDegeneracy.h"

namespace lintel {

namespace {

struct LineNormal {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double cost = 0;
};

/// Normal equations of the line alone, poses and calibration fixed.
LineNormal normalEquations(const SlidingWindow& window, const FactorParams& params, const LineTrack& track,
                           const LineBlock& line) {
  LineNormal normal;
  const ceres::CauchyLoss loss(params.line_loss_width);
  RowMajorMatrix plus(kLineSize, kLineTangent);
  LineManifold().PlusJacobian(line.data(), plus.data());
  for (const LineSighting& s : track.sightings) {
    const LineFactor factor(s.start, s.end, window.frame(s.frame).bodyMotion(), track.origin_w,
                            window.camera().meanFocal() / (params.line_sigma_px * s.sigma_px));
    const double* blocks[] = {window.frame(s.frame).pose.data(), window.extrinsics.data(), window.correction.data(),
                              line.data()};
    Eigen::Vector2d r;
    Eigen::Matrix<double, 2, kLineSize, Eigen::RowMajor> J_ambient;
    double* jacobians[] = {nullptr, nullptr, nullptr, J_ambient.data()};
    factor.Evaluate(blocks, r.data(), jacobians);
    double rho[3];
    loss.Evaluate(r.squaredNorm(), rho);
    const Eigen::Matrix<double, 2, 4> J = J_ambient * plus;
    normal.H += rho[1] * J.transpose() * J;
    normal.b += rho[1] * J.transpose() * r;
    normal.cost += 0.5 * rho[0];
  }
  return normal;
}

void refine(const SlidingWindow& window, const FactorParams& params, LineTrack& track) {
  const LineManifold manifold;
  LineNormal now = normalEquations(window, params, track, track.line);
  double damping = 1e-3;
  for (int i = 0; i < 10; ++i) {
    Eigen::Matrix4d H = now.H;
    H.diagonal() *= 1 + damping;
    H.diagonal().array() += 1e-9;
    const Eigen::Vector4d step = -H.ldlt().solve(now.b);
    LineBlock moved;
    manifold.Plus(track.line.data(), step.data(), moved.data());
    const LineNormal next = normalEquations(window, params, track, moved);
    if (next.cost < now.cost) {
      const bool converged = now.cost - next.cost < 1e-4 * now.cost;
      track.line = moved;
      now = next;
      damping *= 0.1;
      if (converged) break;
    } else {
      damping *= 10;
    }
  }
}

/// The ends of a sighting on the line, in the camera's frame. False when one of them is not in front of it.
bool endsInCamera(const SlidingWindow& window, const LineTrack& track, const LineSighting& s, Eigen::Vector3d ends_c[2]) {
  const Pose T_c_w = window.T_w_c(window.frame(s.frame)).inverse();
  const PluckerLine line = lineFromBlock(track.line.data()).plucker();
  const Eigen::Vector3d d_c = T_c_w.q * line.d, p_c = T_c_w * (track.origin_w + line.nearestPoint());
  const PluckerLine line_c{p_c.cross(d_c), d_c};
  const Eigen::Vector2d seen[2] = {s.start.corrected(window.correction.data()), s.end.corrected(window.correction.data())};
  for (int k = 0; k < 2; ++k)
    if (!closestPointToRay(line_c, seen[k], ends_c[k]) || ends_c[k].z() < 0.05) return false;
  return true;
}

/// Start from all observation planes [Lim2021, eq. make_plane]: d is what all normals are perpendicular to.
bool intersectPlanes(const SlidingWindow& window, LineTrack& track) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> planes;  // normal and camera centre
  for (const LineSighting& s : track.sightings) {
    const Pose T_w_c = window.T_w_c(window.frame(s.frame));
    const Eigen::Vector3d start = s.start.corrected(window.correction.data()).homogeneous();
    const Eigen::Vector3d end = s.end.corrected(window.correction.data()).homogeneous();
    const Eigen::Vector3d cross = start.cross(end);
    if (cross.norm() < 1e-6) return false;
    const Eigen::Vector3d n_w = T_w_c.q * cross.normalized();
    planes.emplace_back(n_w, T_w_c.p);
    normals += n_w * n_w.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normals);
  const Eigen::Vector3d d = solver.eigenvectors().col(0);
  // the point nearest to the newest camera that lies in all planes, in the plane perpendicular to d
  Eigen::Matrix3d A = d * d.transpose();
  Eigen::Vector3d b = d * d.dot(track.origin_w);
  for (const auto& [n_w, centre] : planes) {
    A += n_w * n_w.transpose();
    b += n_w * n_w.dot(centre);
  }
  if (solver.eigenvalues()[1] < 1e-12) return false;
  const Eigen::Vector3d p_w = A.ldlt().solve(b);
  if (!p_w.allFinite()) return false;
  track.line = toBlock(toOrthonormal(movedOrigin(lineThrough(p_w, p_w + d), track.origin_w)));
  return true;
}

}  // namespace

PluckerLine lineInWorld(const LineTrack& track) {
  return movedOrigin(lineFromBlock(track.line.data()).plucker(), -track.origin_w);
}

double lineError(const SlidingWindow& window, const LineTrack& track) {
  double sum = 0;
  Eigen::Vector3d ends[2];
  for (const LineSighting& s : track.sightings) {
    if (!endsInCamera(window, track, s, ends)) return std::numeric_limits<double>::infinity();
    const LineFactor factor(s.start, s.end, window.frame(s.frame).bodyMotion(), track.origin_w,
                            window.camera().meanFocal());
    const double* blocks[] = {window.frame(s.frame).pose.data(), window.extrinsics.data(), window.correction.data(),
                              track.line.data()};
    Eigen::Vector2d r;
    factor.Evaluate(blocks, r.data(), nullptr);
    sum += 0.5 * r.cwiseAbs().sum();
  }
  return track.sightings.empty() ? 0 : sum / static_cast<double>(track.sightings.size());
}

void updateLineUncertainty(const SlidingWindow& window, const EstimatorParams& params, LineTrack& track) {
  const LineNormal normal = normalEquations(window, params.factors, track, track.line);
  const OrthonormalLine line = lineFromBlock(track.line.data());
  const PluckerLine plucker = line.plucker();
  const LineSighting& last = track.sightings.back();
  const Pose T_w_c = window.T_w_c(window.frame(last.frame));
  Eigen::Vector3d ends_c[2] = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()};
  endsInCamera(window, track, last, ends_c);
  const Eigen::Vector3d middle_w = T_w_c * (0.5 * (ends_c[0] + ends_c[1]));
  const double along = (middle_w - track.origin_w).dot(plucker.d.normalized());
  const LineUncertainty uncertainty = uncertaintyOf(line, normal.H, along);
  track.sigma_direction_rad = uncertainty.direction_rad;
  track.sigma_distance_m = uncertainty.distance_m;
  const double depth = std::max(0.5 * (ends_c[0].z() + ends_c[1].z()), 0.1);
  track.degenerate = track.sigma_direction_rad > params.landmarks.line_max_sigma_direction_rad ||
                     track.sigma_distance_m > params.landmarks.line_max_sigma_distance * depth;
}

bool triangulateLine(const SlidingWindow& window, const EstimatorParams& params, LineTrack& track) {
  track.triangulated = false;
  if (track.sightings.size() < 2) return false;
  track.origin_w = window.T_w_c(window.frame(track.sightings.back().frame)).p;
  if (!intersectPlanes(window, track)) return false;
  // A line that is far from being determined is not worth refining: its cheap estimate says so already.
  updateLineUncertainty(window, params, track);
  constexpr double kHopeless = 3;
  if (track.sigma_direction_rad > kHopeless * params.landmarks.line_max_sigma_direction_rad) return track.triangulated = true;
  refine(window, params.factors, track);
  if (!(lineError(window, track) < params.landmarks.line_max_error_px)) return false;
  track.triangulated = true;
  updateLineUncertainty(window, params, track);
  return true;
}

void triangulateLines(SlidingWindow& window, const EstimatorParams& params) {
  for (auto& [id, track] : window.lines)
    if ((!track.triangulated || track.degenerate) &&
        static_cast<int>(track.sightings.size()) >= params.landmarks.line_min_observations)
      triangulateLine(window, params, track);
}

}  // namespace lintel
