// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <algorithm>
#include <cstring>

#include "RawlogFile.h"
#include "TinyEuroc.h"
#include "TinyRawlog.h"
#include "lintel/sensing/EurocToRawlog.h"
#include "lintel/sensing/RecordedSensors.h"

namespace lintel::test {
namespace {

using mrpt::obs::CObservationComment;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationIMU;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class T>
std::shared_ptr<T> as(const ObservationPtr& observation) {
  return std::dynamic_pointer_cast<T>(observation);
}

template <class T>
void removeAll(std::vector<ObservationPtr>& observations) {
  observations.erase(std::remove_if(observations.begin(), observations.end(),
                                    [](const ObservationPtr& observation) { return as<T>(observation) != nullptr; }),
                     observations.end());
}

class RawlogRecordingTest : public testing::Test {
 protected:
  RawlogRecordingTest() { TinyEuroc().write(root_); }
  void convert(bool embed = false, int level = 5) {
    EurocToRawlogParams params;
    params.embed = embed;
    params.compress_level = level;
    params.overwrite = true;
    eurocToRawlog(root_, rawlog_, params);
  }
  void expectSameAsFolder() {
    const auto folder = openRecording(root_), rawlog = openRecording(rawlog_);
    expectSameRig(folder->rig(), rawlog->rig());
    const Everything a = readAll(*folder), b = readAll(*rawlog);
    EXPECT_EQ(b.error, "");
    expectSameSteps(a.steps, b.steps);
  }

  TempFolder folder_;
  std::string root_ = folder_ / "flight", rawlog_ = folder_ / "flight.rawlog";
};

TEST_F(RawlogRecordingTest, ExternalImagesGiveTheSameAsTheFolder) {
  convert();
  expectSameAsFolder();
  EXPECT_THAT(openRecording(rawlog_)->warnings(), IsEmpty());
}

TEST_F(RawlogRecordingTest, EmbeddedImagesGiveTheSameAsTheFolder) {
  for (const int level : {0, 1, 9}) {
    convert(true, level);
    expectSameAsFolder();
  }
}

TEST_F(RawlogRecordingTest, RangesGiveTheSameAsTheFolder) {
  convert(true);
  RecordingParams params;
  params.from_s = 0.21;
  params.to_s = 0.7;
  const Everything a = readAll(root_, params), b = readAll(rawlog_, params);
  ASSERT_EQ(a.steps.size(), 10u);
  expectSameSteps(a.steps, b.steps);
}

TEST_F(RawlogRecordingTest, FaultyFoldersGiveTheSameAsTheirRawlog) {
  const std::string imu = root_ + "/mav0/imu0/data.csv", text = bytesOf(imu);
  // A drop-out, a sample twice, one not finite.
  const std::size_t a = text.find('\n', text.size() / 3) + 1, b = text.find('\n', text.size() / 2) + 1;
  const std::string twice = text.substr(b, text.find('\n', b) + 1 - b);
  writeText(imu, text.substr(0, a) + twice + "1403636580563555584,nan,0,0,0,0,0\n" + text.substr(b));
  std::filesystem::remove(root_ + "/mav0/cam0/data/" + std::to_string(TinyEuroc::frameStamp(3)) + ".png");
  convert(true);
  expectSameAsFolder();
  convert(false);
  expectSameAsFolder();
}

TEST_F(RawlogRecordingTest, AnImuPoseOtherThanIdentityGivesTheSame) {
  replaceInFile(root_ + "/mav0/imu0/sensor.yaml", "[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0,",
                "[0.0, -1.0, 0.0, 0.3, 0.6, 0.0, -0.8, 0.1, 0.8, 0.0, 0.6, 0.7,");
  convert();
  expectSameAsFolder();
}

TEST_F(RawlogRecordingTest, AxesOfTheImuGiveTheSame) {
  replaceInFile(root_ + "/mav0/imu0/sensor.yaml", "rate_hz:",
                "accelerometer_axes: [0.01, 0.02, 0, -0.05, 0, 0.03, 0, 0.007, -0.02]\n"
                "gyroscope_axes: [-0.01, 0.002, 0, 0.002, 0.02, 0.005, 0, 0.005, 0]\nrate_hz:");
  convert();
  expectSameAsFolder();
}

TEST_F(RawlogRecordingTest, SensorsOutOfStepWithEachOtherGiveTheSame) {
  convert();
  edit(rawlog_, [](auto& observations) {  // images 0.2 s late in the file, as drivers deliver them
    std::stable_sort(observations.begin() + 1, observations.end(), [](const auto& a, const auto& b) {
      const auto key = [](const auto& o) {
        // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): no observation is null
        return o->timestamp + mrpt::Clock::duration(as<CObservationImage>(o) ? 2000000 : 0);
      };
      return key(a) < key(b);
    });
  });
  expectSameAsFolder();
}

TEST_F(RawlogRecordingTest, WithoutOurNoteNoiseIsAssumedAndRatesAreMeasured) {
  convert();
  edit(rawlog_, removeAll<CObservationComment>);
  const auto recording = openRecording(rawlog_);
  EXPECT_THAT(recording->warnings(), ElementsAre(HasSubstr("noise densities")));
  EXPECT_EQ(recording->rig().imu_noise.accel_noise, ImuNoise().accel_noise);
  EXPECT_EQ(recording->rig().imu_rate_hz, 200);
  EXPECT_EQ(recording->rig().camera_rate_hz, 20);
  expectSameSteps(readAll(root_).steps, readAll(*recording).steps);
}

TEST_F(RawlogRecordingTest, LabelsOfOthersAreTaken) {
  convert();
  edit(rawlog_, [](auto& observations) {
    for (const auto& observation : observations) {
      if (as<CObservationImage>(observation)) observation->sensorLabel = "FRONT";
      if (as<CObservationIMU>(observation)) observation->sensorLabel = "XSENS";
    }
  });
  EXPECT_EQ(readAll(rawlog_).steps.size(), 20u);
  RecordingParams params;
  params.camera = "BACK";
  EXPECT_THAT(openingError(rawlog_, params),
              HasSubstr("no camera image (CObservationImage, CObservationStereoImages) labelled 'BACK'"));
  params.camera = "FRONT";
  params.imu = "GPS";
  EXPECT_THAT(openingError(rawlog_, params), HasSubstr("no IMU sample (CObservationIMU) labelled 'GPS'"));
}

TEST_F(RawlogRecordingTest, OfAStereoPairTheLeftImageIsTaken) {
  for (const bool embed : {false, true}) {
    convert(embed);
    edit(rawlog_, [](auto& observations) {
      for (auto& observation : observations) {
        const auto image = as<CObservationImage>(observation);
        if (!image) continue;
        auto pair = mrpt::obs::CObservationStereoImages::Create();
        pair->sensorLabel = image->sensorLabel;
        pair->timestamp = image->timestamp;
        pair->leftCamera = image->cameraParams;
        pair->cameraPose = mrpt::poses::CPose3DQuat(image->cameraPose);
        pair->imageLeft = image->image;
        pair->hasImageRight = false;
        observation = pair;
      }
    });
    expectSameAsFolder();
    const auto sensors = recordedSensors(rawlog_, {});
    EXPECT_TRUE(std::any_of(sensors.begin(), sensors.end(), [](const RecordedSensor& s) {
      return s.kind.find("CObservationStereoImages") != std::string::npos;
    }));
  }
}

/// MRPT stores colour images as JPEG.
TEST_F(RawlogRecordingTest, ColourImagesInJpegAreRead) {
  convert(true);
  edit(rawlog_, [](auto& observations) {
    for (auto& observation : observations)
      if (const auto image = as<CObservationImage>(observation)) image->image = image->image.colorImage();
  });
  const Everything gray = readAll(root_), colour = readAll(rawlog_);
  ASSERT_EQ(gray.steps.size(), colour.steps.size());
  const GrayImage &a = *gray.steps[3].frame.image, &b = *colour.steps[3].frame.image;
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  double difference = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) difference += std::abs(a.pixels[i] - b.pixels[i]);
  EXPECT_LT(difference / static_cast<double>(a.pixels.size()), 8);
}

TEST_F(RawlogRecordingTest, SecondCameraIsChosenByName) {
  TinyEuroc two;
  two.cameras = {"cam0", "cam1"};
  two.write(root_);
  convert();
  for (const char* camera : {"cam0", "cam1"}) {
    RecordingParams params;
    params.camera = camera;
    expectSameSteps(readAll(root_, params).steps, readAll(rawlog_, params).steps);
  }
  expectSameAsFolder();
}

TEST_F(RawlogRecordingTest, IncompleteImuObservationsAreRefused) {
  convert();
  edit(rawlog_, [](auto& observations) {
    for (const auto& observation : observations)
      if (const auto imu = as<CObservationIMU>(observation)) imu->dataIsPresent[mrpt::obs::IMU_WY] = false;
  });
  EXPECT_THAT(openingError(rawlog_), HasSubstr("lack angular velocities or accelerations"));
  convert();
  edit(rawlog_, removeAll<CObservationIMU>);
  EXPECT_THAT(openingError(rawlog_), HasSubstr("holds no IMU sample"));
  convert();
  edit(rawlog_, removeAll<CObservationImage>);
  EXPECT_THAT(openingError(rawlog_), HasSubstr("holds no camera image"));
}

// Found by the fuzzer: MRPT keeps the byte as it is, and no bool may be 255.
TEST_F(RawlogRecordingTest, ADamagedFlagIsOneThatIsSet) {
  convert();
  edit(rawlog_, [](auto& observations) {
    for (const auto& observation : observations)
      if (const auto imu = as<CObservationIMU>(observation))
        std::memset(&imu->dataIsPresent[mrpt::obs::IMU_WY], 255, 1);
  });
  RawlogFile file(rawlog_);
  int samples = 0;
  while (const auto observation = file.next()) {
    const auto imu = as<CObservationIMU>(observation);
    if (!imu) continue;
    unsigned char flag = 0;
    std::memcpy(&flag, &imu->dataIsPresent[mrpt::obs::IMU_WY], 1);
    EXPECT_EQ(flag, 1);
    ++samples;
  }
  EXPECT_GT(samples, 0);
}

TEST_F(RawlogRecordingTest, UnusableCalibrationsAreRefused) {
  const auto errorAfter = [this](const std::function<void(CObservationImage&)>& change) {
    convert();
    edit(rawlog_, [&](auto& observations) {
      for (const auto& observation : observations)
        if (const auto image = as<CObservationImage>(observation)) change(*image);
    });
    return openingError(rawlog_);
  };
  EXPECT_THAT(errorAfter([](auto& image) { image.cameraParams = mrpt::img::TCamera(); }), HasSubstr("focal lengths"));
}

TEST_F(RawlogRecordingTest, LensesOfOtherModelsAreRead) {
  const auto lensAfter = [this](const std::function<void(mrpt::img::TCamera&)>& change) {
    convert();
    edit(rawlog_, [&](auto& observations) {
      for (const auto& observation : observations)
        if (const auto image = as<CObservationImage>(observation)) change(image->cameraParams);
    });
    return openRecording(rawlog_)->rig().camera;
  };
  const Camera fisheye = lensAfter([](auto& camera) { camera.setDistortionKannalaBrandt(0.1, 0.2, 0.3, 0.4); });
  EXPECT_EQ(fisheye.model, LensModel::kEquidistant);
  EXPECT_EQ(fisheye.lens, (std::array<double, 8>{0.1, 0.2, 0.3, 0.4}));
  const Camera sixth = lensAfter([](auto& camera) { camera.setDistortionPlumbBob(0.1, 0.2, 0.3, 0.4, 0.5); });
  EXPECT_EQ(sixth.model, LensModel::kRadialTangential);
  EXPECT_EQ(sixth.lens[4], 0.5);
  EXPECT_EQ(lensAfter([](auto& camera) { camera.k5(0.1); }).model, LensModel::kRational);
}

TEST_F(RawlogRecordingTest, AFisheyeGoesIntoARawlogAndBack) {
  replaceInFile(root_ + "/mav0/cam0/sensor.yaml", "radial-tangential", "equidistant");
  convert();
  expectSameRig(openRecording(rawlog_)->rig(), openRecording(root_)->rig());
}

TEST_F(RawlogRecordingTest, UndistortedCamerasAreAccepted) {
  convert();
  edit(rawlog_, [](auto& observations) {
    for (const auto& observation : observations)
      if (const auto image = as<CObservationImage>(observation))
        image->cameraParams.distortion = mrpt::img::DistortionModel::none;
  });
  EXPECT_EQ(openRecording(rawlog_)->rig().camera.lens[0], 0);
}

TEST_F(RawlogRecordingTest, ObservationsWithoutTimeAreSkipped) {
  convert();
  edit(rawlog_, [](auto& observations) {
    auto untimed = CObservationIMU::Create();
    untimed->sensorLabel = "imu0";
    untimed->timestamp = mrpt::Clock::time_point();
    observations.push_back(untimed);
  });
  const Everything all = readAll(rawlog_);
  EXPECT_EQ(all.steps.size(), 20u);
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("no time stamp")));
}

TEST_F(RawlogRecordingTest, ImagesOfTheUncutRawlogAreFound) {
  convert();
  const std::string cut = folder_ / "cut.rawlog";
  std::filesystem::rename(rawlog_, cut);
  const Everything all = readAll(cut);
  expectSameSteps(all.steps, readAll(root_).steps);
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("images taken from")));
  std::filesystem::rename(folder_ / "flight_Images", folder_ / "elsewhere");
  EXPECT_THAT(openingError(cut), AllOf(HasSubstr("external images are missing"), HasSubstr("cut_Images")));
}

TEST_F(RawlogRecordingTest, WhatIsNoRawlogIsSaid) {
  writeText(rawlog_, "This is text, not a rawlog, however long it may be.\n");
  EXPECT_THAT(openingError(rawlog_), HasSubstr("not a rawlog"));
  writeText(rawlog_, "");
  EXPECT_THAT(openingError(rawlog_), HasSubstr("holds no camera image"));
  EXPECT_THAT(openingError(folder_ / "none.rawlog"), HasSubstr("does not exist"));
}

TEST_F(RawlogRecordingTest, ACutFileGivesWhatIsBeforeTheCut) {
  const std::vector<FrameWithImu> whole = readAll(root_).steps;
  for (const int level : {0, 5}) {
    convert(true, level);
    const std::string bytes = bytesOf(rawlog_);
    for (const double part : {0.6, 0.8, 0.93, 0.99}) {
      writeText(rawlog_, bytes.substr(0, static_cast<std::size_t>(part * static_cast<double>(bytes.size()))));
      const Everything all = readAll(rawlog_);
      EXPECT_THAT(all.error, HasSubstr("cut or damaged after")) << level << " " << part;
      ASSERT_LE(all.steps.size(), whole.size());
      EXPECT_GT(all.steps.size(), 0u);
      expectSameSteps(all.steps, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(all.steps.size())});
    }
  }
}

TEST_F(RawlogRecordingTest, ReadsNoFurtherAheadThanASecondInADropOut) {
  TinyEuroc longer;
  longer.frames = 100;
  longer.write(root_);
  convert(true, 0);
  edit(rawlog_, [](auto& observations) {  // no IMU in the rest of the file
    int images = 0;
    observations.erase(std::remove_if(observations.begin(), observations.end(),
                                      [&](const auto& o) {
                                        images += as<CObservationImage>(o) != nullptr;
                                        return images > 30 && as<CObservationIMU>(o);
                                      }),
                       observations.end());
  });
  // Damaged at the end: who reads on in search of IMU samples meets the damage before frame 31 is delivered.
  const std::string bytes = bytesOf(rawlog_);
  writeText(rawlog_, bytes.substr(0, bytes.size() - 10));
  const Everything all = readAll(rawlog_);
  EXPECT_GE(all.steps.size(), 75u);
  EXPECT_THAT(all.error, HasSubstr("cut or damaged"));
}

}  // namespace
}  // namespace lintel::test
