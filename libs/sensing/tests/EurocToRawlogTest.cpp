// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/EurocToRawlog.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>

#include "RawlogFile.h"
#include "TinyEuroc.h"
#include "TinyRawlog.h"
#include "lintel/core/FolderLock.h"

namespace lintel::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class EurocToRawlogTest : public testing::Test {
 protected:
  EurocToRawlogTest() {
    TinyEuroc recording;
    recording.cameras = {"cam0", "cam1"};
    recording.write(root_);
    fs::create_directory(out_);
  }
  std::string error(const EurocToRawlogParams& params = {}) const {
    try {
      eurocToRawlog(root_, rawlog_, params);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  }
  std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(out_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  TempFolder folder_;
  std::string root_ = folder_ / "flight", out_ = folder_ / "out", rawlog_ = out_ + "/flight.rawlog";
};

TEST_F(EurocToRawlogTest, WritesEverySensorInTimeOrder) {
  const EurocToRawlogSummary summary = eurocToRawlog(root_, rawlog_);
  EXPECT_THAT(summary.images, ElementsAre(testing::Pair("cam0", 20u), testing::Pair("cam1", 20u)));
  EXPECT_EQ(summary.groundtruth_poses, 20u);
  EXPECT_THAT(summary.warnings, IsEmpty());
  const auto observations = readObservations(rawlog_);
  EXPECT_EQ(observations.size(), 1 + 40 + 20 + summary.imu_samples);
  EXPECT_TRUE(std::is_sorted(observations.begin(), observations.end(),
                             [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; }));
  EXPECT_EQ(timeOf(*observations.front()), summary.first_ns);
  EXPECT_EQ(timeOf(*observations.back()), summary.last_ns);
}

TEST_F(EurocToRawlogTest, ObservationsCarryTheCalibration) {
  eurocToRawlog(root_, rawlog_);
  bool image_seen = false, pose_seen = false;
  for (const auto& observation : readObservations(rawlog_)) {
    if (const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation)) {
      image_seen = true;
      EXPECT_EQ(image->cameraParams.ncols, 32u);
      EXPECT_EQ(image->cameraParams.cx(), 15.215);
      EXPECT_EQ(image->cameraParams.p1(), 0.00019359);
      EXPECT_NEAR(image->cameraPose.getRotationMatrix()(0, 1), -0.999880929698, 1e-10);
      EXPECT_EQ(image->cameraPose.z(), 0.00981073058949);
    }
    if (const auto truth = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation)) {
      pose_seen = true;
      EXPECT_EQ(truth->sensorLabel, "groundtruth");
      EXPECT_EQ(truth->pose.mean.y(), 2.5);
      EXPECT_NEAR(truth->pose.mean.getRotationMatrix()(2, 1), 0.96, 1e-12);  // 2 w x
    }
  }
  EXPECT_TRUE(image_seen && pose_seen);
}

TEST_F(EurocToRawlogTest, ExternalImagesStandWhereMrptLooks) {
  const EurocToRawlogSummary summary = eurocToRawlog(root_, rawlog_);
  EXPECT_EQ(summary.images_folder, out_ + "/flight_Images");
  EXPECT_EQ(summary.linked, 40u);
  EXPECT_THAT(written(), ElementsAre("flight.rawlog", "flight_Images"));
  for (const auto& observation : readObservations(rawlog_))
    if (const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation)) {
      const std::string file = out_ + "/flight_Images/" + image->image.getExternalStorageFile();
      const std::string name = fs::path(file).filename().string();
      EXPECT_EQ(bytesOf(file), bytesOf(root_ + "/mav0/" + name.substr(0, 4) + "/data/" + name.substr(5)));
    }
}

TEST_F(EurocToRawlogTest, CopiesDoNotTouchTheOriginals) {
  EurocToRawlogParams params;
  params.copy = true;
  EXPECT_EQ(eurocToRawlog(root_, rawlog_, params).copied, 40u);
  for (const auto& entry : fs::directory_iterator(out_ + "/flight_Images")) {
    EXPECT_FALSE(entry.is_symlink());
    EXPECT_EQ(entry.hard_link_count(), 1u);
  }
}

TEST_F(EurocToRawlogTest, EmbeddedIsOneFile) {
  EurocToRawlogParams params;
  params.embed = true;
  params.cameras = {"cam1"};
  const EurocToRawlogSummary summary = eurocToRawlog(root_, rawlog_, params);
  EXPECT_THAT(summary.images, ElementsAre(testing::Pair("cam1", 20u)));
  EXPECT_EQ(summary.images_folder, "");
  EXPECT_THAT(written(), ElementsAre("flight.rawlog"));
}

TEST_F(EurocToRawlogTest, TheSameInputGivesTheSameBytes) {
  EurocToRawlogParams params;
  params.overwrite = true;
  for (const bool embed : {false, true}) {
    params.embed = embed;
    eurocToRawlog(root_, rawlog_, params);
    const std::string first = bytesOf(rawlog_);
    eurocToRawlog(root_, rawlog_, params);
    EXPECT_EQ(bytesOf(rawlog_), first);
  }
}

TEST_F(EurocToRawlogTest, NothingIsOverwrittenUnasked) {
  writeText(rawlog_, "mine");
  EXPECT_THAT(error(), HasSubstr("exists already"));
  EXPECT_EQ(bytesOf(rawlog_), "mine");
  EurocToRawlogParams params;
  params.overwrite = true;
  EXPECT_EQ(error(params), "");
  EXPECT_EQ(error(params), "");
  EXPECT_THAT(written(), ElementsAre("flight.rawlog", "flight_Images"));
}

TEST_F(EurocToRawlogTest, OneRunAtATimeWritesARawlog) {
  writeText(rawlog_ + ".part", "");
  {
    const FolderLock other(rawlog_ + ".part");
    EXPECT_THAT(error(), HasSubstr("another run is writing to it"));
    EXPECT_TRUE(fs::exists(rawlog_ + ".part")) << "it is the other's";
  }
  EXPECT_EQ(error(), "") << "what a killed run left is no obstacle";
  EXPECT_FALSE(fs::exists(rawlog_ + ".part"));
}

TEST_F(EurocToRawlogTest, AFolderOfSomebodyElseIsNeverReplaced) {
  fs::create_directory(out_ + "/flight_Images");
  writeText(out_ + "/flight_Images/holiday.png", "mine");
  EurocToRawlogParams params;
  params.overwrite = true;
  EXPECT_THAT(error(params), HasSubstr("exists already, without its rawlog"));
  EXPECT_EQ(bytesOf(out_ + "/flight_Images/holiday.png"), "mine");
}

TEST_F(EurocToRawlogTest, FailuresLeaveNothingAndKeepTheOld) {
  eurocToRawlog(root_, rawlog_);
  const std::string old = bytesOf(rawlog_);
  std::string text = bytesOf(root_ + "/mav0/imu0/data.csv");
  writeText(root_ + "/mav0/imu0/data.csv", text.insert(text.size() / 2, "\nx,y\n"));
  EurocToRawlogParams params;
  params.overwrite = true;
  EXPECT_THAT(error(params), HasSubstr("imu0/data.csv:"));
  EXPECT_THAT(written(), ElementsAre("flight.rawlog", "flight_Images"));
  EXPECT_EQ(bytesOf(rawlog_), old);
  EXPECT_EQ(readAll(rawlog_).steps.size(), 20u);
}

TEST_F(EurocToRawlogTest, MissingImagesAreLeftOut) {
  fs::remove(root_ + "/mav0/cam0/data/" + std::to_string(TinyEuroc::frameStamp(4)) + ".png");
  const EurocToRawlogSummary summary = eurocToRawlog(root_, rawlog_);
  EXPECT_EQ(summary.images.at("cam0"), 19u);
  EXPECT_THAT(summary.warnings, ElementsAre(AllOf(HasSubstr("missing"), HasSubstr("left out"))));
  fs::remove_all(root_ + "/mav0/cam0/data");
  EurocToRawlogParams params;
  params.overwrite = true;
  EXPECT_THAT(error(params), HasSubstr("cam0: no image could be read"));
}

TEST_F(EurocToRawlogTest, WrongRequestsAreNamed) {
  EurocToRawlogParams params;
  params.cameras = {"cam7"};
  EXPECT_THAT(error(params), HasSubstr("mav0/cam7: no such camera"));
  params.cameras = {"cam0", "cam0"};
  EXPECT_THAT(error(params), HasSubstr("cam0 is named twice"));
  rawlog_ = out_ + "/flight.bag";
  EXPECT_THAT(error(), HasSubstr("must end in .rawlog"));
  rawlog_ = out_ + "/none/flight.rawlog";
  EXPECT_THAT(error(), HasSubstr("no such folder"));
  EXPECT_THAT(written(), IsEmpty());
}

TEST_F(EurocToRawlogTest, ProgressReachesItsEnd) {
  std::vector<std::size_t> done;
  eurocToRawlog(root_, rawlog_, {}, [&](std::size_t n, std::size_t total) {
    done.push_back(n);
    EXPECT_EQ(total, 40u);
  });
  EXPECT_EQ(done.size(), 40u);
  EXPECT_EQ(done.back(), 40u);
}

}  // namespace
}  // namespace lintel::test
