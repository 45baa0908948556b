// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>

#include "DriftedFlight.h"

namespace lintel {
namespace {

class RefinedCalibrationTest : public test::DriftedFlight {};

TEST_F(RefinedCalibrationTest, TheOffsetBetweenTheClocksMayJump) {
  const FrameId middle = flight_.frames.size() / 2;
  delayStamps(middle, 0.006);
  estimator_.calibration.refine_time_offset = true;
  MapMaterial same = material_;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_NEAR(report.most_offset_s - report.least_offset_s, 0.006, 0.001);
  for (const RetiredKeyframe& keyframe : material_.keyframes) {
    const double from_middle_s = 0.05 * (static_cast<double>(keyframe.id) - static_cast<double>(middle));
    if (std::abs(from_middle_s) < 1) continue;  // the stretch that it jumps in
    EXPECT_NEAR(material_.time_offset_s + keyframe.offset_change_s, from_middle_s < 0 ? 0 : -0.006, 0.001)
        << keyframe.id;
  }
  params_.offset_walk_s = 0;
  refine(same);
  EXPECT_EQ(same.keyframes.front().offset_change_s, 0);
  EXPECT_LT(error(material_), 0.6 * error(same));
}

TEST_F(RefinedCalibrationTest, ARecordingThatWasMadeEarlierHasAnOffsetOfItsOwn) {
  MapMaterial earlier = material_;
  earlier.lines.clear();
  delayStamps(0, 0.003);
  estimator_.calibration.refine_time_offset = true;
  for (RetiredKeyframe& keyframe : earlier.keyframes) keyframe.t_ns -= 3'600'000'000'000;
  material_.pieces = separatePieces(material_), earlier.pieces = separatePieces(earlier);
  earlier.time_offset_s = 0.004;
  const std::size_t first = material_.keyframes.size();
  material_.trajectory.clear(), earlier.trajectory.clear();
  appendMaterial(earlier, material_);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  for (const std::size_t k : {std::size_t{0}, first - 1, first, material_.keyframes.size() - 1})
    EXPECT_NEAR(material_.time_offset_s + material_.keyframes[k].offset_change_s, k < first ? -0.003 : 0, 6e-4) << k;
}

/// The keyframes' IMU with another error of the accelerometer, by the time since the first one, and with noise.
void disturb(MapMaterial& material, double correlated, const std::function<Eigen::Vector3d(double)>& error) {
  ImuNoise noise;
  noise.accel_correlated = correlated;
  const std::int64_t start_ns = material.keyframes.front().t_ns;
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch samples = keyframe.imu->samples();
    for (ImuSample& sample : samples) sample.accel += error(1e-9 * static_cast<double>(sample.t_ns - start_ns));
    auto imu = std::make_shared<Preintegration>(keyframe.imu->bias(), noise);
    imu->append(samples);
    keyframe.imu = imu;
  }
}

TEST_F(RefinedCalibrationTest, AnErrorOfTheAccelerometerThatComesAndGoesIsNoMotion) {
  const auto error_b = [](double t_s) -> Eigen::Vector3d {
    return Eigen::Vector3d(std::sin(3 * t_s), 0, std::cos(2 * t_s)) * 0.1;
  };
  MapMaterial without = material_;
  disturb(material_, 0.07, error_b);
  disturb(without, 0, error_b);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted);
  EXPECT_LT(report.axes.cwiseAbs().maxCoeff(), 4 * estimator_.calibration.axes_angle_sigma_rad)
      << "nor a fault of its axes";
  refine(without);
  EXPECT_LT(error(material_), 0.6 * error(without));
}

/// An IMU whose samples f and w show the specific force f + A f and the rate w + G w.
void misalign(MapMaterial& material, const Eigen::Matrix3d& A, const Eigen::Matrix3d& G = Eigen::Matrix3d::Zero()) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch samples = keyframe.imu->samples();
    for (ImuSample& sample : samples) {
      sample.accel = (I + A).inverse() * sample.accel;
      sample.gyro = (I + G).inverse() * sample.gyro;
    }
    auto imu = std::make_shared<Preintegration>(keyframe.imu->bias(), keyframe.imu->noise());
    imu->append(samples);
    keyframe.imu = imu;
  }
}

Eigen::Matrix3d axesOfATelephone() {
  Eigen::Matrix3d axes;
  axes << 0.004, -0.02, 0, 0.05, -0.006, -0.03, -0.01, 0.02, 0.01;
  return axes;
}

TEST_F(RefinedCalibrationTest, WrongAxesOfTheAccelerometerAreFoundAndItsSamplesCorrected) {
  const Eigen::Matrix3d axes = axesOfATelephone();
  misalign(material_, axes);
  MapMaterial held = material_;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT((report.axes - axes).norm(), 0.5 * axes.norm()) << report.axes;
  EXPECT_NEAR(report.axes(1, 2), axes(1, 2), 0.003);  // of what varies most
  EXPECT_GT(report.scale_sigma, report.axes.norm() / 3) << "nor is its scale known better than its axes";
  estimator_.calibration.refine_axes = false;
  EXPECT_LT(refine(held).axes.norm(), 1e-6);
  const auto spread = [](const MapMaterial& m) {
    Eigen::Vector3d least = m.keyframes.front().bias.accel, most = least;
    for (const RetiredKeyframe& keyframe : m.keyframes) {
      least = least.cwiseMin(keyframe.bias.accel);
      most = most.cwiseMax(keyframe.bias.accel);
    }
    return (most - least).norm();
  };
  EXPECT_LT(spread(material_), 0.3 * spread(held)) << "what was taken for a bias that changes";
}

TEST_F(RefinedCalibrationTest, WrongAxesOfTheGyroscopeAreFound) {
  Eigen::Matrix3d G;
  G << 0.015, 0.01, 0, 0.01, -0.02, -0.01, 0, -0.01, 0.01;
  misalign(material_, Eigen::Matrix3d::Zero(), G);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT((report.gyro_axes - G).norm(), 0.3 * G.norm()) << report.gyro_axes;
  EXPECT_LT(report.axes.cwiseAbs().maxCoeff(), 0.01) << "the accelerometer's are right";
}

TEST_F(RefinedCalibrationTest, AxesBeyondThePriorOfACalibratedSensorAreHeldLessFirmly) {
  estimator_.calibration.axes_scale_sigma = 0.0004;
  estimator_.calibration.axes_angle_sigma_rad = 0.001;
  const auto found = [&](double share) {
    MapMaterial material = material_;
    misalign(material, share * axesOfATelephone());
    const RefinementReport report = refine(material);
    return report.axes(1, 2) / (share * axesOfATelephone()(1, 2));
  };
  EXPECT_GT(found(1), 4 * found(0.1)) << "one prior would find the same share of both";
}

TEST_F(RefinedCalibrationTest, EachRecordingHasAMeanBiasOfItsOwn) {
  MapMaterial other = material_;
  const Eigen::Vector3d bias(0.25, -0.2, 0.15);
  disturb(material_, 0.005, [](double) { return Eigen::Vector3d(0, 0, 0); });
  disturb(other, 0.005, [&](double) { return bias; });
  material_.pieces = separatePieces(material_), other.pieces = separatePieces(other);
  const std::size_t first = material_.keyframes.size();
  material_.trajectory.clear(), other.trajectory.clear();
  appendMaterial(other, material_);
  EXPECT_TRUE(refine(material_).accepted);
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k)
    EXPECT_LT((material_.keyframes[k].bias.accel - (k < first ? Eigen::Vector3d(0, 0, 0) : bias)).norm(), 0.04) << k;
}

TEST_F(RefinedCalibrationTest, AnOffsetThatStaysIsFoundTheSameAllTheTime) {
  delayStamps(0, 0.003);
  estimator_.calibration.refine_time_offset = true;
  const RefinementReport report = refine(material_);
  EXPECT_NEAR(material_.time_offset_s, -0.003, 3e-4);
  EXPECT_LT(report.most_offset_s - report.least_offset_s, 5e-4);
}

}  // namespace
}  // namespace lintel
