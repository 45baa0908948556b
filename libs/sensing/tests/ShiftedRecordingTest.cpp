// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/ShiftedRecording.h"

#include <gtest/gtest.h>

#include <vector>

namespace lintel {
namespace {

constexpr std::int64_t kMillisecond_ns = 1000000;

/// Frames every 50 ms; gyro.x is the time in milliseconds, samples every 5 ms.
class Counting : public Recording {
 public:
  explicit Counting(int frames) : frames_(frames) {}
  const Rig& rig() const override { return rig_; }
  std::optional<FrameWithImu> next() override {
    if (next_ == frames_) return std::nullopt;
    const int t_ms = 1000 + 50 * next_++;
    FrameWithImu step;
    step.frame.t_ns = t_ms * kMillisecond_ns;
    for (int t = t_ms - (t_ms == 1000 ? 500 : 50); t <= t_ms; t += 5)
      step.imu.push_back({t * kMillisecond_ns, {double(t), 0, 0}, Eigen::Vector3d::Zero()});
    return step;
  }
  std::size_t expectedFrames() const override { return static_cast<std::size_t>(frames_); }
  std::vector<std::string> warnings() const override { return {}; }

 private:
  Rig rig_;
  int frames_, next_ = 0;
};

TEST(ShiftedRecording, AFrameGetsTheSamplesOfItsTimeOnTheOtherClock) {
  for (const double offset_s : {-0.047, 0.062}) {
    Counting source(40);
    std::deque<FrameWithImu> read;
    for (int i = 0; i < 7; ++i) read.push_back(*source.next());
    ShiftedRecording shifted(source, std::move(read), offset_s);
    int frames = 0;
    std::int64_t last_ns = 0;
    while (const auto step = shifted.next()) {
      EXPECT_EQ(step->frame.t_ns, (1000 + 50 * frames) * kMillisecond_ns);
      ++frames;
      if (frames > 38) continue;  // with the later clock the last frames are not covered
      ASSERT_FALSE(step->imu.empty()) << frames;
      EXPECT_EQ(step->imu.back().t_ns, step->frame.t_ns);
      if (frames > 1) {
        EXPECT_EQ(step->imu.front().t_ns, last_ns);
      }
      last_ns = step->frame.t_ns;
      for (const ImuSample& sample : step->imu)
        EXPECT_NEAR(sample.gyro.x(), 1e-6 * static_cast<double>(sample.t_ns) + 1000 * offset_s, 1e-6);
    }
    EXPECT_EQ(frames, 40);
  }
}

TEST(ShiftedRecording, WithoutAnOffsetAllIsAsItWas) {
  Counting source(10), plain(10);
  std::deque<FrameWithImu> read{*source.next(), *source.next()};
  ShiftedRecording shifted(source, std::move(read), 0);
  while (const auto expected = plain.next()) {
    const auto step = shifted.next();
    ASSERT_TRUE(step);
    EXPECT_EQ(step->frame.t_ns, expected->frame.t_ns);
    ASSERT_EQ(step->imu.size(), expected->imu.size());
    EXPECT_EQ(step->imu.front().t_ns, expected->imu.front().t_ns);
  }
  EXPECT_FALSE(shifted.next());
}

TEST(ShiftedRecording, AFaultComesAfterWhatHadBeenRead) {
  Counting source(3);
  std::deque<FrameWithImu> read{*source.next(), *source.next()};
  ShiftedRecording shifted(source, std::move(read), 0, std::make_exception_ptr(RecordingError("cut off")));
  EXPECT_TRUE(shifted.next());
  EXPECT_TRUE(shifted.next());
  EXPECT_THROW(shifted.next(), RecordingError);
}

}  // namespace
}  // namespace lintel
