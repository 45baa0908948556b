// SPDX-License-Identifier: BSD-3-Clause
#include "SampleCorrection.h"

namespace lintel {

Eigen::Vector3d meanSpecificForce(const std::vector<RetiredKeyframe>& keyframes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const RetiredKeyframe& keyframe : keyframes) {
    if (!keyframe.imu) continue;
    for (const ImuSample& sample : keyframe.imu->samples()) sum += sample.accel;
    count += keyframe.imu->samples().size();
  }
  return count == 0 ? sum : sum / static_cast<double>(count);
}

void correctSamples(ImuAxes& axes, std::vector<RetiredKeyframe>& keyframes) {
  for (RetiredKeyframe& keyframe : keyframes) {
    if (keyframe.imu) keyframe.imu = std::make_shared<Preintegration>(withAxes(*keyframe.imu, axes));
    keyframe.axes = {};
  }
  axes = {};
}

}  // namespace lintel
