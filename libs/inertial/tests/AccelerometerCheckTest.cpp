// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/AccelerometerCheck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// Twelve seconds of a body that tilts by 15 degrees and shakes a little; `change` is what the file makes of it.
AccelerometerCheck checkOf(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& change,
                           double gravity_m_s2 = kGravity) {
  AccelerometerCheck check(gravity_m_s2);
  Eigen::Quaterniond R_w_b = Eigen::Quaterniond::Identity();
  ImuBatch batch;
  for (int i = 0; i < 2400; ++i) {
    const double t = i * 0.005;
    ImuSample sample;
    sample.t_ns = 1'000'000'000 + std::llround(1e9 * t);
    sample.gyro = Eigen::Vector3d(0.5 * std::cos(2 * t), 0.4 * std::cos(1.5 * t), 0.3);
    R_w_b = R_w_b * expRotation(sample.gyro * 0.005);
    sample.accel = change(R_w_b.conjugate() * Eigen::Vector3d(0.3 * std::sin(5 * t), 0.2 * std::sin(3 * t), 9.81));
    batch.push_back(sample);
    if (batch.size() == 21) {
      check.add(batch, Eigen::Vector3d::Zero());
      batch.assign(1, sample);
    }
  }
  return check;
}

TEST(AccelerometerCheck, NothingIsWrongWithAGoodOne) {
  const AccelerometerCheck check = checkOf([](const Eigen::Vector3d& f) { return f; });
  EXPECT_NEAR(check.gravity(), 9.81, 0.1);
  EXPECT_EQ(check.sizeFault(), "");
  EXPECT_EQ(check.axesMisfit(), 1);
  EXPECT_EQ(check.axesFault(), "");
}

TEST(AccelerometerCheck, UnitAndMissingGravityAreNamed) {
  EXPECT_NE(checkOf([](const Eigen::Vector3d& f) { return Eigen::Vector3d(f / 9.81); }).sizeFault().find("in g"),
            std::string::npos);
  const AccelerometerCheck linear = checkOf([](const Eigen::Vector3d& f) { return Eigen::Vector3d(0.02 * f); });
  EXPECT_NE(linear.sizeFault().find("taken out"), std::string::npos) << linear.sizeFault();
  EXPECT_NE(checkOf([](const Eigen::Vector3d& f) { return Eigen::Vector3d(2 * f); }).sizeFault().find("unit"),
            std::string::npos);
}

TEST(AccelerometerCheck, ViolentMotionIsNoWrongUnit) {
  double t_s = 0;
  const auto racing = [&](const Eigen::Vector3d& f) {
    t_s += 0.005;
    return Eigen::Vector3d(f.x() + 18 * std::sin(2.5 * t_s), f.y() + 18 * std::cos(2.2 * t_s), f.z());
  };
  const AccelerometerCheck check = checkOf(racing);
  EXPECT_GT(check.gravity(), 1.2 * 9.81);
  EXPECT_EQ(check.sizeFault(), "");
  for (const double unit : {1 / 9.81, 1.5, 3.28, 100.0}) {
    t_s = 0;
    const auto wrong = [&](const Eigen::Vector3d& f) { return Eigen::Vector3d(unit * racing(f)); };
    EXPECT_NE(checkOf(wrong).sizeFault(), "") << unit;
  }
}

TEST(AccelerometerCheck, GravityIsThatOfThePlace) {
  const auto onMars = [](const Eigen::Vector3d& f) { return Eigen::Vector3d(3.71 / 9.81 * f); };
  EXPECT_NE(checkOf(onMars).sizeFault().find("where gravity is 9.81"), std::string::npos);
  EXPECT_EQ(checkOf(onMars, 3.71).sizeFault(), "");
}

TEST(AccelerometerCheck, InterchangedAxesAreNamed) {
  const AccelerometerCheck check =
      checkOf([](const Eigen::Vector3d& f) { return Eigen::Vector3d(f.x(), f.z(), f.y()); });
  EXPECT_EQ(check.sizeFault(), "");
  EXPECT_NE(check.axesFault().find("x, z, y"), std::string::npos) << check.axesFault();
}

TEST(AccelerometerCheck, AWrongSignIsNamed) {
  const AccelerometerCheck check =
      checkOf([](const Eigen::Vector3d& f) { return Eigen::Vector3d(f.x(), f.y(), -f.z()); });
  EXPECT_EQ(check.sizeFault(), "");
  EXPECT_GT(check.axesMisfit(), 5);
  EXPECT_NE(check.axesFault().find("x, y, -z"), std::string::npos) << check.axesFault();
}

TEST(AccelerometerCheck, ValuesThatNeverChangeAreNamed) {
  const auto constant = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, 9.81); };
  EXPECT_NE(checkOf(constant).sizeFault().find("do not change"), std::string::npos);
}

TEST(AccelerometerCheck, SaysNothingWithoutData) {
  EXPECT_EQ(AccelerometerCheck().gravity(), 0);
  EXPECT_EQ(AccelerometerCheck().sizeFault(), "");
  EXPECT_EQ(AccelerometerCheck().axesFault(), "");
}

}  // namespace
}  // namespace lintel
