// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowCovariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr double kFloor = 1e-6;  // of the information: a sigma of a thousand, in any unit
constexpr int kStateTangent = kPoseTangent + kMotionSize;

using Gauge = Eigen::Matrix<double, 4, kPoseTangent>;
using ByGauge = Eigen::Matrix<double, kStateTangent, 4>;

/// The shift and the turn of the world that a pose's error amounts to.
Gauge gaugeOf(const WindowFrame& frame) {
  const Pose T = frame.T_w_b();
  Gauge gauge = Gauge::Zero();
  gauge.block<1, 3>(3, 3) = T.R().row(2);
  gauge.topLeftCorner<3, 3>().setIdentity();
  gauge.block<3, 3>(0, 3) = -Eigen::Vector3d::UnitZ().cross(T.p) * T.R().row(2);
  return gauge;
}

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

BlockKey poseOf(const WindowFrame& frame) { return {BlockKey::kPose, frame.id}; }
BlockKey motionOf(const WindowFrame& frame) { return {BlockKey::kMotion, frame.id}; }

}  // namespace

WindowCovariance::WindowCovariance(NormalEquations information)
    : information_(std::move(information)), marginals_(information_, kFloor) {}

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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> own(window.drift.covariance - half.transpose() * half);
  return own.eigenvectors() * own.eigenvalues().cwiseMax(0).asDiagonal() * own.eigenvectors().transpose();
}

StateCovariance WindowCovariance::start(SlidingWindow& window, FrameId first) const {
  const WindowFrame &oldest = window.frames.front(), &frame = window.frame(first);
  WorldDrift drift;
  drift.by_state[poseOf(frame)] = -gaugeOf(frame);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  place(poseOf(frame), gaugeOf(frame), F);
  place(poseOf(oldest), -gaugeOf(oldest), F);
  const Eigen::MatrixXd half = halves(F);
  drift.covariance = half.transpose() * half;
  window.drift = std::move(drift);
  drift_of_.reset();
  StateCovariance open = StateCovariance::Identity();  // without position and yaw
  open.topLeftCorner<3, 3>().setZero();
  const Eigen::Vector3d up_b = frame.T_w_b().R().row(2);
  open.block<3, 3>(3, 3) -= up_b * up_b.transpose();
  return open * of(window, frame) * open.transpose();
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

void WindowCovariance::holdNext(SlidingWindow& window) const {
  const WindowFrame &oldest = window.frames[0], &next = window.frames[1];
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  place(poseOf(next), gaugeOf(next), F);
  place(poseOf(oldest), -gaugeOf(oldest), F);
  const Eigen::MatrixXd half = halves(F) + halvesOfDrift(window);
  window.drift.covariance = independentDrift(window) + half.transpose() * half;
}

void WindowCovariance::forget(SlidingWindow& window, FrameId leaving) const {
  const auto leaves = [leaving](const BlockKey& key) {
    return key.kind == BlockKey::kDirection ||
           (key.id == leaving && (key.kind == BlockKey::kPose || key.kind == BlockKey::kMotion));
  };
  std::map<BlockKey, WorldDrift::Rows>& by_state = window.drift.by_state;
  if (std::none_of(by_state.begin(), by_state.end(), [&](const auto& entry) { return leaves(entry.first); })) return;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < information_.blocks.size(); ++i)
    for (Eigen::Index row = information_.offsets[i]; row < information_.offsets[i + 1]; ++row)
      if (leaves(information_.blocks[i])) rows.push_back(row);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  for (const auto& [key, columns] : by_state) place(key, columns, K);
  Eigen::MatrixXd H = information_.H(rows, rows);
  drift_of_.reset();
  H.diagonal().array() += kFloor;
  K -= information_.H(Eigen::all, rows) * H.llt().solve(Eigen::MatrixXd(K(rows, Eigen::all)));
  by_state.clear();
  for (std::size_t i = 0; i < information_.blocks.size(); ++i)
    if (!leaves(information_.blocks[i]))
      by_state[information_.blocks[i]] =
          K.middleRows(information_.offsets[i], information_.offsets[i + 1] - information_.offsets[i]).transpose();
}

}  // namespace lintel
