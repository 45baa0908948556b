// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Odometry.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "MadeRecording.h"

namespace lintel {
namespace {

Rig tinyRig() {
  Rig rig;
  rig.camera = {160, 120, 100, 100, 79.5, 59.5, 0, 0, 0, 0};
  return rig;
}

/// Black images at rest.
class BlackRecording : public test::MadeRecording {
 public:
  explicit BlackRecording(int frames, std::string complaint = "")
      : MadeRecording(tinyRig(), frames, std::move(complaint)) {}

 private:
  std::shared_ptr<const GrayImage> imageAt(double) const override { return image_; }
  Eigen::Vector3d gyroAt(double) const override { return Eigen::Vector3d::Zero(); }

  std::shared_ptr<const GrayImage> image_ =
      std::make_shared<GrayImage>(GrayImage{160, 120, std::vector<std::uint8_t>(std::size_t{160} * 120, 0)});
};

class OdometryTest : public testing::TestWithParam<int> {  // threads
 protected:
  OdometryTest() { options_.threads = GetParam(); }
  RunOptions options_;
};

TEST_P(OdometryTest, EveryFrameIsSeenOnceInOrderByTheCallingThread) {
  BlackRecording recording(30);
  std::size_t seen = 0;
  const auto caller = std::this_thread::get_id();
  options_.observer = [&](const Frame& frame, const FrameTracks& tracks, const WindowUpdate& update, std::size_t done) {
    EXPECT_EQ(frame.t_ns, static_cast<std::int64_t>(seen) * 50'000'000);
    EXPECT_EQ(tracks.t_ns, frame.t_ns);
    EXPECT_EQ(update.t_ns, frame.t_ns);
    EXPECT_EQ(done, ++seen);
    EXPECT_EQ(std::this_thread::get_id(), caller);
  };
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_EQ(seen, 30u);
  EXPECT_EQ(result.statistics.frames, 30u);
  EXPECT_EQ(result.statistics.tracking.ms().size(), 30u);
  EXPECT_EQ(result.statistics.estimation.ms().size(), 30u);
  EXPECT_EQ(result.error, "");
  EXPECT_FALSE(result.cancelled);
}

TEST_P(OdometryTest, ProgressCountsTheFramesOfTheRecording) {
  BlackRecording recording(7);
  std::vector<std::size_t> done;
  options_.progress = [&](const RunProgress& progress) {
    EXPECT_EQ(progress.stage, RunStage::kFrames) << "without keyframes nothing is refined";
    EXPECT_EQ(progress.total, 7u);
    done.push_back(progress.done);
  };
  runOdometry(recording, {}, options_);
  EXPECT_EQ(done, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7}));
}

TEST_P(OdometryTest, ACancelledRunEndsBeforeTheNextFrame) {
  BlackRecording recording(1000, "flight.rawlog: cut off");
  std::size_t seen = 0;
  options_.cancelled = [&] { return seen == 12; };
  options_.observer = [&](const Frame&, const FrameTracks&, const WindowUpdate&, std::size_t done) { seen = done; };
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(seen, 12u);
  EXPECT_EQ(result.statistics.frames, 12u);
  EXPECT_EQ(result.statistics.last_frame_ns, 11 * 50'000'000);
  EXPECT_EQ(result.error, "") << "it did not end because of the recording";
}

TEST_P(OdometryTest, ARunCancelledAtOnceIsAnEmptyResult) {
  BlackRecording recording(3, "flight.rawlog: cut off");
  options_.cancelled = [] { return true; };
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(result.statistics.frames, 0u);
  EXPECT_EQ(result.error, "");
}

TEST_P(OdometryTest, WithoutAPoseItSaysWhatWasWaitedFor) {
  BlackRecording recording(6);
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_EQ(result.statistics.frames_with_pose, 0u);
  EXPECT_LT(result.statistics.first_pose_s, 0);
  EXPECT_EQ(result.statistics.main_wait, "collecting frames");
  EXPECT_TRUE(result.map.keyframes.empty());
}

TEST_P(OdometryTest, ARecordingThatBreaksOffIsAnErrorWithWhatCameBefore) {
  BlackRecording recording(12, "flight.rawlog: cut off");
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_EQ(result.statistics.frames, 12u);
  EXPECT_EQ(result.error, "flight.rawlog: cut off");
}

TEST_P(OdometryTest, AnEmptyRecordingIsAnEmptyResult) {
  BlackRecording recording(0);
  const OdometryResult result = runOdometry(recording, {}, options_);
  EXPECT_EQ(result.statistics.frames, 0u);
  EXPECT_EQ(result.error, "");
}

TEST_P(OdometryTest, AnObserverThatThrowsEndsTheRun) {
  BlackRecording recording(1000);
  options_.observer = [](const Frame&, const FrameTracks&, const WindowUpdate&, std::size_t done) {
    if (done == 5) throw std::runtime_error("the disk is full");
  };
  EXPECT_THROW(runOdometry(recording, {}, options_), std::runtime_error);
}

TEST_P(OdometryTest, TheMapHoldsItsConfiguration) {
  BlackRecording recording(2);
  Configuration configuration;
  configuration.estimator.keyframes = 8;
  EXPECT_EQ(runOdometry(recording, configuration, options_).map.configuration, writeConfiguration(configuration));
}

TEST(OdometryThreads, AreOneOrTwo) {
  for (const int threads : {-1, 0, 3, 64}) {
    BlackRecording recording(2);
    RunOptions options;
    options.threads = threads;
    EXPECT_THROW(runOdometry(recording, {}, options), std::invalid_argument) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, OdometryTest, testing::Values(1, 2));

}  // namespace
}  // namespace lintel
