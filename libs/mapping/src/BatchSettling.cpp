// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: keyframes between the anchors.
#include <ceres/solver.h>

#include <algorithm>

#include "BatchProblem.h"

namespace lintel {

namespace {

constexpr double kCarriageScaleSigma = 0.1;  // the causal trajectory's scale is rarely farther off

}  // namespace

bool BatchProblem::isAnchor(std::size_t k) const { return anchors_[k].main == k; }

double BatchProblem::anchorCount() const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < anchors_.size(); ++k) count += isAnchor(k);
  return static_cast<double>(count);
}

/// How keyframes hang on their anchors; as the material has them.
void BatchProblem::findCarriages() {
  const std::vector<RetiredKeyframe>& all = material_.keyframes;
  carriages_.reserve(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const RetiredKeyframe &a = all[anchors_[k].main], &b = all[anchors_[k].other];
    const double share =
        isAnchor(k) ? 0 : static_cast<double>(all[k].t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    carriages_.emplace_back(all[k].T_w_b, a.T_w_b, b.T_w_b, share);
    runs_.push_back(k == 0 ? 0 : runs_.back() + (all[k].imu ? 0 : 1));
  }
}

void BatchProblem::placeCarriageScales() {
  for (std::size_t i = 0; i < carriageScales(); ++i) {
    *at(carriageScaleOf(i)) = 1;
    problem_->AddParameterBlock(at(carriageScaleOf(i)), kCarriageScaleSize);
  }
}

void BatchProblem::addCarriageScalePriors() {
  const auto manifold = std::make_shared<VectorManifold>(kCarriageScaleSize);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(kCarriageScaleSize);
  for (std::size_t i = 0; i < carriageScales(); ++i) {
    own_factors_.push_back(makeBlockPrior(manifold, one, kCarriageScaleSigma * one));
    problem_->AddResidualBlock(own_factors_.back().get(), nullptr, at(carriageScaleOf(i)));
  }
}

/// Keyframes between the anchors, as these carry them.
void BatchProblem::carryAlong() {
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    if (isAnchor(k)) continue;
    const auto [a, b] = anchors_[k];
    const RetiredKeyframe &keyframe = material_.keyframes[k], &anchor = material_.keyframes[a];
    const Pose T_w_b =
        carriages_[k].pose(poseFromBlock(at(poseAt(a))), poseFromBlock(at(poseAt(b))).p, *at(carriageScaleAt(k)));
    Eigen::Map<PoseBlock>(at(poseAt(k))) = toBlock(T_w_b);
    Eigen::Map<MotionBlock> motion(at(motionAt(k)));
    motion << keyframe.v_w_b - anchor.v_w_b, keyframe.bias.gyro - anchor.bias.gyro,
        keyframe.bias.accel - anchor.bias.accel;
    motion += Eigen::Map<const MotionBlock>(at(motionAt(a)));
  }
}

/// Estimates the keyframes between the anchors from their own views and the IMU to both sides. They hang together only
/// from anchor to anchor, so that a long flight can be done piece by piece.
void BatchProblem::settle() {
  constexpr std::size_t kTogether = 100;
  if (carried_views_.empty()) return;
  carryAlong();
  const std::size_t last = anchors_.size() - 1;
  for (std::size_t from = 0, to = 0; from < last; from = to) {
    to = std::min(from + kTogether, last);
    while (to < last && !isAnchor(to)) ++to;
    settleBetween(from, to);
  }
}

/// `from` and `to` are anchors.
void BatchProblem::settleBetween(std::size_t from, std::size_t to) {
  ceres::Problem problem(problemOptions());
  const auto hold = [&](double* block, int size) {
    problem.AddParameterBlock(block, size);
    problem.SetParameterBlockConstant(block);
  };
  hold(at(extrinsics_at_), kPoseSize);
  hold(at(axes_at_), kAxesSize);
  for (std::size_t k = from; k <= to; ++k) {
    hold(at(correctionAt(k)), kCorrectionSize);
    hold(at(meanBiasAt(k)), kMeanBiasSize);
    problem.AddParameterBlock(at(poseAt(k)), kPoseSize, poseManifold());
    problem.AddParameterBlock(at(motionAt(k)), kMotionSize);
    if (!isAnchor(k)) continue;
    problem.SetParameterBlockConstant(at(poseAt(k)));
    problem.SetParameterBlockConstant(at(motionAt(k)));
  }
  std::vector<std::unique_ptr<AxesImuFactor>> imu_factors;
  for (std::size_t k = from + 1; k <= to; ++k) {
    imu_factors.push_back(imuFactor(k));
    if (!imu_factors.back()) continue;
    problem.AddResidualBlock(imu_factors.back().get(), nullptr, at(poseAt(k - 1)), at(motionAt(k - 1)), at(poseAt(k)),
                             at(motionAt(k)), at(meanBiasAt(k - 1)), at(axes_at_));
  }
  for (const CarriedResidual& r : carried_views_) {
    if (r.keyframe <= from || r.keyframe >= to) continue;
    hold(r.landmark, r.landmark < at(lines_at_) ? kPointSize : kLineSize);
    problem.AddResidualBlock(r.factor, r.loss, at(poseAt(r.keyframe)), at(extrinsics_at_), at(correctionAt(r.keyframe)),
                             r.landmark);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 4;
  options.function_tolerance = 1e-3;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

}  // namespace lintel
