// SPDX-License-Identifier: BSD-3-Clause
#include "StabilisedVideo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace lintel {
namespace {

Eigen::Vector3d slowAt(double t_s) {
  return {0.4 * std::sin(2.1 * t_s) + 0.2 * std::sin(0.7 * t_s), 0.3 * std::cos(1.7 * t_s),
          0.5 * std::sin(1.3 * t_s + 1)};
}

Eigen::Vector3d shakeAt(double t_s) {
  return {std::sin(9 * t_s), std::cos(11 * t_s + 1), 0.7 * std::sin(13 * t_s + 2)};
}

struct Film {
  double shake = 0.5;                ///< of the camera [rad/s]
  double slow = 1, fast = 1;         ///< how much of slow turns and of the shake the images show
  double gyro_noise = 0.01;          ///< of a sample [rad/s]
  double clock_s = 0, jitter_s = 0;  ///< of the images' stamps
};

/// Fifteen seconds at 20 Hz, the IMU at 200 Hz, camera and IMU with the same axes.
std::string faultOf(const Film& film) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  const auto noise = [&](double sigma) {
    return Eigen::Vector3d(sigma * Eigen::Vector3d(normal(random), normal(random), normal(random)));
  };
  ImuBatch imu(3000);
  for (std::size_t i = 0; i < imu.size(); ++i) {
    imu[i].t_ns = static_cast<std::int64_t>(i) * 5'000'000;
    const double t_s = 0.005 * static_cast<double>(i);
    imu[i].gyro = slowAt(t_s) + film.shake * shakeAt(t_s) + noise(film.gyro_noise);
  }
  std::vector<CameraTurn> turns;
  for (int frame = 1; frame < 300; ++frame) {
    const double t_s = 0.05 * frame - 0.025 + film.clock_s + film.jitter_s * normal(random);
    CameraTurn turn;
    turn.from_ns = 50'000'000LL * (frame - 1), turn.to_ns = 50'000'000LL * frame;
    turn.rotation = 0.05 * (film.slow * slowAt(t_s) + film.fast * film.shake * shakeAt(t_s)) + noise(3e-4);
    turn.sigma.setConstant(3e-4);
    turns.push_back(turn);
  }
  return stabilisationFault(imu, Eigen::Quaterniond::Identity(), turns);
}

Film with(const std::function<void(Film&)>& change) {
  Film film;
  change(film);
  return film;
}

TEST(StabilisedVideo, ImagesThatShakeLessThanTheGyroscope) {
  EXPECT_NE(faultOf(with([](Film& f) { f.fast = 0.1; })), "");
  EXPECT_NE(faultOf(with([](Film& f) { f.fast = 0.4, f.clock_s = 0.06; })), "");
  EXPECT_NE(faultOf(with([](Film& f) { f.fast = 0.3, f.slow = 0.9; })), "");
}

TEST(StabilisedVideo, OtherFaultsAreNone) {
  EXPECT_EQ(faultOf({}), "");
  EXPECT_EQ(faultOf(with([](Film& f) { f.clock_s = 0.1; })), "") << "clocks that differ";
  EXPECT_EQ(faultOf(with([](Film& f) { f.jitter_s = 0.01; })), "") << "stamps that are off";
  EXPECT_EQ(faultOf(with([](Film& f) { f.slow = f.fast = 0.7; })), "") << "a focal length that is wrong";
  EXPECT_EQ(faultOf(with([](Film& f) { f.slow = f.fast = 0; })), "") << "another recording";
  EXPECT_EQ(faultOf(with([](Film& f) { f.slow = 0.3, f.fast = 0; })), "") << "one that turns alike by chance";
  EXPECT_EQ(faultOf(with([](Film& f) { f.shake = 0; })), "") << "nothing that would be stabilised";
}

TEST(StabilisedVideo, ANoisyGyroscopeSaysNothing) {
  for (const double noise : {0.2, 0.4, 0.8})
    EXPECT_EQ(faultOf(with([&](Film& f) { f.gyro_noise = noise, f.shake = 0.5 * noise; })), "") << noise;
}

}  // namespace
}  // namespace lintel
