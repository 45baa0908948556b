// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowCovariance.h"

#include <algorithm>
#include <limits>

#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/SmallMatrices.h"
#include "window/WindowGauge.h"

namespace lintel {

namespace {

constexpr int kStateTangent = kPoseTangent + kMotionSize;

using ByGauge = Eigen::Matrix<double, kStateTangent, 4>;

/// What a shift and a turn of the world do to pose and motion.
ByGauge byGauge(const WindowFrame& frame) {
  const Pose T = frame.T_w_b();
  ByGauge by = ByGauge::Zero();
  by.topLeftCorner<3, 3>().setIdentity();
  by.block<3, 1>(0, 3) = Eigen::Vector3d::UnitZ().cross(T.p);
  by.block<3, 1>(3, 3) = T.R().row(2).transpose();
  by.block<3, 1>(kPoseTangent + kVelocityAt, 3) = Eigen::Vector3d::UnitZ().cross(velocityOf(frame.motion.data()));
  return by;
}

BlockKey motionOf(const WindowFrame& frame) { return {BlockKey::kMotion, frame.id}; }

}  // namespace

WindowCovariance::WindowCovariance(NormalEquations information)
    : information_(std::move(information)), marginals_(information_, kInformationFloor) {}

Eigen::MatrixXd WindowCovariance::halves(const Eigen::MatrixXd& F_transposed) const {
  if (!ok()) return Eigen::MatrixXd::Zero(F_transposed.rows(), F_transposed.cols());
  return marginals_.halves(F_transposed);
}

void WindowCovariance::place(const BlockKey& key, const Eigen::MatrixXd& rows, Eigen::MatrixXd& F_transposed) const {
  const Eigen::Index at = marginals_.offsetOf(key);
  if (at >= 0) F_transposed.middleRows(at, rows.cols()) += rows.transpose();
}

const Eigen::MatrixXd& WindowCovariance::halvesOfDrift(const SlidingWindow& window) const {
  if (drift_of_ == window.frames.front().id) return halves_of_drift_;
  drift_of_ = window.frames.front().id;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  for (const auto& [key, rows] : window.drift.by_state) place(key, rows, F);
  place(poseOf(window.frames.front()), gaugeOf(window.frames.front()), F);
  return halves_of_drift_ = halves(F);
}

Eigen::Matrix4d WindowCovariance::independentDrift(const SlidingWindow& window) const {
  const Eigen::MatrixXd& half = halvesOfDrift(window);
  const SymmetricEigen<4> own = symmetricEigen<4>(window.drift.covariance - half.transpose() * half);
  return own.vectors * own.values.cwiseMax(0).asDiagonal() * own.vectors.transpose();
}

StateCovariance WindowCovariance::of(const SlidingWindow& window, const WindowFrame& frame) const {
  const ByGauge N = byGauge(frame);
  const Gauge held = gaugeOf(window.frames.front());
  Eigen::MatrixXd of_pose = Eigen::MatrixXd::Zero(marginals_.size(), kPoseTangent);
  Eigen::MatrixXd of_motion = Eigen::MatrixXd::Zero(marginals_.size(), kMotionSize);
  place(poseOf(frame), Eigen::MatrixXd::Identity(kPoseTangent, kPoseTangent), of_pose);
  place(motionOf(frame), Eigen::MatrixXd::Identity(kMotionSize, kMotionSize), of_motion);
  place(poseOf(window.frames.front()), -N.topRows<kPoseTangent>() * held, of_pose);
  place(poseOf(window.frames.front()), -N.bottomRows<kMotionSize>() * held, of_motion);
  Eigen::MatrixXd half(marginals_.size(), kStateTangent);
  half << halves(of_pose), halves(of_motion);  // motions come first in the equations: more to solve for
  half += halvesOfDrift(window) * N.transpose();
  return half.transpose() * half + N * independentDrift(window) * N.transpose();
}

double WindowCovariance::relativeScaleSigma(const SlidingWindow& window) const {
  const WindowFrame& oldest = window.frames.front();
  const auto moved = [&](const WindowFrame& frame) { return (frame.T_w_b().p - oldest.T_w_b().p).norm(); };
  const WindowFrame& farthest =
      *std::max_element(window.frames.begin(), window.frames.end(),
                        [&](const WindowFrame& a, const WindowFrame& b) { return moved(a) < moved(b); });
  const double distance = moved(farthest);
  if (distance == 0) return std::numeric_limits<double>::infinity();
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(1, kPoseTangent);
  along.leftCols<3>() = (farthest.T_w_b().p - oldest.T_w_b().p).transpose() / distance;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 1);
  place(poseOf(farthest), along, F);
  place(poseOf(oldest), -along, F);
  return halves(F).norm() / distance;
}

}  // namespace lintel
