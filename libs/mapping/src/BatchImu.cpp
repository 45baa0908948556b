// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: the residuals of the IMU.
#include <cmath>
#include <limits>

#include "BatchProblem.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/inertial/StampJitter.h"

namespace lintel {

namespace {

constexpr double kMeanBiasLasts_s = 10;  // EuRoC's accelerometer walks .01 m/s^2 in it

/// By how much the mean bias walks from one stretch of time to the next, in standard deviations.
class MeanBiasWalk final : public ceres::SizedCostFunction<kMeanBiasSize, kMeanBiasSize, kMeanBiasSize> {
 public:
  explicit MeanBiasWalk(double sigma) : weight_(1 / sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const MeanBiasBlock> before(parameters[0]), after(parameters[1]);
    Eigen::Map<MeanBiasBlock>{residuals} = weight_ * (after - before);
    for (int i = 0; i < 2; ++i)
      if (jacobians && jacobians[i])
        Eigen::Map<Eigen::Matrix<double, kMeanBiasSize, kMeanBiasSize, Eigen::RowMajor>>{jacobians[i]} =
            Eigen::Matrix3d::Identity() * (i == 0 ? -weight_ : weight_);
    return true;
  }

 private:
  double weight_;
};

InertialState stateOf(const RetiredKeyframe& keyframe) { return {keyframe.T_w_b, keyframe.v_w_b, keyframe.bias}; }

}  // namespace

/// The jitter of the stamps at the ends of an interval, if there is some, as what the states are now says it.
void BatchProblem::countStamps(std::size_t from, std::size_t to, Preintegration& imu) const {
  const RetiredKeyframe &start = material_.keyframes[from], &end = material_.keyframes[to];
  if (const double sigma_s = end.imu->stampSigma(); sigma_s > 0)
    countStampJitter(sigma_s, stateOf(start), stateOf(end), imu);
}

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
      own_factors_.push_back(std::make_unique<MeanBiasWalk>(keyframe.imu->noise().accel_walk * std::sqrt(dt_s)));
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

void BatchProblem::addImu() {
  std::shared_ptr<Preintegration> whole;  // since the last anchor
  for (std::size_t k = 1; k < material_.keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    if (!keyframe.imu || keyframe.imu->dt_s() <= 0) continue;
    auto imu = std::make_shared<Preintegration>(*keyframe.imu);
    imu->repropagate(material_.keyframes[k - 1].bias);
    countStamps(k - 1, k, *imu);
    imu_factors_.emplace_back(k, std::make_unique<ImuFactor>(imu));
    if (whole) {
      whole->append(*imu);
    } else {
      whole = std::make_shared<Preintegration>(*imu);
    }
    if (!isAnchor(k)) continue;
    std::size_t from = k - 1;
    while (!isAnchor(from)) --from;
    whole->repropagate(material_.keyframes[from].bias);
    countStamps(from, k, *whole);
    anchor_imu_factors_.push_back(std::make_unique<ImuFactor>(whole));
    problem_->AddResidualBlock(anchor_imu_factors_.back().get(), nullptr, at(poseAt(from)), at(motionAt(from)),
                               at(poseAt(k)), at(motionAt(k)), at(meanBiasAt(from)));
    whole.reset();
  }
}

double BatchProblem::imuError() const {
  double sum = 0;
  for (const auto& [k, factor] : imu_factors_) {
    const double* blocks[] = {values_.data() + poseAt(k - 1), values_.data() + motionAt(k - 1),
                              values_.data() + poseAt(k), values_.data() + motionAt(k),
                              values_.data() + meanBiasAt(k - 1)};
    Eigen::Matrix<double, 15, 1> r;
    factor->Evaluate(blocks, r.data(), nullptr);
    sum += r.head<9>().squaredNorm();
  }
  return imu_factors_.empty() ? 0 : std::sqrt(sum / (9.0 * static_cast<double>(imu_factors_.size())));
}

}  // namespace lintel
