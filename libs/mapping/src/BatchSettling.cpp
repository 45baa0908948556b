// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: keyframes between the anchors.
#include <ceres/solver.h>

#include "BatchProblem.h"

namespace lintel {

bool BatchProblem::isAnchor(std::size_t k) const { return anchors_[k].main == k; }

double BatchProblem::anchorCount() const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < anchors_.size(); ++k) count += isAnchor(k);
  return static_cast<double>(count);
}

/// How the keyframe hangs on its anchors; as the material has them.
Carriage BatchProblem::carriage(std::size_t k) const {
  const std::vector<RetiredKeyframe>& all = material_.keyframes;
  const RetiredKeyframe &a = all[anchors_[k].main], &b = all[anchors_[k].other];
  return {all[k].T_w_b, a.T_w_b, b.T_w_b,
          static_cast<double>(all[k].t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns)};
}

/// Keyframes between the anchors, as these carry them.
void BatchProblem::carryAlong() {
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    if (isAnchor(k)) continue;
    const auto [a, b] = anchors_[k];
    const RetiredKeyframe &keyframe = material_.keyframes[k], &anchor = material_.keyframes[a];
    const Pose T_w_b = carriage(k).pose(poseFromBlock(at(poseAt(a))), poseFromBlock(at(poseAt(b))).p);
    Eigen::Map<PoseBlock>(at(poseAt(k))) = toBlock(T_w_b);
    Eigen::Map<MotionBlock> motion(at(motionAt(k)));
    motion << keyframe.v_w_b - anchor.v_w_b, keyframe.bias.gyro - anchor.bias.gyro,
        keyframe.bias.accel - anchor.bias.accel;
    motion += Eigen::Map<const MotionBlock>(at(motionAt(a)));
  }
}

/// Estimates the keyframes between the anchors from their own views and the IMU to both sides. They hang together only
/// from anchor to anchor, so that this costs little.
void BatchProblem::settle() {
  if (carried_views_.empty()) return;
  carryAlong();
  ceres::Problem problem(problemOptions());
  const auto hold = [&](double* block, int size) {
    problem.AddParameterBlock(block, size);
    problem.SetParameterBlockConstant(block);
  };
  hold(at(extrinsics_at_), kPoseSize);
  for (std::size_t i = 0; i < stretches(); ++i) hold(at(correctionOf(i)), kCorrectionSize);
  for (std::size_t i = 0; i < meanBiases(); ++i) hold(at(meanBiasOf(i)), kMeanBiasSize);
  for (std::size_t i = 0; i < points_.size(); ++i) hold(at(points_at_ + i * kPointSize), kPointSize);
  for (std::size_t i = 0; i < lines_.size(); ++i) hold(at(lines_at_ + i * kLineSize), kLineSize);
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    problem.AddParameterBlock(at(poseAt(k)), kPoseSize, poseManifold());
    problem.AddParameterBlock(at(motionAt(k)), kMotionSize);
    if (!isAnchor(k)) continue;
    problem.SetParameterBlockConstant(at(poseAt(k)));
    problem.SetParameterBlockConstant(at(motionAt(k)));
  }
  for (const auto& [k, factor] : imu_factors_)
    problem.AddResidualBlock(factor.get(), nullptr, at(poseAt(k - 1)), at(motionAt(k - 1)), at(poseAt(k)),
                             at(motionAt(k)), at(meanBiasAt(k - 1)));
  for (const CarriedResidual& r : carried_views_)
    problem.AddResidualBlock(r.factor, r.loss, at(poseAt(r.keyframe)), at(extrinsics_at_), at(correctionAt(r.keyframe)),
                             r.landmark);
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
