// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <sstream>

#include <opencv2/imgcodecs.hpp>

#include "TimeTicks.h"
#include "TinyEuroc.h"

namespace lintel::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class EurocRecordingTest : public testing::Test {
 protected:
  EurocRecordingTest() { TinyEuroc().write(root_); }
  std::string stampName(int frame) const { return std::to_string(TinyEuroc::frameStamp(frame)) + ".png"; }
  std::string imagePath(int frame) const { return camera_ + "/data/" + stampName(frame); }

  TempFolder folder_;
  std::string root_ = folder_ / "flight", camera_ = root_ + "/mav0/cam0", imu_ = root_ + "/mav0/imu0";
};

TEST_F(EurocRecordingTest, GivesEveryFrameWithItsImage) {
  const Everything all = readAll(root_);
  EXPECT_EQ(all.error, "");
  EXPECT_THAT(all.warnings, IsEmpty());
  ASSERT_EQ(all.steps.size(), 20u);
  for (int i = 0; i < 20; ++i) {
    const Frame& frame = all.steps[i].frame;
    EXPECT_EQ(frame.t_ns, TinyEuroc::frameStamp(i) / 100 * 100);
    EXPECT_EQ(frame.image->width, 32);
    EXPECT_EQ(frame.image->height, 24);
    EXPECT_EQ(frame.image->pixels[1], (7 + i * 31) & 255);
    EXPECT_EQ(frame.image->pixels[32], (13 + i * 31) & 255);
  }
}

TEST_F(EurocRecordingTest, ReadsTheCalibration) {
  const Rig rig = openRecording(root_)->rig();
  EXPECT_EQ(rig.camera.width, 32);
  EXPECT_EQ(rig.camera.fy, 30.296);
  EXPECT_EQ(rig.camera.lens[1], 0.07395907);
  EXPECT_EQ(rig.camera.lens[3], 1.76187114e-05);
  EXPECT_EQ(rig.T_b_c.p.y(), -0.064676986768);
  EXPECT_NEAR(rig.T_b_c.R()(0, 1), -0.999880929698, 1e-10);
  EXPECT_NEAR(rig.T_b_c.R()(2, 0), -0.0257744366974, 1e-10);
  EXPECT_EQ(rig.imu_noise.gyro_walk, 2.1e-05);
  EXPECT_EQ(rig.imu_noise.accel_noise, 2.3e-3);
  EXPECT_EQ(rig.imu_rate_hz, 200);
  EXPECT_EQ(rig.camera_rate_hz, 20);
}

TEST_F(EurocRecordingTest, SamplesAreCorrectedForTheImusAxes) {
  const Everything measured = readAll(root_);
  Eigen::Matrix3d A, G;
  A << 0.01, 0.02, 0, -0.05, 0, 0.03, 0, 0.007, -0.02;
  G << -0.01, 0.002, 0, 0.002, 0.02, 0.005, 0, 0.005, 0;
  replaceInFile(imu_ + "/sensor.yaml", "rate_hz:",
                "accelerometer_axes: [0.01, 0.02, 0, -0.05, 0, 0.03, 0, 0.007, -0.02]\n"
                "gyroscope_axes: [-0.01, 0.002, 0, 0.002, 0.02, 0.005, 0, 0.005, 0]\nrate_hz:");
  const Everything corrected = readAll(root_);
  EXPECT_EQ(openRecording(root_)->rig().axes.A, A);
  ASSERT_EQ(corrected.steps.size(), measured.steps.size());
  for (std::size_t i = 0; i < measured.steps.size(); ++i)
    for (std::size_t k = 0; k < measured.steps[i].imu.size(); ++k) {
      const ImuSample &before = measured.steps[i].imu[k], &after = corrected.steps[i].imu[k];
      EXPECT_LT((after.accel - before.accel - A * before.accel).norm(), 1e-12);
      EXPECT_LT((after.gyro - before.gyro - G * before.gyro).norm(), 1e-12);
    }
}

TEST_F(EurocRecordingTest, AxesThatNoImuHasAreRefused) {
  replaceInFile(imu_ + "/sensor.yaml", "rate_hz:", "accelerometer_axes: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nrate_hz:");
  EXPECT_THAT(openingError(root_),
              HasSubstr("sensor.yaml: accelerometer_axes must be errors of scales and directions"));
  replaceInFile(imu_ + "/sensor.yaml", "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[0, 0, 0]");
  EXPECT_THAT(openingError(root_), HasSubstr("accelerometer_axes needs 9 values"));
}

TEST_F(EurocRecordingTest, ReadsAFisheye) {
  replaceInFile(root_ + "/mav0/cam0/sensor.yaml", "radial-tangential", "equidistant");
  const Camera camera = openRecording(root_)->rig().camera;
  EXPECT_EQ(camera.model, LensModel::kEquidistant);
  EXPECT_EQ(camera.lens[3], 1.76187114e-05);
}

TEST_F(EurocRecordingTest, ReadsALensThatIsACameraModel) {
  replaceInFile(root_ + "/mav0/cam0/sensor.yaml", "camera_model: pinhole", "camera_model: ds");
  replaceInFile(root_ + "/mav0/cam0/sensor.yaml", "intrinsics: [", "intrinsics: [-0.2, 0.6, ");
  const Camera camera = openRecording(root_)->rig().camera;
  EXPECT_EQ(camera.model, LensModel::kDoubleSphere);
  EXPECT_EQ(camera.lens[1], 0.6);
  EXPECT_EQ(camera.fx, 31.654);
}

TEST_F(EurocRecordingTest, AnImuThatIsNotTheBodyMovesTheCamera) {
  replaceInFile(imu_ + "/sensor.yaml", "data: [1.0, 0.0, 0.0, 0.0,", "data: [1.0, 0.0, 0.0, 0.25,");
  EXPECT_DOUBLE_EQ(openRecording(root_)->rig().T_b_c.p.x(), -0.0216401454975 - 0.25);
}

TEST_F(EurocRecordingTest, ImuBatchesJoinAtTheFrames) {
  const Everything all = readAll(root_);
  for (std::size_t i = 1; i < all.steps.size(); ++i) {
    const ImuBatch &before = all.steps[i - 1].imu, &imu = all.steps[i].imu;
    ASSERT_EQ(imu.size(), 12u);  // 10 samples between the frames and both ends
    EXPECT_EQ(imu.front().t_ns, all.steps[i - 1].frame.t_ns);
    EXPECT_EQ(imu.back().t_ns, all.steps[i].frame.t_ns);
    EXPECT_EQ(imu.front().gyro, before.back().gyro);
    EXPECT_EQ(imu.front().accel, before.back().accel);
    for (std::size_t k = 1; k < imu.size(); ++k) EXPECT_LT(imu[k - 1].t_ns, imu[k].t_ns);
    for (const ImuSample& sample : imu) {
      EXPECT_EQ(sample.t_ns % kTick_ns, 0);
      // The signals are linear, so that interpolation is exact but for the stamps cut by up to 100 ns.
      EXPECT_TRUE(sample.gyro.isApprox(TinyEuroc::gyroAt(sample.t_ns), 1e-6));
      EXPECT_TRUE(sample.accel.isApprox(TinyEuroc::accelAt(sample.t_ns), 1e-6));
    }
  }
}

TEST_F(EurocRecordingTest, TheFirstBatchHoldsHalfASecond) {
  const ImuBatch imu = readAll(root_).steps.front().imu;
  EXPECT_EQ(imu.back().t_ns, TinyEuroc::kFirst_ns / 100 * 100);
  EXPECT_GE(imu.front().t_ns, imu.back().t_ns - 500000000);
  EXPECT_LT(imu.front().t_ns, imu.back().t_ns - 494000000);
}

TEST_F(EurocRecordingTest, SamplesThatCameInPacketsHaveTimesOfTheirOwn) {
  TinyEuroc longer;
  longer.frames = 100;
  longer.write(root_);
  const std::string table = root_ + "/mav0/imu0/data.csv";
  std::istringstream lines(bytesOf(table));
  std::string header, line, text;
  std::getline(lines, header);
  std::vector<std::string> stamps, values;
  while (std::getline(lines, line)) {
    stamps.push_back(line.substr(0, line.find(',')));
    values.push_back(line.substr(line.find(',')));
  }
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::size_t last = std::min(i / 4 * 4 + 3, stamps.size() - 1);
    text += std::to_string(std::stoll(stamps[last]) + 200'000 * static_cast<std::int64_t>(i % 4)) + values[i] + "\n";
  }
  writeText(table, header + "\n" + text);
  const Everything all = readAll(root_);
  EXPECT_EQ(all.error, "");
  EXPECT_THAT(all.warnings, Contains(HasSubstr("in packets of about 4")));
  ASSERT_EQ(all.steps.size(), 100U);
  for (std::size_t f = 30; f < 70; ++f)
    for (const ImuSample& sample : all.steps[f].imu) {
      // on average they arrive 7.8 ms after they were taken
      const Eigen::Vector3d late = sample.gyro - TinyEuroc::gyroAt(sample.t_ns - 7'800'000);
      const Eigen::Vector3d a_millisecond = TinyEuroc::gyroAt(1'000'000) - TinyEuroc::gyroAt(0);
      EXPECT_LT(late.norm(), a_millisecond.norm());
    }
}

TEST_F(EurocRecordingTest, ImagesThatWereStampedOnArrivalHaveTimesOfTheirOwn) {
  TinyEuroc longer;
  longer.frames = 100;
  longer.write(root_);
  const std::string table = camera_ + "/data.csv";
  const std::vector<FrameWithImu> whole = readAll(root_).steps;
  std::istringstream lines(bytesOf(table));
  std::string header, line, text;
  std::getline(lines, header);
  std::mt19937 random(4);
  std::exponential_distribution<double> late_ms(0.2);
  while (std::getline(lines, line)) {
    const std::int64_t t_ns = std::stoll(line) + std::llround(1e6 * late_ms(random));
    text += std::to_string(t_ns) + line.substr(line.find(',')) + "\n";
  }
  writeText(table, header + "\n" + text);
  const Everything all = readAll(root_);
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("the stamps of images scatter by")));
  ASSERT_EQ(all.steps.size(), 100U);
  for (std::size_t i = 20; i < 80; ++i)
    EXPECT_NEAR(1e-6 * static_cast<double>(all.steps[i].frame.t_ns - whole[i].frame.t_ns), 3.5, 2.5);
}

TEST_F(EurocRecordingTest, AnImageThatShowsTheOneBeforeAgainIsSkipped) {
  namespace fs = std::filesystem;
  const auto repeat = [&](int to) {
    fs::copy_file(imagePath(to - 1), imagePath(to), fs::copy_options::overwrite_existing);
  };
  repeat(7);
  repeat(12);
  repeat(13);
  const Everything all = readAll(root_);
  EXPECT_EQ(all.error, "");
  EXPECT_EQ(all.steps.size(), 17U);
  EXPECT_THAT(all.warnings,
              ElementsAre(HasSubstr("shows the one before again"), HasSubstr("shows the one before again"),
                          HasSubstr("shows the one before again")));
  for (std::size_t i = 1; i < all.steps.size(); ++i)
    EXPECT_EQ(all.steps[i].imu.front().t_ns, all.steps[i - 1].frame.t_ns) << "the IMU has no gap";
}

TEST_F(EurocRecordingTest, ACameraWithoutNoiseThatDoesNotMoveIsNotSkippedForLong) {
  TinyEuroc longer;
  longer.frames = 60;
  longer.write(root_);
  for (int i = 11; i < 60; ++i)
    std::filesystem::copy_file(imagePath(10), imagePath(i), std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(readAll(root_).steps.size(), 40U);
}

TEST_F(EurocRecordingTest, Mav0ItselfIsTheSame) {
  expectSameSteps(readAll(root_).steps, readAll(root_ + "/mav0").steps);
}

TEST_F(EurocRecordingTest, DecodingAheadChangesNothing) {
  std::filesystem::remove(imagePath(7));
  RecordingParams asked;
  asked.frames_ahead = 0;
  const Everything plain = readAll(root_, asked);
  for (const std::size_t ahead : {1u, 8u, 100u}) {
    asked.frames_ahead = ahead;
    const Everything other = readAll(root_, asked);
    expectSameSteps(plain.steps, other.steps);
    EXPECT_EQ(plain.warnings, other.warnings);
  }
}

TEST_F(EurocRecordingTest, DecodesNoFurtherThanAsked) {
  RecordingParams params;
  params.frames_ahead = 3;
  const auto recording = openRecording(root_, params);
  ASSERT_TRUE(recording->next());
  // At most: 1 delivered + 3 waiting + 1 in work.
  for (int i = 5; i < 20; ++i) std::filesystem::remove(imagePath(i));
  EXPECT_EQ(readAll(*recording).steps.size(), 4u);
}

TEST_F(EurocRecordingTest, CanBeLeftInTheMiddle) {
  for (int taken = 0; taken < 3; ++taken) {
    const auto recording = openRecording(root_);
    for (int i = 0; i < taken; ++i) ASSERT_TRUE(recording->next());
  }
}

TEST_F(EurocRecordingTest, StaysAtItsEnd) {
  const auto recording = openRecording(root_);
  readAll(*recording);
  EXPECT_FALSE(recording->next());
  EXPECT_FALSE(recording->next());
}

TEST_F(EurocRecordingTest, FromAndToCutOutARange) {
  RecordingParams params;
  params.from_s = 0.3;
  params.to_s = 0.6;
  const auto recording = openRecording(root_, params);
  EXPECT_EQ(recording->expectedFrames(), 7u);
  const Everything part = readAll(*recording);
  std::vector<FrameWithImu> whole = readAll(root_).steps;
  ASSERT_EQ(part.steps.size(), 7u);
  const ImuBatch& lead = part.steps.front().imu;
  EXPECT_EQ(lead.back().t_ns, part.steps.front().frame.t_ns);
  EXPECT_NEAR(static_cast<double>(lead.back().t_ns - lead.front().t_ns), 5e8, 6e6);
  whole[6].imu = lead;  // otherwise the range is as in the whole
  expectSameSteps(part.steps, {whole.begin() + 6, whole.begin() + 13});
}

TEST_F(EurocRecordingTest, ARangeBehindTheEndIsAnError) {
  RecordingParams params;
  params.from_s = 100;
  EXPECT_THAT(readAll(root_, params).error, HasSubstr("no image between 100"));
  params.from_s = -1;
  EXPECT_THAT(openingError(root_, params), HasSubstr("from must be"));
  params.from_s = 2;
  params.to_s = 1;
  EXPECT_THAT(openingError(root_, params), HasSubstr("to must not be before from"));
}

TEST_F(EurocRecordingTest, NamedCameraIsRead) {
  TinyEuroc two;
  two.cameras = {"cam0", "cam1"};
  two.write(root_);
  RecordingParams params;
  params.camera = "cam1";
  const Everything other = readAll(root_, params);
  EXPECT_EQ(other.steps[0].frame.image->pixels[0], 97);
  EXPECT_EQ(readAll(root_).steps[0].frame.image->pixels[0], 0);
}

TEST_F(EurocRecordingTest, GravityIsThatOfTheParameters) {
  RecordingParams params;
  EXPECT_EQ(openRecording(root_, params)->rig().gravity_m_s2, 9.81);
  params.gravity_m_s2 = 3.71;
  EXPECT_EQ(openRecording(root_, params)->rig().gravity_m_s2, 3.71);
  params.gravity_m_s2 = 0;
  EXPECT_THROW(openRecording(root_, params), std::invalid_argument);
}

TEST_F(EurocRecordingTest, TheMaskHasTheCamerasSize) {
  const auto write = [&](const char* name, int width, int grey) {
    cv::imwrite(folder_ / name, cv::Mat(24, width, CV_8U, cv::Scalar(grey)));
    return folder_ / name;
  };
  RecordingParams params;
  params.mask = write("mask.png", 32, 255);
  ASSERT_NE(openRecording(root_, params)->rig().mask, nullptr);
  EXPECT_EQ(openRecording(root_, params)->rig().mask->pixels.size(), 32U * 24U);
  params.mask = write("wide.png", 33, 255);
  EXPECT_THAT(openingError(root_, params),
              HasSubstr("wide.png: the mask is 33x24 pixels, the camera 32x24: give a mask"));
  params.mask = write("black.png", 32, 0);
  EXPECT_THAT(openingError(root_, params), HasSubstr("black everywhere"));
  params.mask = "absent.png";
  EXPECT_THAT(openingError(root_, params), HasSubstr("absent.png: image file missing"));
}

}  // namespace
}  // namespace lintel::test
