// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>

#include "PlainTables.h"
#include "TinyEuroc.h"
#include "lintel/sensing/EurocToRawlog.h"
#include "lintel/sensing/RecordedSensors.h"

namespace lintel::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// The images of a small recording as numbered files, with tables beside, and what its own form gives.
class PlainRecordingTest : public testing::Test {
 protected:
  PlainRecordingTest() {
    euroc_.write(folder_ / "own");
    fs::create_directories(folder_ / "plain/images");
    for (int i = 0; i < euroc_.frames; ++i)
      fs::copy(own("cam0/data/" + std::to_string(TinyEuroc::frameStamp(i)) + ".png"),
               folder_ / ("plain/images/frame" + std::to_string(i + 1) + ".png"));
    writeTimes("plain/times.txt", false);
    writeText(folder_ / "plain/imu.csv", bytesOf(own("imu0/data.csv")));
    params_.calibration = {own("cam0/sensor.yaml"), own("imu0/sensor.yaml")};
    expected_ = readAll(folder_ / "own");
  }
  std::string own(const std::string& name) const { return folder_ / ("own/mav0/" + name); }
  void writeTimes(const std::string& name, bool seconds) const {
    std::string text;
    for (int i = 0; i < euroc_.frames; ++i) {
      std::string stamp = std::to_string(TinyEuroc::frameStamp(i));
      text += (seconds ? stamp.insert(10, ".") : stamp) + "\n";
    }
    writeText(folder_ / name, text);
  }
  /// IMU samples: `row` makes a line of a time [ns] and the signals.
  using Row = std::function<std::string(const std::string&, const Eigen::Vector3d&, const Eigen::Vector3d&)>;
  void writeImu(const std::string& name, const std::string& header, const Row& row) const {
    std::string text = header + "\n";
    for (const FrameWithImu& step : expected_.steps)
      for (const ImuSample& s : step.imu) text += row(std::to_string(s.t_ns), s.gyro, s.accel) + "\n";
    writeText(folder_ / name, text);
  }

  TempFolder folder_;
  TinyEuroc euroc_;
  RecordingParams params_;
  Everything expected_;
};

std::string numbers(const std::vector<double>& values) {
  std::ostringstream text;
  text << std::setprecision(17);
  for (const double value : values) text << "," << value;
  return text.str();
}

TEST_F(PlainRecordingTest, NumberedImagesWithATableOfTimesGiveTheSame) {
  const Everything all = readAll(folder_ / "plain", params_);
  EXPECT_EQ(all.error, "");
  expectSameSteps(all.steps, expected_.steps);  // frame2 comes before frame10
  EXPECT_EQ(openRecording(folder_ / "plain", params_)->expectedFrames(), 20U);
  EXPECT_EQ(openRecording(folder_ / "plain", params_)->rig().camera_rate_hz, 20);
  const auto sensors = recordedSensors(folder_ / "plain", params_);
  ASSERT_EQ(sensors.size(), 2U);
  EXPECT_EQ(sensors[0].label, "times.txt");
  EXPECT_EQ(sensors[0].count, 20U);
  EXPECT_EQ(sensors[1].rate_hz, 200);
}

TEST_F(PlainRecordingTest, TimesInSecondsKeepTheirNanoseconds) {
  writeTimes("seconds.txt", true);
  params_.times_file = folder_ / "seconds.txt";
  expectSameSteps(readAll(folder_ / "plain", params_).steps, expected_.steps);
}

TEST_F(PlainRecordingTest, ColumnsAreFoundByTheirNamesAndUnits) {
  writeImu("imu.csv",
           "acc_x [g],acc_y [g],acc_z [g],temperature,gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s],time [us]",
           [](const std::string& t, const Eigen::Vector3d& w, const Eigen::Vector3d& a) {
             const double degrees = 180 / 3.14159265358979323846, g = 1 / 9.80665;
             return numbers({a.x() * g, a.y() * g, a.z() * g, 20, w.x() * degrees, w.y() * degrees, w.z() * degrees})
                        .substr(1) +
                    "," + std::string(t).insert(t.size() - 3, ".");
           });
  params_.imu_file = folder_ / "imu.csv";
  const Everything all = readAll(folder_ / "plain", params_);
  ASSERT_EQ(all.error, "");
  ASSERT_EQ(all.steps.size(), 20U);
  for (std::size_t i = 1; i < all.steps.size(); ++i) {
    EXPECT_TRUE(all.steps[i].imu.back().gyro.isApprox(expected_.steps[i].imu.back().gyro, 1e-9)) << i;
    EXPECT_TRUE(all.steps[i].imu.back().accel.isApprox(expected_.steps[i].imu.back().accel, 1e-9)) << i;
  }
}

TEST_F(PlainRecordingTest, GyroscopeAndAccelerometerMayBeTwoFiles) {
  writeImu("gyro.txt", "# t gx gy gz", [](const std::string& t, const Eigen::Vector3d& w, const Eigen::Vector3d&) {
    return t + numbers({w.x(), w.y(), w.z()});
  });
  writeImu("accel.txt", "# t ax ay az", [](const std::string& t, const Eigen::Vector3d&, const Eigen::Vector3d& a) {
    return t + numbers({a.x(), a.y(), a.z()});
  });
  params_.imu_file = folder_ / "gyro.txt" + "," + folder_ / "accel.txt";
  const Everything all = readAll(folder_ / "plain", params_);
  ASSERT_EQ(all.steps.size(), 20U);
  for (std::size_t i = 2; i < all.steps.size(); ++i)
    EXPECT_TRUE(all.steps[i].imu.back().accel.isApprox(expected_.steps[i].imu.back().accel, 1e-6)) << i;
}

TEST_F(PlainRecordingTest, AFilmWithTables) {
  cv::VideoWriter film(folder_ / "walk.avi", cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 20, {32, 24}, true);
  ASSERT_TRUE(film.isOpened());
  for (int i = 0; i < euroc_.frames; ++i)
    film.write(cv::imread(folder_ / ("plain/images/frame" + std::to_string(i + 1) + ".png")));
  film.release();
  writeTimes("walk_times.csv", false);
  writeText(folder_ / "walk_imu.csv", bytesOf(own("imu0/data.csv")));
  const Everything all = readAll(folder_ / "walk.avi", params_);
  EXPECT_EQ(all.error, "");
  ASSERT_EQ(all.steps.size(), 20U);
  for (std::size_t i = 0; i < all.steps.size(); ++i) {
    EXPECT_EQ(all.steps[i].frame.t_ns, expected_.steps[i].frame.t_ns);
    for (const std::size_t k : {0U, 100U, 700U})
      EXPECT_NEAR(all.steps[i].frame.image->pixels[k], expected_.steps[i].frame.image->pixels[k], 8) << i;
  }
  params_.from_s = 0.5;  // pictures before are not decoded
  const Everything part = readAll(folder_ / "walk.avi", params_);
  ASSERT_EQ(part.steps.size(), 10U);
  EXPECT_EQ(part.steps[0].frame.image->pixels, all.steps[10].frame.image->pixels);

  params_.from_s = 0;
  writeText(folder_ / "walk_times.csv", bytesOf(folder_ / "walk_times.csv") + "1403636599763555584\n");
  EXPECT_THAT(readAll(folder_ / "walk.avi", params_).warnings,
              testing::Contains(HasSubstr("picture 21 is missing (the film is shorter")));
}

TEST_F(PlainRecordingTest, ImagesOfOtherForms) {
  const cv::Mat grey = cv::imread(folder_ / "plain/images/frame1.png", cv::IMREAD_GRAYSCALE);
  cv::Mat deep, colour;
  grey.convertTo(deep, CV_16U, 256, 77);
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  const auto first = [&](const std::string& name, const cv::Mat& image) {
    fs::remove_all(folder_ / "forms");
    fs::create_directories(folder_ / "forms");
    cv::imwrite(folder_ / ("forms/" + name), image);
    writeText(folder_ / "one.txt", std::to_string(TinyEuroc::frameStamp(0)) + " " + name + "\n");
    params_.times_file = folder_ / "one.txt";
    params_.imu_file = own("imu0/data.csv");
    const Everything all = readAll(folder_ / "forms", params_);
    EXPECT_EQ(all.steps.size(), 1U) << name << all.error;
    return all.steps.empty() ? std::vector<std::uint8_t>() : all.steps[0].frame.image->pixels;
  };
  const auto& same = expected_.steps[0].frame.image->pixels;
  EXPECT_EQ(first("deep.png", deep), same);
  EXPECT_EQ(first("colour.png", colour), same);
  EXPECT_EQ(first("grey.pgm", grey), same);
  const auto jpeg = first("lossy.jpg", grey);
  ASSERT_EQ(jpeg.size(), same.size());
}

/// EuRoC's form with the calibration as TUM-VI publishes it.
TEST_F(PlainRecordingTest, FoldersOfTumViBringTheirCalibration) {
  fs::create_directories(folder_ / "own/dso");
  writeText(folder_ / "own/dso/camchain.yaml",
            "cam0:\n  T_cam_imu:\n  - [1, 0, 0, 0]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n"
            "  camera_model: pinhole\n  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]\n"
            "  distortion_model: equidistant\n  intrinsics: [12, 12, 15.5, 11.5]\n  resolution: [32, 24]\n");
  writeText(folder_ / "own/dso/imu_config.yaml",
            "accelerometer_noise_density: 0.0014\naccelerometer_random_walk: 0.000086\ngyroscope_noise_density: "
            "0.00008\ngyroscope_random_walk: 0.0000022\nupdate_rate: 200.0\n");
  fs::remove(own("cam0/sensor.yaml"));
  fs::remove(own("imu0/sensor.yaml"));
  EXPECT_EQ(openRecording(folder_ / "own")->rig().camera.model, LensModel::kEquidistant);
  EXPECT_EQ(openRecording(folder_ / "own")->rig().imu_noise.accel_noise, 0.0014);
  expectSameSteps(readAll(folder_ / "own").steps, expected_.steps);
}

TEST_F(PlainRecordingTest, BecomesARawlogThatGivesTheSame) {
  EurocToRawlogParams conversion;
  conversion.recording = params_;
  for (const bool embed : {false, true}) {
    const std::string rawlog = folder_ / (embed ? "embedded.rawlog" : "files.rawlog");
    conversion.embed = embed;
    EXPECT_EQ(eurocToRawlog(folder_ / "plain", rawlog, conversion).images.at("cam0"), 20U);
    expectSameSteps(readAll(rawlog).steps, expected_.steps);
    expectSameRig(openRecording(rawlog)->rig(), openRecording(folder_ / "plain", params_)->rig());
  }
  EXPECT_THROW(eurocToRawlog(folder_ / "files.rawlog", folder_ / "again.rawlog", conversion), RecordingError);
}

TEST_F(PlainRecordingTest, WhatIsMissingIsNamed) {
  EXPECT_THAT(openingError(folder_ / "plain"), HasSubstr("give it by --calibration"));
  writeText(folder_ / "plain/times.txt", "1403636579763555584\n");
  EXPECT_THAT(openingError(folder_ / "plain", params_),
              AllOf(HasSubstr("times.txt: has 1 times for 20 images"), HasSubstr("write a time and a file's name")));
  fs::remove(folder_ / "plain/times.txt");
  EXPECT_THAT(openingError(folder_ / "plain", params_),
              AllOf(HasSubstr("the images' times are missing"), HasSubstr("--times FILE")));
  writeText(folder_ / "times", "12 a.png\nsoon b.png\n");
  params_.times_file = folder_ / "times";
  EXPECT_THAT(openingError(folder_ / "plain", params_), HasSubstr("times:2"));
  writeText(folder_ / "no.mp4", "no film");
  writeTimes("times", false);
  params_.imu_file = own("imu0/data.csv");
  EXPECT_THAT(openingError(folder_ / "no.mp4", params_), HasSubstr("no.mp4: no video that can be read"));
  writeText(folder_ / "bad.csv", "t,gx,gy,gz,ax,ay\n1,2,3,4,5,6\n");
  params_.imu_file = folder_ / "bad.csv";
  EXPECT_THAT(openingError(folder_ / "plain", params_), HasSubstr("names 5 of 6 values"));
}

TEST(PlainTables, TimesOfEveryUnit) {
  EXPECT_EQ(parseTime_ns("1403636579763555584", TimeUnit::kUnknown), 1403636579763555584);
  EXPECT_EQ(parseTime_ns("1403636579763555", TimeUnit::kUnknown), 1403636579763555000);
  EXPECT_EQ(parseTime_ns("1403636579763", TimeUnit::kUnknown), 1403636579763000000);
  EXPECT_EQ(parseTime_ns("1403636579.763555584", TimeUnit::kUnknown), 1403636579763555584);
  EXPECT_EQ(parseTime_ns("0.05", TimeUnit::kUnknown), 50000000);
  EXPECT_EQ(parseTime_ns("50", timeUnitOf("time (ms)")), 50000000);
  EXPECT_EQ(parseTime_ns("7", timeUnitOf("timestamp_ns")), 7);
  EXPECT_EQ(parseTime_ns("12a", TimeUnit::kUnknown), std::nullopt);
  EXPECT_EQ(parseTime_ns("-1", TimeUnit::kUnknown), std::nullopt);
}

}  // namespace
}  // namespace lintel::test
