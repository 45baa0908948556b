// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: the mean biases of the accelerometer, about which it has correlated noise. They walk, so that each
// stretch of time has a block of its own.
#include <cmath>
#include <limits>

#include "BatchProblem.h"
#include "BlockChange.h"
#include "lintel/estimator/StatePriors.h"

namespace lintel {

namespace {

constexpr double kMeanBiasLasts_s = 10;  // EuRoC's accelerometer walks .01 m/s^2 in it

}  // namespace

/// Each begins with an anchor, and with every piece another one: that may be of another recording, with other biases.
void BatchProblem::findMeanBiases() {
  std::int64_t start_ns = 0;
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    const bool late = isAnchor(k) && 1e-9 * static_cast<double>(keyframe.t_ns - start_ns) > kMeanBiasLasts_s;
    const bool begins = k == 0 || !keyframe.imu || late;
    if (begins) start_ns = keyframe.t_ns;
    mean_biases_.push_back(k == 0 ? 0 : mean_biases_.back() + (begins ? 1 : 0));
  }
}

/// As the mean of the keyframes' biases.
void BatchProblem::placeMeanBiases() {
  std::vector<double> counts(meanBiases(), 0);
  for (std::size_t k = 0; k < mean_biases_.size(); ++k) {
    Eigen::Map<MeanBiasBlock>(at(meanBiasAt(k))) += material_.keyframes[k].bias.accel;
    counts[mean_biases_[k]] += 1;
  }
  for (std::size_t i = 0; i < meanBiases(); ++i) {
    Eigen::Map<MeanBiasBlock>(at(meanBiasOf(i))) /= counts[i];
    problem_->AddParameterBlock(at(meanBiasOf(i)), kMeanBiasSize);
  }
}

/// From stretch to stretch; what is known about the first of a piece, and about its first keyframe's biases.
void BatchProblem::addMeanBiasWalk() {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  std::size_t begins = 0;  // the first keyframe of the stretch
  for (std::size_t k = 0; k < mean_biases_.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    const bool walks = k > 0 && keyframe.imu;
    if (walks && mean_biases_[k] == mean_biases_[k - 1]) continue;
    if (walks) {
      const double dt_s = 1e-9 * static_cast<double>(keyframe.t_ns - material_.keyframes[begins].t_ns);
      const double sigma = keyframe.imu->noise().accel_walk * std::sqrt(dt_s);
      own_factors_.push_back(std::make_unique<BlockChange<kMeanBiasSize>>(MeanBiasBlock::Constant(1 / sigma)));
      problem_->AddResidualBlock(own_factors_.back().get(), nullptr, at(meanBiasAt(k - 1)), at(meanBiasAt(k)));
    } else {
      own_factors_.push_back(makeMeanBiasPrior(Eigen::Vector3d::Zero(), estimator_.initializer));
      problem_->AddResidualBlock(own_factors_.back().get(), nullptr, at(meanBiasAt(k)));
      const bool goes_on = k + 1 < material_.keyframes.size() && material_.keyframes[k + 1].imu;
      const ImuNoise noise = goes_on ? material_.keyframes[k + 1].imu->noise() : material_.rig.imu_noise;
      own_factors_.push_back(
          makeFirstMotionPrior(MotionBlock::Zero(), kAny, estimator_.initializer.bias_gyro_sigma, noise));
      problem_->AddResidualBlock(own_factors_.back().get(), nullptr, at(motionAt(k)), at(meanBiasAt(k)));
    }
    begins = k;
  }
}

}  // namespace lintel
