// SPDX-License-Identifier: BSD-3-Clause
// Bags of the writer tests/recordings/make_bags, which shares no code with the reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "Bag.h"
#include "TimeTicks.h"
#include "TinyEuroc.h"
#include "lintel/sensing/RecordedSensors.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// One recording in all forms, made once.
class BagRecordingTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TempFolder;
    test::TinyEuroc recording;
    recording.frames = 8;
    recording.write(folder_->path().string());
    std::string command = "cd '" + folder_->path().string() + "' && /usr/bin/python3 '" + LINTEL_SOURCE_DIR +
                          "/tests/recordings/make_bags' .";
    for (const char* name : kNames) command += std::string(" ") + name;
    made_ = std::system((command + " > log 2>&1").c_str()) == 0;
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_TRUE(made_) << test::bytesOf(path("log")); }

  static std::string path(const std::string& name) { return *folder_ / name; }
  static RecordingParams calibrated() {
    RecordingParams params;
    params.calibration = {path("mav0/cam0/sensor.yaml"), path("mav0/imu0/sensor.yaml")};
    return params;
  }

  static constexpr const char* kNames[] = {"a.bag",
                                           "lz4.bag",
                                           "bz2_compressed.bag",
                                           "split.bag",
                                           "a.db3",
                                           "split_compressed.db3",
                                           "plain.mcap",
                                           "chunks.mcap",
                                           "lz4.mcap",
                                           "zstd_compressed.mcap",
                                           "zstd_split.mcap"};
  static test::TempFolder* folder_;
  static bool made_;
};

test::TempFolder* BagRecordingTest::folder_ = nullptr;
bool BagRecordingTest::made_ = false;

TEST_F(BagRecordingTest, EveryFormGivesWhatTheFolderGives) {
  const auto folder = openRecording(folder_->path().string(), calibrated());
  const auto expected = test::readAll(*folder);
  ASSERT_EQ(expected.steps.size(), 8U);
  for (const char* name : kNames) {
    SCOPED_TRACE(name);
    const auto recording = openRecording(path(name), calibrated());
    test::expectSameRig(folder->rig(), recording->rig());
    const auto all = test::readAll(*recording);
    EXPECT_EQ(all.error, "");
    EXPECT_THAT(all.warnings, IsEmpty());
    test::expectSameSteps(expected.steps, all.steps);
  }
}

TEST_F(BagRecordingTest, TopicsAreListed) {
  for (const char* name : {"lz4.bag", "a.db3", "lz4.mcap"}) {
    SCOPED_TRACE(name);
    const std::vector<BagTopic> topics = openBag(path(name))->topics();
    ASSERT_EQ(topics.size(), 2U);
    EXPECT_EQ(topics[0].name, "/cam0/image_raw");
    EXPECT_EQ(topics[0].type, "sensor_msgs/Image");
    EXPECT_EQ(topics[0].count, 8U);
    EXPECT_EQ(topics[0].rate_hz(), 20);
    EXPECT_EQ(topics[1].type, "sensor_msgs/Imu");
    EXPECT_EQ(topics[1].rate_hz(), 200);
    const std::vector<RecordedSensor> sensors = recordedSensors(path(name));
    ASSERT_EQ(sensors.size(), 2U);
    EXPECT_EQ(sensors[1].label, "/imu0");
    EXPECT_EQ(sensors[1].count, topics[1].count);
  }
}

TEST(BagTopic, AbsurdTimesGiveARateAllTheSame) {
  BagTopic topic;
  topic.count = 1000000001;
  topic.first_ns = -8756484179573048825;
  topic.last_ns = 1403636580779790151;
  EXPECT_NEAR(topic.rate_hz(), 0.1, 1e-9);  // the difference is more than 64 bits hold
}

TEST(TimeTicks, TimesBefore1970AreWritten) {
  EXPECT_EQ(secondsText(1403636580779790151), "1403636580.779790151 s");
  EXPECT_EQ(secondsText(-999999999), "-0.999999999 s");
  EXPECT_EQ(secondsText(-1500000000), "-1.500000000 s");
}

TEST_F(BagRecordingTest, SensorsOfFoldersAreListed) {
  const std::vector<RecordedSensor> sensors = recordedSensors(folder_->path().string());
  ASSERT_EQ(sensors.size(), 3U);
  EXPECT_EQ(sensors[0].label, "cam0");
  EXPECT_EQ(sensors[0].kind, "images");
  EXPECT_EQ(sensors[0].count, 8U);
  EXPECT_EQ(sensors[1].rate_hz, 200);
  EXPECT_THROW(recordedSensors(path("nothing")), RecordingError);
}

/// A ROS 2 bag in two files, in the order that its metadata name.
TEST_F(BagRecordingTest, FoldersOfRos2AreReadByTheirMetadata) {
  const fs::path bag = path("flight");
  fs::create_directories(bag);
  fs::copy_file(path("a.db3"), bag / "flight_0.db3", fs::copy_options::overwrite_existing);
  test::writeText(bag / "metadata.yaml",
                  "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                  "  relative_file_paths:\n    - flight_0.db3\n");
  EXPECT_EQ(test::readAll(bag.string(), calibrated()).steps.size(), 8U);
  fs::remove(bag / "flight_0.db3");
  EXPECT_THAT(test::openingError(bag.string(), calibrated()), HasSubstr("flight_0.db3: does not exist"));
}

TEST_F(BagRecordingTest, WithoutCalibrationItIsAskedFor) {
  EXPECT_THAT(test::openingError(path("a.bag")), HasSubstr("give it by --calibration"));
}

TEST_F(BagRecordingTest, TopicsAreNamed) {
  RecordingParams params = calibrated();
  params.camera = "/cam7/image_raw";
  EXPECT_THAT(test::openingError(path("a.db3"), params),
              AllOf(HasSubstr("has no topic /cam7/image_raw"), HasSubstr("/cam0/image_raw")));
  params.camera = "/cam0/image_raw";
  params.imu = "/camera/gyro/sample,/camera/accel/sample";
  EXPECT_EQ(test::readAll(path("split.bag"), params).steps.size(), 8U);
  params.imu = "/nothing";
  EXPECT_THAT(test::openingError(path("plain.mcap"), params), HasSubstr("has no topic /nothing"));
}

/// Nothing but what is thrown: libraries that read bags print faults of their own.
class Silence {
 public:
  Silence() { testing::internal::CaptureStderr(); }
  ~Silence() { EXPECT_EQ(testing::internal::GetCapturedStderr(), ""); }
};

/// Cut anywhere, a bag gives one line of error, or fewer steps and one line, and what it gives is right.
TEST_F(BagRecordingTest, CutBagsEndWithOneLine) {
  const Silence silence;
  const auto expected = test::readAll(folder_->path().string(), calibrated());
  for (const char* name : {"a.bag", "lz4.bag", "a.db3", "plain.mcap", "lz4.mcap", "zstd_compressed.mcap"}) {
    const std::string whole = test::bytesOf(path(name)),
                      cut = path(std::string("cut") + fs::path(name).extension().string());
    for (std::size_t i = 0; i < 40; ++i) {
      const std::size_t size = i < 12 ? i * 3 : whole.size() * i / 40;
      SCOPED_TRACE(std::string(name) + " cut to " + std::to_string(size));
      test::writeText(cut, whole.substr(0, size));
      std::string error = test::openingError(cut, calibrated());
      if (error.empty()) {
        const auto all = test::readAll(cut, calibrated());
        error = all.error;
        ASSERT_LE(all.steps.size(), expected.steps.size());
        for (std::size_t k = 0; k < all.steps.size(); ++k)
          EXPECT_EQ(all.steps[k].frame.t_ns, expected.steps[k].frame.t_ns);
      }
      EXPECT_NE(error, "");
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

/// Bytes changed anywhere must not crash the reader or make it take memory without bound.
TEST_F(BagRecordingTest, ChangedBytesAreSurvived) {
  const Silence silence;
  for (const char* name : {"a.bag", "lz4.bag", "a.db3", "plain.mcap", "lz4.mcap", "zstd_split.mcap"}) {
    const std::string whole = test::bytesOf(path(name)),
                      changed = path(std::string("changed") + fs::path(name).extension().string());
    for (std::size_t i = 0; i < 60; ++i) {
      std::string bytes = whole;
      const std::size_t place = (i * 7919 + i * i * 104729) % bytes.size();
      bytes[place] = static_cast<char>(bytes[place] ^ (1 << i % 8));
      SCOPED_TRACE(std::string(name) + " changed at " + std::to_string(place));
      test::writeText(changed, bytes);
      std::string error = test::openingError(changed, calibrated());
      if (error.empty()) error = test::readAll(changed, calibrated()).error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

TEST_F(BagRecordingTest, OtherFilesAreRefused) {
  const Silence silence;
  for (const char* name : {"other.bag", "other.db3", "other.mcap"}) {
    EXPECT_THAT(test::openingError(path(name), calibrated()), HasSubstr("does not exist"));
    test::writeText(path(name), "");
    EXPECT_NE(test::openingError(path(name), calibrated()), "");
    test::writeText(path(name), std::string(10000, 'x'));
    EXPECT_THAT(test::openingError(path(name), calibrated()), HasSubstr(name));
  }
}

}  // namespace
}  // namespace lintel
