// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/TurnCheck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A camera that looks along the IMU's x axis, its own x axis to the IMU's right: not any of the axes is the same.
const Eigen::Quaterniond kR_b_c((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());

Eigen::Vector3d rateAt(double t_s) {
  return {0.4 * std::sin(2.1 * t_s) + 0.2 * std::sin(0.7 * t_s), 0.3 * std::cos(1.7 * t_s),
          0.5 * std::sin(1.3 * t_s + 1)};
}

struct Flight {
  /// What the file's gyroscope says of the true rate.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> gyro = [](const Eigen::Vector3d& w) { return w; };
  /// What the images show of the camera's true turn.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> seen = [](const Eigen::Vector3d& turn) { return turn; };
  double clock_s = 0;                 ///< the world at the IMU's time is that of the images' time + clock
  double imu_time = 1;                ///< the rate at which the IMU's flight goes on
  Eigen::Quaterniond R_b_c = kR_b_c;  ///< as the calibration has it
  double rate = 1;
  double shake = 0, shown = 1;  ///< of a camera in a hand [rad/s], and how much of it the images show
};

Eigen::Vector3d shakeAt(double t_s) {
  return {std::sin(9 * t_s), std::cos(11 * t_s + 1), 0.7 * std::sin(13 * t_s + 2)};
}

/// Fifteen seconds at 20 Hz; every tenth turn is an outlier.
TurnCheck checkOf(const Flight& flight) {
  TurnCheck check(flight.R_b_c);
  for (int frame = 0; frame < 300; ++frame) {
    ImuBatch imu;
    const double t_s = 0.05 * frame;
    for (int i = 0; i <= 10; ++i) {
      ImuSample sample;
      sample.t_ns = 50'000'000LL * (frame - 1) + 5'000'000LL * i;
      const double at_s = flight.imu_time * (1e-9 * static_cast<double>(sample.t_ns) + flight.clock_s);
      sample.gyro =
          flight.gyro(flight.rate * rateAt(at_s) + flight.shake * shakeAt(at_s)) + Eigen::Vector3d(0.02, -0.01, 0.03);
      imu.push_back(sample);
    }
    CameraTurn turn;
    turn.from_ns = 50'000'000LL * (frame - 1);
    turn.to_ns = 50'000'000LL * frame;
    const Eigen::Vector3d noise =
        2e-4 * Eigen::Vector3d(std::sin(12.9 * frame), std::sin(78.2 * frame), std::sin(37.7 * frame));
    const Eigen::Vector3d rate = flight.rate * rateAt(t_s - 0.025) + flight.shown * flight.shake * shakeAt(t_s - 0.025);
    const Eigen::Vector3d true_turn = kR_b_c.conjugate() * (0.05 * rate);
    turn.rotation = frame % 10 == 0 ? Eigen::Vector3d(0.1, -0.2, 0.1) : Eigen::Vector3d(flight.seen(true_turn) + noise);
    turn.sigma.setConstant(3e-4);
    check.add(imu, turn);
  }
  return check;
}

Flight withGyro(const Eigen::Matrix3d& file_of_true) {
  Flight flight;
  flight.gyro = [=](const Eigen::Vector3d& w) { return Eigen::Vector3d(file_of_true * w); };
  return flight;
}

Flight withImages(double x, double y, double z) {
  Flight flight;
  flight.seen = [=](const Eigen::Vector3d& turn) { return Eigen::Vector3d(x * turn.x(), y * turn.y(), z * turn.z()); };
  return flight;
}

Flight calibrated(const Eigen::Quaterniond& R_b_c) {
  Flight flight;
  flight.R_b_c = R_b_c;
  return flight;
}

Eigen::Quaterniond about(const Eigen::Vector3d& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees / 57.29577951, axis));
}

TEST(TurnCheck, AGoodFlightFitsWithTheIdentity) {
  const TurnCheck check = checkOf({});
  const TurnFit fit = check.fit();
  EXPECT_GT(fit.compared, 600);
  EXPECT_LT(fit.missed, 0.05);
  EXPECT_LT((fit.M - Eigen::Matrix3d::Identity()).norm(), 0.02) << fit.M;
  EXPECT_LT(fit.sigma.maxCoeff(), 0.01);
  EXPECT_EQ(check.fault(Suspicion::kSome), "");
}

TEST(TurnCheck, ARoughCalibrationIsNoFault) {
  EXPECT_EQ(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d(1, 1, 0).normalized(), 3))).fault(Suspicion::kSome), "");
  EXPECT_EQ(checkOf(withImages(0.95, 0.95, 1)).fault(Suspicion::kSome), "");
}

TEST(TurnCheck, ACameraThatIsMountedOtherwiseIsNamed) {
  EXPECT_THAT(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d::UnitZ(), 90))).fault(Suspicion::kSome),
              AllOf(HasSubstr("about 90 degrees about its viewing axis"), HasSubstr("T_BS")));
  EXPECT_THAT(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d::UnitX(), 20))).fault(Suspicion::kSome),
              AllOf(HasSubstr("about 20 degrees about its x axis"), HasSubstr("T_BS")));
  EXPECT_THAT(checkOf(calibrated(kR_b_c.conjugate())).fault(Suspicion::kSome), HasSubstr("inverse"));
}

TEST(TurnCheck, MirroredImagesAreNamed) {
  EXPECT_THAT(checkOf(withImages(1, -1, -1)).fault(Suspicion::kSome), HasSubstr("mirrored left-right"));
  EXPECT_THAT(checkOf(withImages(-1, 1, -1)).fault(Suspicion::kSome), HasSubstr("mirrored top-bottom"));
  EXPECT_THAT(checkOf(withImages(-1, -1, 1)).fault(Suspicion::kSome), HasSubstr("upside down"));
}

TEST(TurnCheck, AxesOfTheGyroscopeAreNamed) {
  Eigen::Matrix3d swapped, turned;
  swapped << 1, 0, 0, 0, 0, 1, 0, 1, 0;
  turned << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // the file's x is the true y, …
  EXPECT_THAT(checkOf(withGyro(swapped)).fault(Suspicion::kSome),
              AllOf(HasSubstr("left-handed"), HasSubstr("columns x, z, y")));
  EXPECT_THAT(checkOf(withGyro(Eigen::Vector3d(1, -1, 1).asDiagonal())).fault(Suspicion::kSome),
              HasSubstr("columns x, -y, z"));
  EXPECT_THAT(checkOf(withGyro(turned)).fault(Suspicion::kSome), HasSubstr("columns z, x, y"));
}

TEST(TurnCheck, UnitsAndFocalLengthAreNamed) {
  EXPECT_THAT(checkOf(withGyro(57.29578 * Eigen::Matrix3d::Identity())).fault(Suspicion::kSome),
              HasSubstr("degrees/s"));
  EXPECT_THAT(checkOf(withGyro(3 * Eigen::Matrix3d::Identity())).fault(Suspicion::kSome), HasSubstr("unit"));
  EXPECT_THAT(checkOf(withImages(1 / 1.3, 1 / 1.3, 1)).fault(Suspicion::kSome), HasSubstr("30 % too long"));
  EXPECT_THAT(checkOf(withImages(1.3, 1.3, 1)).fault(Suspicion::kSome), HasSubstr("too short"));
}

TEST(TurnCheck, StabilisedImagesAreNamed) {
  for (const double shown : {0.1, 0.4}) {
    Flight flight;
    flight.shake = 0.5, flight.shown = shown;
    EXPECT_THAT(checkOf(flight).fault(Suspicion::kSome), HasSubstr("stabilised")) << shown;
    flight.clock_s = 0.06;
    EXPECT_THAT(checkOf(flight).fault(Suspicion::kSome), HasSubstr("stabilised")) << shown;
  }
}

TEST(TurnCheck, AGyroscopeWithoutTurnsIsNamed) {
  EXPECT_THAT(checkOf(withGyro(Eigen::Matrix3d::Zero())).fault(Suspicion::kSome), HasSubstr("no turn at all"));
}

TEST(TurnCheck, ClocksThatDifferAreFound) {
  for (const double clock_s : {2.0, -0.3, 0.5}) {
    Flight flight;
    flight.clock_s = clock_s;
    const TurnCheck check = checkOf(flight);
    EXPECT_NEAR(check.bestFit().offset_s, -clock_s, 0.03);
    EXPECT_THAT(check.fault(Suspicion::kSome), HasSubstr("clocks")) << clock_s;
  }
}

TEST(TurnCheck, AnotherFlightIsNamed) {
  Flight flight;
  flight.imu_time = 0.5;
  flight.clock_s = 40;
  EXPECT_THAT(checkOf(flight).fault(Suspicion::kSome), HasSubstr("do not turn together"));
}

TEST(TurnCheck, NoClockIsFoundInNoise) {
  // A flight without turns: the gyroscope shows noise, the images a slow turn that is not there. By chance some offset
  // of the clocks fits better than others.
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Flight flight;
  flight.gyro = [&](const Eigen::Vector3d&) {
    return Eigen::Vector3d(0.02 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
  };
  int frame = 0;
  flight.seen = [&](const Eigen::Vector3d&) {
    const double t_s = 0.05 * ++frame;
    return Eigen::Vector3d(3e-3 * std::sin(0.5 * t_s), 2e-3 * std::cos(0.8 * t_s), 0);
  };
  const TurnCheck check = checkOf(flight);
  EXPECT_GT(check.fit().compared, 60) << "the images seem to turn";
  EXPECT_EQ(check.bestFit().offset_s, 0);
  EXPECT_THAT(check.fault(Suspicion::kSome), Not(HasSubstr("clocks")));
}

TEST(TurnCheck, NothingIsSaidWithoutTurns) {
  Flight flight = withGyro(-Eigen::Matrix3d::Identity());
  flight.rate = 0.005;
  EXPECT_EQ(checkOf(flight).fault(Suspicion::kSome), "");
  EXPECT_EQ(TurnCheck(kR_b_c).fault(Suspicion::kSome), "");
}

TEST(TurnCheck, WithoutSuspicionOnlyWhatNoRunSurvivesIsAFault) {
  EXPECT_EQ(checkOf(withImages(1 / 1.3, 1 / 1.3, 1)).fault(Suspicion::kNone), "");
  EXPECT_EQ(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d::UnitX(), 12))).fault(Suspicion::kNone), "");
  EXPECT_THAT(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d::UnitX(), 12))).fault(Suspicion::kSome),
              HasSubstr("turned by about 12"));
  EXPECT_THAT(checkOf(calibrated(kR_b_c * about(Eigen::Vector3d::UnitZ(), 90))).fault(Suspicion::kNone),
              HasSubstr("turned by about 90"));
}

}  // namespace
}  // namespace lintel
