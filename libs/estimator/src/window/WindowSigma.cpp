// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowSigma.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "solver/ReducedSystem.h"
#include "window/WindowFactors.h"

namespace lintel {

namespace {

NormalEquations informationOf(SlidingWindow& window, const EstimatorParams& params, const Pose& T_b_c_calibrated) {
  WindowFactors factors(window, params.factors);
  factors.addAll(params, T_b_c_calibrated);
  ReducedSystem system(window, factors.factors(), {}, {});
  system.linearise();
  return system.eliminate();
}

/// Marginal standard deviations of single blocks: from the diagonal of the inverse of the whole information.
class Marginals {
 public:
  explicit Marginals(const NormalEquations& equations) : equations_(equations) {
    constexpr double kFloor = 1e-6;  // instead of an inverse that fails: a sigma of 1000
    Eigen::MatrixXd H = equations.H;
    H.diagonal().array() += kFloor;
    llt_.compute(H);
  }

  /// Empty when the problem has no such block.
  Eigen::VectorXd of(const BlockKey& key) const {
    const auto found = std::find(equations_.blocks.begin(), equations_.blocks.end(), key);
    if (found == equations_.blocks.end() || llt_.info() != Eigen::Success) return {};
    const auto i = static_cast<std::size_t>(found - equations_.blocks.begin());
    const Eigen::Index at = equations_.offsets[i], size = equations_.offsets[i + 1] - at;
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(equations_.H.rows(), size);
    unit.middleRows(at, size).setIdentity();
    const Eigen::MatrixXd columns = llt_.solve(unit);
    return columns.middleRows(at, size).diagonal().cwiseMax(0).cwiseSqrt();
  }

 private:
  const NormalEquations& equations_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace

WindowSigma windowSigma(const SlidingWindow& window, const EstimatorParams& params, const Pose& T_b_c_calibrated) {
  SlidingWindow copy = window;  // a system may move the blocks it is given
  const NormalEquations equations = informationOf(copy, params, T_b_c_calibrated);
  const Marginals marginals(equations);
  WindowSigma sigma;
  const Eigen::VectorXd motion = marginals.of({BlockKey::kMotion, window.frames.back().id});
  if (motion.size() == kMotionSize) sigma.bias = {motion.segment<3>(kBiasGyroAt), motion.segment<3>(kBiasAccelAt)};
  const Eigen::VectorXd pose = marginals.of({BlockKey::kExtrinsics, 0});
  if (params.calibration.refine_extrinsics && pose.size() == kPoseTangent) {
    sigma.calibration.p_b_c_m = pose.head<3>();
    sigma.calibration.R_b_c_rad = pose.tail<3>();
  }
  const Eigen::VectorXd correction = marginals.of({BlockKey::kCorrection, 0});
  if (correction.size() != kCorrectionSize) return sigma;
  if (params.calibration.refine_camera) sigma.calibration.camera = correction.head<6>();
  if (params.calibration.refine_time_offset) sigma.calibration.time_offset_s = correction[kTimeOffsetAt];
  return sigma;
}

}  // namespace lintel
