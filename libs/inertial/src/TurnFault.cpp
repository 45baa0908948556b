// SPDX-License-Identifier: BSD-3-Clause
#include "TurnFault.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "lintel/core/Formatted.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kLargestSigma = 0.1;         // of an entry of M: 6 degrees, 10 %
constexpr double kSignificantTurn = 4;        // standard deviations
constexpr double kLargestTurned_deg = 5;      // a calibration that is only roughly known is off by 3
constexpr double kMountedOtherwise_deg = 20;  // beyond any calibration, and any error of the images' turns
constexpr double kSameTurn_deg = 15;          // two rotations that mean the same cause
constexpr double kLargestScale = 1.15;  // a focal length that is only roughly known is off by 2 %, a gyroscope by 3 %

double degreesBetween(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  return kDegrees * Eigen::AngleAxisd(A.transpose() * B).angle();
}

/// The orthogonal matrix that is nearest to a matrix; its determinant may be -1.
Eigen::Matrix3d nearestOrthogonal(const Eigen::Matrix3d& M) {
  const SingularValues3 svd = singularValues(M);
  return svd.U * svd.V.transpose();
}

/// Which columns of the file an IMU's axes are, for a matrix that leads from what the file says to what is: the nearest
/// interchange of axes and signs; empty when none is near, or nothing is interchanged.
std::string columnsOf(const Eigen::Matrix3d& given_to_true) {
  std::array<int, 3> column{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      std::string order;
      for (int i = 0; i < 3; ++i) {
        const bool minus = (signs >> i & 1) != 0;
        P(i, column[static_cast<std::size_t>(i)]) = minus ? -1 : 1;
        order += std::string(i ? ", " : "") + (minus ? "-" : "") + "xyz"[column[static_cast<std::size_t>(i)]];
      }
      if (P.determinant() * given_to_true.determinant() < 0 || P.isIdentity()) continue;
      if (degreesBetween(P, given_to_true) < kSameTurn_deg) return order;
    }
  } while (std::next_permutation(column.begin(), column.end()));
  return {};
}

std::string scaleFault(double scale) {
  if (std::abs(std::log(scale * kDegrees)) < std::log(kLargestScale)) {
    return "the gyroscope's values are in degrees/s, not in rad/s";
  }
  return formatted(
      "the images turn %.2f times as much as the gyroscope: check its unit (rad/s), the rate of its stamps and "
      "the focal length",
      scale);
}

/// Q: by which rotation the camera's axes are off, in its own axes; R: from the camera to the body, as calibrated.
std::string rotationFault(const Eigen::Matrix3d& Q, const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(Q);
  const double degrees = kDegrees * turn.angle();
  const Eigen::Vector3d axis = turn.axis().cwiseAbs();
  const char* about = axis.z() > 0.9   ? " about its viewing axis"
                      : axis.x() > 0.9 ? " about its x axis"
                      : axis.y() > 0.9 ? " about its y axis"
                                       : "";
  std::string fault =
      formatted("the camera seems to be turned by about %.0f degrees%s against what T_BS says", degrees, about);
  const std::string columns = columnsOf(R * Q * R.transpose());
  if (kDegrees * Eigen::AngleAxisd(R).angle() > kSameTurn_deg && degreesBetween(Q, R * R) < kSameTurn_deg)
    return fault +
           ": T_BS may be the inverse of what is asked for (it maps from the camera to the IMU), or the images " +
           "are upside down";
  for (const int flipped : {0, 1}) {
    Eigen::Vector3d mirror(-1, -1, -1);
    mirror[flipped == 0 ? 0 : 1] = 1;
    if (degreesBetween(Q, mirror.asDiagonal().toDenseMatrix()) < kSameTurn_deg)
      return std::string("the images seem to be mirrored ") + (flipped == 0 ? "left-right" : "top-bottom") +
             ", or the camera looks the other way than T_BS says";
  }
  if (degreesBetween(Q, Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix()) < kSameTurn_deg)
    return fault + ": check T_BS, and whether the images are upside down";
  if (degrees < 45) return fault + ": check T_BS, and the image centre (cx, cy)";
  return fault + ": check T_BS and how the camera is mounted" +
         (columns.empty() ? "" : ", or the IMU's axes: x, y, z seem to be its columns " + columns);
}

}  // namespace

std::string faultOf(const TurnFit& fit, const Eigen::Quaterniond& R_b_c, Suspicion suspicion) {
  Eigen::Matrix3d M = fit.M;
  const double sigma = fit.sigma.maxCoeff();
  if (!(sigma < kLargestSigma * std::max(M.norm(), 1e-3))) return {};
  const Eigen::Matrix3d R = R_b_c.toRotationMatrix();
  const Eigen::Matrix3d Q = nearestOrthogonal(M);
  const Eigen::Vector3d gain = (M * Q.transpose()).diagonal();  // about the camera's axes, as the images show them
  const double scale = std::cbrt(std::abs(M.determinant()));
  const bool scaled = std::abs(std::log(scale)) > std::log(2.0);
  if (scaled) return scaleFault(scale);
  if (Q.determinant() < 0) {
    const std::string columns = columnsOf(R * Q * R.transpose());
    return "the gyroscope's axes are left-handed: two of them are interchanged or a sign is wrong" +
           (columns.empty() ? "" : "; x, y, z seem to be its columns " + columns);
  }
  const double largest_deg = suspicion == Suspicion::kNone ? kMountedOtherwise_deg : kLargestTurned_deg;
  if (kDegrees * (Eigen::AngleAxisd(Q).angle() - kSignificantTurn * sigma) > largest_deg) return rotationFault(Q, R);
  if (suspicion == Suspicion::kNone) return {};
  const double focal = std::sqrt(std::abs(gain.x() * gain.y())) / gain.z();
  if (std::abs(std::log(focal)) > std::log(kLargestScale) + kSignificantTurn * sigma) {
    return formatted(
        "the focal length (or the distortion) seems to be wrong, as if it were %.0f %% too %s: turns about "
        "the image's axes come out as %.2f times those "
        "about the viewing axis",
        100 * std::abs(1 / focal - 1), focal < 1 ? "long" : "short", focal);
  }
  if (std::abs(std::log(scale)) > std::log(kLargestScale) + kSignificantTurn * sigma) return scaleFault(scale);
  return {};
}

}  // namespace lintel
