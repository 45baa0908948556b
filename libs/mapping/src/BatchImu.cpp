// SPDX-License-Identifier: BSD-3-Clause
// BatchProblem: the residuals of the IMU.
#include <cmath>

#include "BatchProblem.h"
#include "lintel/inertial/StampJitter.h"

namespace lintel {

namespace {

InertialState stateOf(const RetiredKeyframe& keyframe) { return {keyframe.T_w_b, keyframe.v_w_b, keyframe.bias}; }

}  // namespace

/// The jitter of the stamps at the ends of an interval, if there is some, as what the states are now says it.
void BatchProblem::countStamps(std::size_t from, std::size_t to, Preintegration& imu) const {
  const RetiredKeyframe &start = material_.keyframes[from], &end = material_.keyframes[to];
  if (const double sigma_s = end.imu->stampSigma(); sigma_s > 0)
    countStampJitter(sigma_s, stateOf(start), stateOf(end), imu);
}

/// From the keyframe before to this one, linearised at its biases in the material; none where no samples lead here.
std::unique_ptr<AxesImuFactor> BatchProblem::imuFactor(std::size_t k) const {
  const RetiredKeyframe& keyframe = material_.keyframes[k];
  if (!keyframe.imu || keyframe.imu->dt_s() <= 0) return nullptr;
  auto imu = std::make_shared<Preintegration>(*keyframe.imu);
  imu->repropagate(material_.keyframes[k - 1].bias);
  countStamps(k - 1, k, *imu);
  return std::make_unique<AxesImuFactor>(std::move(imu), material_.axes.mean_f);
}

void BatchProblem::addImu() {
  std::shared_ptr<Preintegration> whole;  // since the last anchor
  for (std::size_t k = 1; k < material_.keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = material_.keyframes[k];
    if (!keyframe.imu || keyframe.imu->dt_s() <= 0) continue;
    if (whole) {
      whole->append(*keyframe.imu);
    } else {
      whole = std::make_shared<Preintegration>(*keyframe.imu);
    }
    if (!isAnchor(k)) continue;
    std::size_t from = k - 1;
    while (!isAnchor(from)) --from;
    whole->repropagate(material_.keyframes[from].bias);
    countStamps(from, k, *whole);
    anchor_imu_factors_.push_back(std::make_unique<AxesImuFactor>(whole, material_.axes.mean_f));
    problem_->AddResidualBlock(anchor_imu_factors_.back().get(), nullptr, at(poseAt(from)), at(motionAt(from)),
                               at(poseAt(k)), at(motionAt(k)), at(meanBiasAt(from)), at(axes_at_));
    whole.reset();
  }
}

double BatchProblem::imuError() const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < material_.keyframes.size(); ++k) {
    const std::unique_ptr<AxesImuFactor> factor = imuFactor(k);
    if (!factor) continue;
    const double* blocks[] = {values_.data() + poseAt(k - 1),     values_.data() + motionAt(k - 1),
                              values_.data() + poseAt(k),         values_.data() + motionAt(k),
                              values_.data() + meanBiasAt(k - 1), values_.data() + axes_at_};
    Eigen::Matrix<double, 15, 1> r;
    factor->Evaluate(blocks, r.data(), nullptr);
    sum += r.head<9>().squaredNorm();
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / (9.0 * static_cast<double>(count)));
}

}  // namespace lintel
