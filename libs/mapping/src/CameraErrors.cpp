// SPDX-License-Identifier: BSD-3-Clause
#include "CameraErrors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lintel/factors/LineDistances.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallLeastSquares.h"
#include "lintel/geometry/SmallMatrices.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

BodyErrors::BodyErrors(std::vector<Pose> T_w_b, std::vector<std::int64_t> t_ns)
    : T_w_b_(std::move(T_w_b)), t_ns_(std::move(t_ns)), errors_(T_w_b_.size(), Draws::Zero()) {}

void BodyErrors::set(std::size_t keyframe, const Draws& tangent) {
  errors_[keyframe].topRows<3>() = tangent.topRows<3>();
  errors_[keyframe].bottomRows<3>() = T_w_b_[keyframe].R() * tangent.bottomRows<3>();
}

void BodyErrors::interpolate(const std::vector<std::size_t>& set) {
  for (std::size_t i = 0; i + 1 < set.size(); ++i)
    for (std::size_t k = set[i] + 1; k < set[i + 1]; ++k) {
      const double share =
          static_cast<double>(t_ns_[k] - t_ns_[set[i]]) / static_cast<double>(t_ns_[set[i + 1]] - t_ns_[set[i]]);
      errors_[k] = (1 - share) * errors_[set[i]] + share * errors_[set[i + 1]];
    }
}

void BodyErrors::align() {
  const auto n = static_cast<double>(errors_.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Pose& T : T_w_b_) centre += T.p / n;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, kErrorDraws> shift, moment;
  shift.setZero(), moment.setZero();
  for (std::size_t k = 0; k < errors_.size(); ++k) {
    const Eigen::Matrix3d arm = skew(T_w_b_[k].p - centre);
    H += arm.transpose() * arm;
    shift += errors_[k].topRows<3>() / n;
    moment += arm * errors_[k].topRows<3>();
  }
  // about a straight way nothing can be said of the turn
  const SymmetricEigen<3> eigen = symmetricEigen(H);
  Eigen::Matrix<double, 3, kErrorDraws> turn = Eigen::Matrix<double, 3, kErrorDraws>::Zero();
  for (int i = 0; i < 3; ++i)
    if (eigen.values[i] > 1e-4 * eigen.values[2])
      turn += eigen.vectors.col(i) * (eigen.vectors.col(i).transpose() * moment / eigen.values[i]);
  for (std::size_t k = 0; k < errors_.size(); ++k) {
    errors_[k].topRows<3>() -= shift - skew(T_w_b_[k].p - centre) * turn;
    errors_[k].bottomRows<3>() -= turn;
  }
}

std::vector<CameraErrors> BodyErrors::ofCamera(const Pose& T_b_c, const Draws& extrinsics) const {
  std::vector<CameraErrors> result;
  for (std::size_t k = 0; k < errors_.size(); ++k) {
    const Eigen::Matrix3d R_w_b = T_w_b_[k].R();
    const auto turn = errors_[k].bottomRows<3>();
    CameraErrors camera;
    camera.topRows<3>() =
        (errors_[k].topRows<3>() - skew(R_w_b * T_b_c.p) * turn + R_w_b * extrinsics.topRows<3>()).cast<float>();
    camera.bottomRows<3>() = (turn + R_w_b * T_b_c.R() * extrinsics.bottomRows<3>()).cast<float>();
    result.push_back(camera);
  }
  return result;
}

double scaleSigma(const MapMaterial& material) {
  if (material.camera_errors.empty()) return 0;
  std::vector<Eigen::Vector3d> centres_w;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const RetiredKeyframe& keyframe : material.keyframes) {
    centres_w.push_back(keyframe.T_w_b * material.rig.T_b_c.p);
    middle += centres_w.back() / static_cast<double>(material.keyframes.size());
  }
  double squares = 0;
  Eigen::Matrix<double, 1, kErrorDraws> along = Eigen::Matrix<double, 1, kErrorDraws>::Zero();
  for (std::size_t k = 0; k < centres_w.size(); ++k) {
    const Eigen::Vector3d arm = centres_w[k] - middle;
    squares += arm.squaredNorm();
    along += arm.transpose() * material.camera_errors[k].topRows<3>().cast<double>();
  }
  return squares > 0 ? along.norm() / squares / std::sqrt(static_cast<double>(kErrorDraws)) : 0;
}

namespace {

/// What holds a tied line beside its views.
Eigen::Matrix4d informationOf(const LineTie& tie, const LineEstimate& line) {
  const Eigen::Matrix2d across = (tangentBasis(tie.direction_w).transpose() * tangentBasis(line.direction_w)).eval();
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  H.bottomRightCorner<2, 2>() = across.transpose() * across / (tie.sigma_rad * tie.sigma_rad);
  for (const PointOnLine& point : tie.points) {
    Eigen::Matrix<double, 2, 4> J;
    J << Eigen::Matrix2d::Identity(), line.direction_w.dot(point.p_w - line.middle_w) * Eigen::Matrix2d::Identity();
    H += J.transpose() * J / (point.sigma_m * point.sigma_m);
  }
  return H;
}

}  // namespace

Eigen::Matrix4d covarianceByCameras(const KeyframeCameras& cameras, const std::vector<CameraErrors>& errors,
                                    const LineRecord& line) {
  if (errors.empty()) return Eigen::Matrix4d::Zero();
  const Eigen::Vector3d &m = line.estimate.middle_w, &d = line.estimate.direction_w;
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(d);
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, kErrorDraws> b = Eigen::Matrix<double, 4, kErrorDraws>::Zero();
  for (const LineView& v : line.views) {
    if (!v.inlier || !cameras.contains(v.keyframe)) continue;
    const Eigen::Matrix3d& R_c_w = cameras.R_c_w(v.keyframe);
    const Eigen::Vector3d arm = m - cameras.T_w_c(v.keyframe).p, l_w = arm.cross(d);
    const Eigen::Vector3d ends[2] = {cameras.ray(v.start_px.cast<double>()), cameras.ray(v.end_px.cast<double>())};
    const double weight = cameras.camera().meanFocal() / std::max(0.1, static_cast<double>(v.sigma_px));
    const LineDistances distances(ends, R_c_w * l_w, weight, cameras.camera().wide());
    Eigen::Matrix<double, 3, 4> l_by_line;  // world axes
    for (int k = 0; k < 2; ++k) {
      l_by_line.col(k) = B.col(k).cross(d);
      l_by_line.col(2 + k) = arm.cross(B.col(k));
    }
    // l_c = R_c_w Exp(-turn) ((m - p - shift) x d)
    Eigen::Matrix<double, 3, 6> l_by_camera;
    l_by_camera << skew(d), skew(l_w);
    Eigen::Matrix<double, 2, 3> by_l;
    by_l << distances.d_l[0] * R_c_w, distances.d_l[1] * R_c_w;
    const Eigen::Matrix<double, 2, 4> J = by_l * l_by_line;
    H += J.transpose() * J;
    b += J.transpose() * (by_l * l_by_camera * errors[cameras.placeOf(v.keyframe)].cast<double>());
  }
  if (line.tie) H += informationOf(*line.tie, line.estimate);
  const double scale_m = std::max(line.distance_m, 0.1);
  Eigen::Vector4d unit;
  unit << scale_m, scale_m, 1, 1;
  const Eigen::Matrix4d inverse =
      unit.asDiagonal() * covarianceOf(unit.asDiagonal() * H * unit.asDiagonal()) * unit.asDiagonal();
  const Eigen::Matrix<double, 4, kErrorDraws> moved = inverse * b;
  return moved * moved.transpose() / kErrorDraws;
}

}  // namespace lintel
