// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/geometry/Camera.h"
#include "lintel/geometry/PluckerLine.h"
#include "lintel/geometry/Pose.h"
#include "lintel/inertial/ImuAxes.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

// Parameter blocks as Ceres sees them (arrays of double) and their tangent spaces:
//
//   pose       7 -> 6   p_a_b [m], then R_a_b as quaternion x y z w; p += dp, R <- R Exp(dtheta)
//   motion     9        v_w_b [m/s], bias_gyro [rad/s], bias_accel [m/s^2]
//   line       5 -> 4   orthonormal line (PluckerLine.h): U as quaternion x y z w, phi; U <- U Exp(dpsi), phi += dphi.
//                       World axes; the moment is about a constant point near the line (LineFactor.h)
//   point      4 -> 3   homogeneous point (X, w) of unit length: X / w [m] in world axes from a constant origin
//   direction  3 -> 2   unit vector, world axes: the direction that a group of lines shares; d <- (d + B delta) / norm
//                       with B = tangentBasis(d)
//   correction 8        what the calibrated camera is wrong by: fx fy cx cy [px], k1 k2, readout [s], time offset [s]
//   mean bias  3        what bias_accel is without correlated noise [m/s^2] (ImuNoise)
//   axes       15       what the IMU's axes are wrong by (ImuAxes.h): A row by row, then xx yy zz xy xz yz of G
constexpr int kPoseSize = 7, kPoseTangent = 6;
constexpr int kMotionSize = 9, kVelocityAt = 0, kBiasGyroAt = 3, kBiasAccelAt = 6;
constexpr int kLineSize = 5, kLineTangent = 4;
constexpr int kPointSize = 4, kPointTangent = 3;
constexpr int kDirectionSize = 3, kDirectionTangent = 2;
constexpr int kCorrectionSize = 8, kReadoutAt = 6, kTimeOffsetAt = 7;
constexpr int kMeanBiasSize = 3;
constexpr int kAxesSize = 15, kGyroAxesAt = 9;

/// The part of a correction that a sighting depends on by itself: all but the time offset, which moves the camera of a
/// whole image.
constexpr int kSightingCorrection = 7;

using PoseBlock = Eigen::Matrix<double, kPoseSize, 1>;
using MotionBlock = Eigen::Matrix<double, kMotionSize, 1>;
using PointBlock = Eigen::Matrix<double, kPointSize, 1>;
using LineBlock = Eigen::Matrix<double, kLineSize, 1>;
using DirectionBlock = Eigen::Matrix<double, kDirectionSize, 1>;
using MeanBiasBlock = Eigen::Matrix<double, kMeanBiasSize, 1>;
using AxesBlock = Eigen::Matrix<double, kAxesSize, 1>;
using CorrectionBlock = Eigen::Matrix<double, kCorrectionSize, 1>;

/// The part of a correction that changes the ray of a pixel; readout and time offset move the pose (FrameMotion.h).
using IntrinsicsBlock = Eigen::Matrix<double, kIntrinsicsSize, 1>;
inline IntrinsicsBlock intrinsicsOf(const double* correction) { return IntrinsicsBlock::Map(correction); }

/// d normalised observation / d intrinsics: how one image observation moves with the camera correction.
using ObservationJacobian = Eigen::Matrix<double, 2, kIntrinsicsSize>;

PoseBlock toBlock(const Pose& pose);
Pose poseFromBlock(const double* b);
LineBlock toBlock(const OrthonormalLine& line);
OrthonormalLine lineFromBlock(const double* b);
AxesBlock toBlock(const ImuAxes& axes);
ImuAxes axesFromBlock(const double* b, const Eigen::Vector3d& mean_f);
Eigen::Vector3d velocityOf(const double* motion);
ImuBias biasOf(const double* motion);

/// The calibrated camera with a correction block added.
inline Camera correctedCamera(const Camera& calibrated, const double* correction) {
  Camera camera = calibrated;
  camera.fx += correction[0];
  camera.fy += correction[1];
  camera.cx += correction[2];
  camera.cy += correction[3];
  camera.lens[0] += correction[4];
  camera.lens[1] += correction[5];
  return camera;
}

/// Maps a right perturbation to quaternion coefficients: dq (x y z w) = rotationPlus(q) * dtheta.
Eigen::Matrix<double, 4, 3> rotationPlus(const Eigen::Quaterniond& q);

/// The left inverse of rotationPlus: dtheta = rotationLift(q) * dq. Turns a Jacobian with respect to dtheta into one
/// with respect to the four coefficients, as Ceres expects it.
Eigen::Matrix<double, 3, 4> rotationLift(const Eigen::Quaterniond& q);

}  // namespace lintel
