// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationRemarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lintel {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::Not;

Rig rigWith(double line_delay_s) {
  Rig rig;
  rig.camera.height = 500;
  rig.line_delay_s = line_delay_s;
  return rig;
}

CalibrationEstimate found(double readout_s, double sigma_s) {
  CalibrationEstimate estimate;
  estimate.readout_s = readout_s;
  estimate.sigma = CalibrationSigma();
  estimate.sigma->readout_s = sigma_s;
  return estimate;
}

TEST(ReadoutRemark, NamesARollingShutterThatIsNotGiven) {
  const std::string text = readoutRemark(rigWith(0), found(0.02, 0.0002));
  EXPECT_THAT(text, HasSubstr("says nothing of a rolling shutter"));
  EXPECT_THAT(text, HasSubstr("20.0 ms from the first to the last (sigma 0.20 ms)"));
  EXPECT_THAT(text, HasSubstr("`line_delay_s: 4e-05`"));
}

TEST(ReadoutRemark, NamesAReadoutThatIsAnother) {
  EXPECT_THAT(readoutRemark(rigWith(20e-6), found(0.02, 0.0002)), HasSubstr("is wrong: the rows"));
}

TEST(ReadoutRemark, IsSilentWhereNothingContradicts) {
  EXPECT_THAT(readoutRemark(rigWith(0), found(0.0015, 0.0001)), IsEmpty());
  EXPECT_THAT(readoutRemark(rigWith(0), found(0.02, 0.005)), IsEmpty()) << "not observed";
  EXPECT_THAT(readoutRemark(rigWith(40e-6), found(0.0205, 0.0002)), IsEmpty());
  EXPECT_THAT(readoutRemark(rigWith(0), {}), IsEmpty()) << "no window";
}

TEST(AxesRemark, GivesAxesThatAreWrong) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  axes(1, 0) = 0.047;
  axes(2, 2) = -0.004;
  const std::string text = accelerometerAxesRemark({}, axes);
  EXPECT_THAT(text, HasSubstr("wrong by up to 4.7 %"));
  EXPECT_THAT(text, HasSubstr("[0.0000, 0.0000, 0.0000, 0.0470, 0.0000, 0.0000, 0.0000, 0.0000, -0.0040]"));
  AxesErrors given;
  given.A(1, 0) = 0.04;
  EXPECT_THAT(accelerometerAxesRemark(given, axes), IsEmpty()) << "nearly what was given";
}

TEST(AxesRemark, AxesThatNoSensorHasAreNotAdvised) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  A(0, 1) = -0.27;
  const std::string text = accelerometerAxesRemark({}, A);
  EXPECT_THAT(text, HasSubstr("27 %"));
  EXPECT_THAT(text, HasSubstr("its bias may change fast"));
  EXPECT_THAT(text, Not(HasSubstr("accelerometer_axes:")));
}

TEST(AxesRemark, TheGyroscopesAreSaidFromOnePerCentOn) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  G(0, 2) = G(2, 0) = 0.009;
  EXPECT_THAT(gyroscopeAxesRemark({}, G), IsEmpty());
  G(1, 1) = -0.021;
  const std::string text = gyroscopeAxesRemark({}, G);
  EXPECT_THAT(text, HasSubstr("gyroscope's axes are wrong by up to 2.1 %"));
  EXPECT_THAT(text, HasSubstr("`gyroscope_axes: [0.0000, 0.0000, 0.0090, 0.0000, -0.0210, 0.0000, 0.0090,"));
  AxesErrors given;
  given.G = G;
  EXPECT_THAT(gyroscopeAxesRemark(given, G), IsEmpty());
}

TEST(StampRemark, SaysHowFarStampsAreOff) {
  CalibrationEstimate estimate;
  EXPECT_THAT(stampRemark(estimate), IsEmpty());
  estimate.stamp_jitter_s = 0.0023;
  EXPECT_THAT(stampRemark(estimate), HasSubstr("off by 2.3 ms"));
}

}  // namespace
}  // namespace lintel
