// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/GyroPath.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lintel {
namespace {

TEST(GyroPath, TurnsAsItsSamplesWithoutTheBias) {
  const Eigen::Vector3d bias(0.2, -0.3, 0.1);
  ImuBatch right, off;
  for (int i = 0; i <= 200; ++i) {
    ImuSample sample;
    sample.t_ns = 5'000'000LL * i;
    sample.gyro = Eigen::Vector3d(std::sin(0.05 * i), 0.5, std::cos(0.03 * i));
    right.push_back(sample);
    sample.gyro += bias;
    off.push_back(sample);
  }
  const GyroPath truth(right), path(off, bias), uncorrected(off);
  for (const std::int64_t t_ns : {0LL, 123'456'789LL, 1'000'000'000LL})
    EXPECT_LT(path.at(t_ns).angularDistance(truth.at(t_ns)), 1e-12) << t_ns;
  EXPECT_GT(uncorrected.at(1'000'000'000).angularDistance(truth.at(1'000'000'000)), 0.3);
}

TEST(GyroPath, CoversWhatLiesBetweenSamplesThatFollowEachOther) {
  ImuBatch imu(41);
  for (std::size_t i = 0; i < imu.size(); ++i) imu[i].t_ns = static_cast<std::int64_t>(i < 20 ? i : i + 20) * 5'000'000;
  const GyroPath path(imu);
  EXPECT_TRUE(path.covers(0, 95'000'000));
  EXPECT_FALSE(path.covers(90'000'000, 210'000'000)) << "a gap of 105 ms";
  EXPECT_TRUE(path.covers(200'000'000, 300'000'000));
  EXPECT_FALSE(path.covers(200'000'000, 301'000'000)) << "after the last";
}

}  // namespace
}  // namespace lintel
