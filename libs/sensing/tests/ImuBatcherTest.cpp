// SPDX-License-Identifier: BSD-3-Clause
#include "ImuBatcher.h"

#include <gmock/gmock.h>

#include <vector>

namespace lintel {
namespace {

constexpr std::int64_t kMs = 1000000;

/// Samples at the given milliseconds; gyro.x is the time in milliseconds.
ImuBatcher batcherOf(std::vector<int> times_ms) {
  return ImuBatcher([times_ms, i = std::size_t{0}](std::int64_t) mutable -> std::optional<ImuSample> {
    if (i == times_ms.size()) return std::nullopt;
    const int t = times_ms[i++];
    return ImuSample{t * kMs, {double(t), 0, 0}, {0, 0, 2.0 * t}};
  });
}

std::vector<double> timesOf(const ImuBatch& batch) {
  std::vector<double> times;
  for (const ImuSample& sample : batch) {
    EXPECT_DOUBLE_EQ(sample.gyro.x(), static_cast<double>(sample.t_ns) / kMs);
    EXPECT_DOUBLE_EQ(sample.accel.z(), static_cast<double>(sample.t_ns) / kMs * 2);
    times.push_back(static_cast<double>(sample.t_ns) / kMs);
  }
  return times;
}

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ImuBatcherTest, TakesSamplesThatFallOnTheFramesAsTheyAre) {
  ImuBatcher imu = batcherOf({0, 10, 20, 30, 40, 50});
  EXPECT_THAT(timesOf(imu.before(10 * kMs)), ElementsAre(0, 10));
  EXPECT_THAT(timesOf(imu.between(10 * kMs, 30 * kMs)), ElementsAre(10, 20, 30));
  EXPECT_THAT(timesOf(imu.between(30 * kMs, 50 * kMs)), ElementsAre(30, 40, 50));
}

TEST(ImuBatcherTest, InterpolatesBothEnds) {
  ImuBatcher imu = batcherOf({0, 10, 20, 30, 40});
  EXPECT_THAT(timesOf(imu.before(5 * kMs)), ElementsAre(0, 5));
  EXPECT_THAT(timesOf(imu.between(5 * kMs, 28 * kMs)), ElementsAre(5, 10, 20, 28));
}

TEST(ImuBatcherTest, InterpolatedEndsAreAsUncertainAsTheWorseSample) {
  ImuBatcher imu([i = 0](std::int64_t) mutable -> std::optional<ImuSample> {
    ImuSample sample{10 * i * kMs};
    if (i == 1) sample.gyro_open = 0.1F, sample.accel_open = 2;
    return i++ < 4 ? std::optional<ImuSample>(sample) : std::nullopt;
  });
  imu.before(5 * kMs);
  const ImuBatch first = imu.between(5 * kMs, 15 * kMs), second = imu.between(15 * kMs, 25 * kMs);
  for (const ImuSample& sample : first) EXPECT_EQ(sample.gyro_open, 0.1F) << sample.t_ns;
  EXPECT_EQ(second.front().accel_open, 2);
  EXPECT_EQ(second.back().accel_open, 0);
}

TEST(ImuBatcherTest, FramesCloserThanSamples) {
  ImuBatcher imu = batcherOf({0, 10, 20});
  imu.before(2 * kMs);
  EXPECT_THAT(timesOf(imu.between(2 * kMs, 4 * kMs)), ElementsAre(2, 4));
  EXPECT_THAT(timesOf(imu.between(4 * kMs, 12 * kMs)), ElementsAre(4, 10, 12));
}

TEST(ImuBatcherTest, NothingOutsideTheRecordedTime) {
  ImuBatcher imu = batcherOf({10, 20, 30});
  EXPECT_THAT(imu.before(5 * kMs), IsEmpty());
  EXPECT_THAT(imu.between(5 * kMs, 15 * kMs), IsEmpty());
  EXPECT_THAT(timesOf(imu.between(15 * kMs, 25 * kMs)), ElementsAre(15, 20, 25));
  EXPECT_THAT(imu.between(25 * kMs, 35 * kMs), IsEmpty());
}

TEST(ImuBatcherTest, FirstSampleExactlyOnTheFrame) {
  ImuBatcher imu = batcherOf({10, 20});
  EXPECT_THAT(timesOf(imu.before(10 * kMs)), ElementsAre(10));
}

TEST(ImuBatcherTest, LeadInIsHalfASecondAndEndsAtAGap) {
  ImuBatcher all = batcherOf({0, 40, 80, 120, 160, 200, 240, 280, 320, 360, 400, 440, 480, 520, 560});
  EXPECT_THAT(timesOf(all.before(540 * kMs)),
              ElementsAre(40, 80, 120, 160, 200, 240, 280, 320, 360, 400, 440, 480, 520, 540));
  ImuBatcher gap = batcherOf({0, 10, 100, 110, 120});
  EXPECT_THAT(timesOf(gap.before(115 * kMs)), ElementsAre(100, 110, 115));
}

std::vector<double> bridgedTimesOf(const ImuBatch& batch) {
  std::vector<double> times;
  for (const ImuSample& sample : batch)
    if (sample.bridged) times.push_back(static_cast<double>(sample.t_ns) / kMs);
  return times;
}

TEST(ImuBatcherTest, AShortDropOutIsBridgedAndSaysSo) {
  ImuBatcher imu = batcherOf({0, 10, 20, 71, 80, 90, 140});
  imu.before(5 * kMs);
  const ImuBatch first = imu.between(5 * kMs, 35 * kMs), second = imu.between(35 * kMs, 75 * kMs);
  EXPECT_THAT(timesOf(first), ElementsAre(5, 10, 20, 30, 35));
  EXPECT_THAT(bridgedTimesOf(first), ElementsAre(30, 35));
  EXPECT_THAT(timesOf(second), ElementsAre(35, 40, 50, 60, 70, 71, 75));
  EXPECT_THAT(bridgedTimesOf({second.begin() + 1, second.end()}), ElementsAre(40, 50, 60, 70, 71));
  EXPECT_THAT(timesOf(imu.between(75 * kMs, 85 * kMs)), ElementsAre(75, 80, 85));
  const ImuBatch last = imu.between(85 * kMs, 100 * kMs);
  EXPECT_THAT(timesOf(last), ElementsAre(85, 90, 100));
  EXPECT_THAT(bridgedTimesOf(last), IsEmpty());  // 50 ms are still no drop-out
}

TEST(ImuBatcherTest, NothingIsInterpolatedOverALongDropOut) {
  ImuBatcher imu = batcherOf({0, 10, 511, 520});
  imu.before(5 * kMs);
  EXPECT_THAT(imu.between(5 * kMs, 515 * kMs), IsEmpty());
  EXPECT_THAT(timesOf(imu.between(515 * kMs, 520 * kMs)), ElementsAre(515, 520));
}

TEST(ImuBatcherTest, SkippingKeepsTheLeadIn) {
  std::vector<int> times;
  for (int t = 0; t <= 3000; t += 10) times.push_back(t);
  ImuBatcher imu = batcherOf(times);
  imu.skipTo(1000 * kMs);
  imu.skipTo(2000 * kMs);
  const ImuBatch batch = imu.before(2005 * kMs);
  EXPECT_EQ(batch.front().t_ns, 1510 * kMs);
  EXPECT_EQ(batch.back().t_ns, 2005 * kMs);
}

}  // namespace
}  // namespace lintel
