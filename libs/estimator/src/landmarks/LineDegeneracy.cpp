// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/LineDegeneracy.h"

#include <algorithm>
#include <cmath>

#include "lintel/geometry/SmallLeastSquares.h"

namespace lintel {

LineUncertainty uncertaintyOf(const OrthonormalLine& line, const Eigen::Matrix4d& information, double along_m) {
  // The axes of U: u1 normal of the plane through origin and line, u2 the direction, -u3 towards the line.
  // U Exp(psi): the direction moves by psi_x along u3 and -psi_z along u1; the foot -r u3 with r = cot(phi) likewise.
  const double sine = std::sin(line.phi), r = std::cos(line.phi) / sine;
  Eigen::Matrix<double, 2, 4> direction, position;
  direction << 0, 0, -1, 0, 1, 0, 0, 0;
  position << 0, -r, -along_m, 0, along_m, 0, 0, 1 / (sine * sine);
  const Eigen::Matrix4d covariance = covarianceOf(information);
  return {worstSigma(direction * covariance * direction.transpose()),
          worstSigma(position * covariance * position.transpose())};
}

double planeSigma(const CameraPoses& poses, const FactorParams& params, const LineSighting& s,
                  const Eigen::Vector3d& d_w) {
  const Eigen::Vector3d d_c = poses.T_w_c(s.frame).q.conjugate() * d_w;
  const Eigen::Vector3d start = s.start.corrected(poses.correction()).normalized();
  const Eigen::Vector3d end = s.end.corrected(poses.correction()).normalized();
  // each end moves across the line by sigma: the plane turns about the other one
  const double sigma_ray = params.line_sigma_px * s.sigma_px / poses.camera().meanFocal();
  return sigma_ray * std::hypot(start.cross(d_c).norm(), end.cross(d_c).norm()) /
         std::max(start.cross(end).norm(), 1e-6);
}

double epipoleAngle(const CameraPoses& poses, const LineTrack& track) {
  const LineSighting& newest = track.sightings.back();
  const Pose& T_w_c = poses.T_w_c(newest.frame);
  Eigen::Vector3d baseline_w = Eigen::Vector3d::Zero();
  for (const LineSighting& s : track.sightings) {
    const Eigen::Vector3d way_w = poses.T_w_c(s.frame).p - T_w_c.p;
    if (way_w.norm() > baseline_w.norm()) baseline_w = way_w;
  }
  const Eigen::Vector3d n_c =
      newest.start.corrected(poses.correction()).cross(newest.end.corrected(poses.correction()));
  const double sine = (T_w_c.q * n_c).dot(baseline_w) / std::max(n_c.norm() * baseline_w.norm(), 1e-12);
  return std::asin(std::min(1.0, std::abs(sine)));
}

LineVerdict judgeLine(const CameraPoses& poses, const DegeneracyParams& params, const LineTrack& track,
                      double depth_m) {
  if (params.test != "observability" && epipoleAngle(poses, track) < params.max_epipole_angle_rad)
    return LineVerdict::kThroughEpipole;
  if (params.test == "epipole") return LineVerdict::kGood;
  if (track.sigma_direction_rad > params.max_sigma_direction_rad) return LineVerdict::kDirectionUnknown;
  if (track.sigma_distance_m > params.max_sigma_distance * depth_m) return LineVerdict::kDistanceUnknown;
  return LineVerdict::kGood;
}

bool entersProblem(const LineTrack& track, const DegeneracyParams& params) {
  if (!track.triangulated) return false;
  return !track.degenerate() || params.lines == "use" || (params.lines == "constrain" && track.group != 0);
}

}  // namespace lintel
