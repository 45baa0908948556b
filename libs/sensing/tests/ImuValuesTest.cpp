// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "HeldValues.h"
#include "ImuValuesStream.h"
#include "RangeEnds.h"
#include "SpikeFilter.h"

namespace lintel {
namespace {

using ::testing::ElementsAre;

using Samples = std::vector<ImuSample>;

constexpr std::int64_t kPeriod_ns = 5'000'000;

Eigen::Vector3d accelAt(double t_s) { return {std::sin(6 * t_s), 2 * std::cos(5 * t_s), 9.81 + std::sin(4 * t_s)}; }
Eigen::Vector3d gyroAt(double t_s) { return {0.3 * std::sin(3 * t_s), 0.2, -0.5 * std::cos(2 * t_s)}; }

double seconds(const ImuSample& sample) { return 1e-9 * static_cast<double>(sample.t_ns); }

/// 200 samples a second.
Samples motion(std::size_t n, double noise = 0) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 1);
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  Samples samples(n);
  for (std::size_t i = 0; i < n; ++i) {
    samples[i].t_ns = static_cast<std::int64_t>(i) * kPeriod_ns;
    samples[i].gyro = gyroAt(seconds(samples[i])) + 0.1 * noise * any();
    samples[i].accel = accelAt(seconds(samples[i])) + noise * any();
  }
  return samples;
}

/// The accelerations are those of a sensor that measures every `interval_s`.
Samples held(std::size_t n, double interval_s) {
  Samples samples = motion(n);
  for (ImuSample& sample : samples) {
    const double measured_s = interval_s * std::floor(seconds(sample) / interval_s + 1e-9);
    sample.accel = accelAt(measured_s) + Eigen::Vector3d::Constant(1e-6 * measured_s);
  }
  return samples;
}

Samples through(HeldValues& values, const Samples& samples) {
  Samples out;
  for (const ImuSample& sample : samples) {
    values.push(sample);
    while (const auto next = values.pop(false)) out.push_back(*next);
  }
  while (const auto next = values.pop(true)) out.push_back(*next);
  return out;
}

TEST(HeldValues, ValuesOfASlowSensorAreInterpolated) {
  for (const double interval_s : {0.008, 0.01, 0.016, 0.1 / 3}) {
    HeldValues values;
    const Samples in = held(1000, interval_s), out = through(values, in);
    EXPECT_NE(values.remark().find("accelerations are each repeated"), std::string::npos) << interval_s;
    EXPECT_EQ(values.remark().find("angular"), std::string::npos);
    ASSERT_EQ(out.size(), in.size());
    double before = 0, after = 0;
    for (std::size_t i = 20; i < 980; ++i) {
      EXPECT_EQ(out[i].t_ns, in[i].t_ns);
      EXPECT_EQ(out[i].gyro, in[i].gyro);
      before += (in[i].accel - accelAt(seconds(in[i]))).squaredNorm();
      after += (out[i].accel - accelAt(seconds(in[i]))).squaredNorm();
    }
    EXPECT_LT(std::sqrt(after / before), interval_s < 0.012 ? 0.75 : 0.45) << interval_s;
  }
}

TEST(HeldValues, SamplesThatAreRepeatedWholeAreInterpolated) {
  Samples in = motion(1000);
  for (std::size_t i = 1; i < in.size(); i += 2) in[i].gyro = in[i - 1].gyro, in[i].accel = in[i - 1].accel;
  HeldValues values;
  const Samples out = through(values, in);
  EXPECT_NE(values.remark().find("angular rates are each repeated in 2.0 samples; "), std::string::npos)
      << values.remark();
  ASSERT_EQ(out.size(), 1000U);
  for (std::size_t i = 10; i < 990; ++i) {
    EXPECT_NE(out[i].gyro, out[i - 1].gyro);
    EXPECT_NE(out[i].accel, out[i - 1].accel);
  }
}

TEST(HeldValues, WhatBeginsLaterIsLookedAtThen) {
  HeldValues values;
  EXPECT_FALSE(values.pop(true));
  through(values, held(1000, 0.016));
  EXPECT_NE(values.remark(), "");
}

TEST(HeldValues, ASensorThatStopsKeepsItsLastValue) {
  Samples in = held(1000, 0.016);
  for (std::size_t i = 600; i < 800; ++i) in[i].accel = in[599].accel;
  HeldValues values;
  const Samples out = through(values, in);
  for (std::size_t i = 600; i < 780; ++i) EXPECT_EQ(out[i].accel, in[599].accel);
}

TEST(HeldValues, OtherSamplesAreAsTheyCame) {
  Samples still = motion(1000);  // at rest, with steps of the sensor that are larger than its noise
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 1);
  for (ImuSample& sample : still) {
    sample.accel = {0, 0, 9.8 + 0.02 * std::round(0.6 * normal(random))};
    sample.gyro = {0.01 * std::round(0.4 * normal(random)), 0, 0};
  }
  for (const Samples& in : {motion(1000), motion(1000, 0.1), still, Samples(1000), motion(5)}) {
    HeldValues values;
    const Samples out = through(values, in);
    EXPECT_EQ(values.remark(), "");
    ASSERT_EQ(out.size(), in.size());
    for (std::size_t i = 0; i < in.size(); ++i) EXPECT_TRUE(out[i].accel == in[i].accel && out[i].gyro == in[i].gyro);
  }
}

/// What a filter makes of the samples, and the remarks that it gives with some.
template <class Filter>
Samples mended(const Samples& samples, std::vector<std::string>* remarks) {
  Filter filter;
  Samples out;
  std::string remark;
  const auto take = [&](bool at_end) {
    while (const auto next = filter.pop(at_end, remark)) {
      out.push_back(*next);
      if (!remark.empty()) remarks->push_back(remark);
    }
  };
  for (const ImuSample& sample : samples) {
    filter.push(sample);
    take(false);
  }
  take(true);
  return out;
}

TEST(SpikeFilter, SingleValuesThatStandOutAreReplaced) {
  Samples in = motion(1000, 0.2);
  in[100].accel.y() = 30;
  in[105].accel.y() = -30;
  in[300].gyro.z() += 2;
  in[500].gyro.setZero();
  in[500].accel.setZero();  // a sample that was not read
  std::vector<std::string> remarks;
  const Samples out = mended<SpikeFilter>(in, &remarks);
  ASSERT_EQ(out.size(), in.size());
  EXPECT_EQ(remarks.size(), 4U);
  for (const std::size_t i : {100, 105, 300, 500}) {
    EXPECT_EQ(out[i].t_ns, in[i].t_ns);
    EXPECT_LT((out[i].accel - accelAt(seconds(in[i]))).norm(), 1) << i;
    EXPECT_LT((out[i].gyro - gyroAt(seconds(in[i]))).norm(), 0.4);
  }
  for (std::size_t i = 0; i < in.size(); ++i)
    EXPECT_EQ(out[i].accel == in[i].accel && out[i].gyro == in[i].gyro, i != 100 && i != 105 && i != 300 && i != 500)
        << i;
}

TEST(SpikeFilter, WhatABodyDoesIsLeft) {
  Samples shaken = motion(1000, 3), motor = motion(1000), knock = motion(1000, 0.05), change = motion(1000, 0.05);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double phase = 2 * M_PI * 91.7 * seconds(motor[i]);
    motor[i].accel += Eigen::Vector3d(15 * std::sin(phase), 10 * std::cos(phase), 20 * std::sin(2 * phase));
    motor[i].gyro += 0.5 * Eigen::Vector3d(std::cos(phase), std::sin(phase), 0);
  }
  for (std::size_t i = 0; i < 6; ++i)
    knock[400 + i].accel.z() += 25 * std::pow(std::sin(M_PI * (static_cast<double>(i) + 0.5) / 6), 2);
  for (std::size_t i = 500; i < 1000; ++i)
    change[i].accel.x() += 15, change[i].t_ns += 400'000'000;  // after a drop-out
  const std::pair<const char*, const Samples&> motions[] = {
      {"shaken", shaken}, {"motor", motor}, {"knock", knock}, {"after a drop-out", change}};
  for (const auto& [name, in] : motions) {
    std::vector<std::string> remarks;
    mended<SpikeFilter>(in, &remarks);
    EXPECT_TRUE(remarks.empty()) << name;
  }
}

constexpr double kRange = 2.18, kAccelRange = 19.61;  // 125 degrees/s and 2 g

/// Turns and accelerations of up to 3 rad/s and 25 m/s^2, 2 and 3 times a second.
Samples violent(std::size_t n, double noise = 0) {
  Samples samples = motion(n, noise);
  for (ImuSample& sample : samples) {
    const double t_s = seconds(sample), grow = std::min(1.0, t_s);
    sample.gyro.x() += grow * 3 * std::sin(12 * t_s);
    sample.accel.z() += grow * 15 * std::sin(19 * t_s);
  }
  return samples;
}

Samples clipped(Samples samples) {
  for (ImuSample& sample : samples) {
    sample.gyro = sample.gyro.cwiseMax(-kRange).cwiseMin(kRange);
    sample.accel = sample.accel.cwiseMax(-kAccelRange).cwiseMin(kAccelRange);
  }
  return samples;
}

TEST(RangeEnds, WhatIsBeyondTheRangeIsReplacedAndSaidToBeUncertain) {
  const Samples whole = violent(1000), in = clipped(whole);
  std::vector<std::string> remarks;
  const Samples out = mended<RangeEnds>(in, &remarks);
  ASSERT_EQ(out.size(), in.size());
  EXPECT_THAT(remarks, ElementsAre("the accelerometer's values along its z axis end at 19.6 m/s^2",
                                   "the gyroscope's rates along its x axis end at -2.18 rad/s",
                                   "the gyroscope's rates along its x axis end at 2.18 rad/s"));
  double before_gyro = 0, after_gyro = 0, before_accel = 0, after_accel = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    EXPECT_EQ(out[i].t_ns, in[i].t_ns);
    if (i > 990) continue;  // the recording ends with a run
    EXPECT_EQ(out[i].gyro_open > 0, out[i].gyro != in[i].gyro) << i;
    EXPECT_EQ(out[i].accel_open > 0, out[i].accel != in[i].accel) << i;
    if (i < 300) continue;  // until then the ends show
    before_gyro += (in[i].gyro - whole[i].gyro).squaredNorm(),
        after_gyro += (out[i].gyro - whole[i].gyro).squaredNorm();
    before_accel += (in[i].accel - whole[i].accel).squaredNorm();
    after_accel += (out[i].accel - whole[i].accel).squaredNorm();
  }
  EXPECT_LT(std::sqrt(after_gyro / before_gyro), 0.3);
  EXPECT_LT(std::sqrt(after_accel / before_accel), 0.3);
}

/// The integral's error is less than three of the standard deviations that the densities give.
TEST(RangeEnds, TheUncertaintyCoversTheError) {
  const Samples whole = violent(1000, 0.1), in = clipped(whole);
  std::vector<std::string> remarks;
  const Samples out = mended<RangeEnds>(in, &remarks);
  double error = 0, variance = 0;
  int runs = 0;
  for (std::size_t i = 300; i < in.size(); ++i) {
    if (out[i].gyro_open == 0) {
      if (variance > 0) {
        EXPECT_LT(std::abs(error), 3 * std::sqrt(variance)) << i;
        ++runs;
      }
      error = variance = 0;
      continue;
    }
    error += 0.005 * (out[i].gyro.x() - whole[i].gyro.x());
    variance += 0.005 * std::pow(out[i].gyro_open, 2);
  }
  EXPECT_GE(runs, 5);
}

/// A recording without images.
class SampleStream final : public SensorStream {
 public:
  explicit SampleStream(Samples samples) : samples_(std::move(samples)) {}
  const Rig& rig() const override { return rig_; }
  const std::string& path() const override { return path_; }
  std::size_t countFrames(const RecordingParams&) const override { return 0; }
  std::optional<FrameRef> nextFrame(const WarningSink&) override { return std::nullopt; }
  std::optional<ImuSample> nextImu(std::int64_t, const WarningSink&) override {
    return next_ < samples_.size() ? std::optional<ImuSample>(samples_[next_++]) : std::nullopt;
  }

 private:
  Rig rig_;
  std::string path_ = "flight";
  Samples samples_;
  std::size_t next_ = 0;
};

TEST(ImuValuesStream, ARangeThatIsTooSmallIsSaidOnce) {
  ImuValuesStream stream(std::make_unique<SampleStream>(clipped(violent(1000))));
  std::vector<std::string> warnings;
  std::size_t samples = 0, open = 0;
  const auto warn = [&](Fault, std::string text) { warnings.push_back(std::move(text)); };
  while (const auto sample = stream.nextImu(0, warn)) ++samples, open += sample->gyro_open > 0 ? 1 : 0;
  EXPECT_EQ(samples, 1000U);
  EXPECT_GT(open, 100U);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_EQ(warnings[1],
            "flight: the accelerometer's values along its z axis end at 19.6 m/s^2 (estimated from 0.720000000 s on), "
            "the end of its range: set a larger range");
}

TEST(RangeEnds, ALongTimeAtTheEndIsNotGuessed) {
  Samples in = motion(600, 0.05);
  for (std::size_t i = 200; i < 300; ++i) in[i].gyro.z() = -kRange;
  std::vector<std::string> remarks;
  const Samples out = mended<RangeEnds>(in, &remarks);
  EXPECT_THAT(remarks, ElementsAre("the gyroscope's rates along its z axis end at -2.18 rad/s"));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const bool at_end = i >= 200 && i < 300;
    EXPECT_EQ(out[i].gyro, in[i].gyro);
    EXPECT_EQ(out[i].gyro_open > 0.1, at_end) << i;
  }
}

TEST(RangeEnds, NothingIsGuessedAcrossADropOut) {
  std::size_t first = 800;  // of a run
  const Samples whole = clipped(violent(1000));
  while (whole[first - 1].gyro.x() == kRange || whole[first].gyro.x() != kRange) ++first;
  for (const std::size_t gap : {first, first + 5}) {  // before the run, and within it
    Samples in = whole;
    for (std::size_t i = gap; i < in.size(); ++i) in[i].t_ns += 400'000'000;
    std::vector<std::string> remarks;
    const Samples out = mended<RangeEnds>(in, &remarks);
    for (std::size_t i = first; in[i].gyro.x() == kRange; ++i) {
      EXPECT_EQ(out[i].gyro, in[i].gyro) << i;
      EXPECT_FLOAT_EQ(out[i].gyro_open, 0.15F) << "as uncertain as a drop-out";
    }
  }
}

TEST(RangeEnds, ASinglePeakIsUncertain) {
  Samples in = motion(600, 0.01);
  for (std::size_t i = 100; i < 600; i += 20) in[i].accel.x() = kAccelRange;
  std::vector<std::string> remarks;
  const Samples out = mended<RangeEnds>(in, &remarks);
  EXPECT_FALSE(remarks.empty());
  for (std::size_t i = 300; i < 600; ++i) EXPECT_EQ(out[i].accel_open > 0.5, (i - 100) % 20 == 0) << i;
}

TEST(RangeEnds, MotionWithinTheRangeIsLeft) {
  Samples coarse = violent(4000, 0.05), frozen = violent(1000), still = motion(1000), units = violent(1000);
  for (ImuSample& sample : coarse) {  // steps of a sensor of 12 bits: the peaks of the sines are flat for some samples
    sample.gyro = 0.02 * (sample.gyro / 0.02).array().round();
    sample.accel = 0.1 * (sample.accel / 0.1).array().round();
  }
  for (std::size_t i = 0; i < 1000; ++i)  // a recorder that repeats samples
    if (i % 3 != 0) frozen[i].gyro = frozen[i - 1].gyro, frozen[i].accel = frozen[i - 1].accel;
  for (ImuSample& sample : still) sample.gyro.setZero(), sample.accel = {0, 0, 9.81};
  Samples pressed = motion(1000, 0.1);  // a centrifuge: what shows is noise, in steps
  for (ImuSample& sample : pressed) sample.accel.z() = 16 + 0.05 * std::round(sample.accel.x() / 0.4);
  const std::pair<const char*, const Samples&> motions[] = {{"coarse", coarse},
                                                            {"repeated", frozen},
                                                            {"still", still},
                                                            {"centrifuge", pressed},
                                                            {"a few", Samples(units.begin(), units.begin() + 3)}};
  for (const auto& [name, in] : motions) {
    std::vector<std::string> remarks;
    const Samples out = mended<RangeEnds>(in, &remarks);
    EXPECT_TRUE(remarks.empty()) << name;
    ASSERT_EQ(out.size(), in.size()) << name;
    for (std::size_t i = 0; i < in.size(); ++i)
      EXPECT_TRUE(out[i].gyro == in[i].gyro && out[i].accel == in[i].accel && out[i].gyro_open == 0) << name << i;
  }
}

}  // namespace
}  // namespace lintel
