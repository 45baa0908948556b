// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "TinyEuroc.h"

namespace lintel::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class EurocFaultsTest : public testing::Test {
 protected:
  EurocFaultsTest() { TinyEuroc().write(root_); }
  std::string imagePath(int frame) const {
    return camera_ + "/data/" + std::to_string(TinyEuroc::frameStamp(frame)) + ".png";
  }
  /// The line of imu0/data.csv that begins at or after a part of the file's length.
  std::string imuLine(double part) const {
    const std::string text = bytesOf(imu_ + "/data.csv");
    const std::size_t begin = text.find('\n', static_cast<std::size_t>(part * static_cast<double>(text.size()))) + 1;
    return text.substr(begin, text.find('\n', begin) + 1 - begin);
  }

  void cutImu(const std::string& from, const std::string& to) {
    const std::string text = bytesOf(imu_ + "/data.csv");
    writeText(imu_ + "/data.csv", text.substr(0, text.find(from)) + text.substr(text.find(to)));
  }

  TempFolder folder_;
  std::string root_ = folder_ / "flight", camera_ = root_ + "/mav0/cam0", imu_ = root_ + "/mav0/imu0";
};

TEST_F(EurocFaultsTest, MissingParts) {
  EXPECT_THAT(openingError(folder_ / "nothing"), HasSubstr("does not exist"));
  EXPECT_THAT(openingError(folder_.path().string()), HasSubstr("neither it nor its mav0 holds cam0 and imu0"));
  std::filesystem::remove(imu_ + "/sensor.yaml");
  EXPECT_THAT(openingError(root_), HasSubstr("imu0/sensor.yaml: missing"));
  TinyEuroc().write(root_);
  std::filesystem::remove(camera_ + "/data.csv");
  EXPECT_THAT(openingError(root_), HasSubstr("cam0/data.csv: cannot be opened"));
  std::filesystem::remove_all(imu_);
  EXPECT_THAT(openingError(root_), HasSubstr("imu0/sensor.yaml: missing"));
}

struct YamlFault {
  const char *sensor, *from, *to, *message;
};

class SensorYamlTest : public EurocFaultsTest, public testing::WithParamInterface<YamlFault> {};

TEST_P(SensorYamlTest, IsRefusedByName) {
  const YamlFault& fault = GetParam();
  const std::string file = root_ + "/mav0/" + fault.sensor + "/sensor.yaml";
  replaceInFile(file, fault.from, fault.to);
  EXPECT_THAT(openingError(root_), AllOf(HasSubstr(file), HasSubstr(fault.message)));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, SensorYamlTest,
    testing::Values(YamlFault{"cam0", "intrinsics", "intrinsic", "intrinsics is missing"},
                    YamlFault{"cam0", "T_BS", "T_SB", "T_BS is missing"},
                    YamlFault{"cam0", "rate_hz: 20", "rate_hz: fast", "rate_hz is not of the expected type"},
                    YamlFault{"cam0", "rate_hz: 20", "rate_hz: -20", "rate_hz must be a number greater than 0"},
                    YamlFault{"cam0", "pinhole", "omni", "camera_model 'omni' is not supported"},
                    YamlFault{"cam0", "radial-tangential", "fov", "distortion_model 'fov' is not supported"},
                    YamlFault{"cam0", "radial-tangential", "rational", "has 4 values, expected 8"},
                    YamlFault{"cam0", "[-0.28340811, 0.07395907, ", "[", "has 2 values, expected 4 or 5"},
                    YamlFault{"cam0", "[31.654,", "[-31.654,", "focal lengths must be greater than 0"},
                    YamlFault{"cam0", "[31.654,", "[.nan,", "not finite"},
                    YamlFault{"cam0", "[32, 24]", "[32.5, 24]", "resolution"},
                    YamlFault{"cam0", "0.999557249008", "0.9", "is no rotation"},
                    YamlFault{"cam0", "0.999557249008", ".inf", "not finite"},
                    YamlFault{"cam0", "0.0, 0.0, 0.0, 1.0]", "0.0, 0.0, 0.0, 2.0]", "last row"},
                    YamlFault{"cam0", "0.0, 0.0, 0.0, 1.0]", "0.0]", "needs 16 values"},
                    YamlFault{"cam0", "rate_hz: 20", "rate_hz: [20", "not valid YAML"},
                    YamlFault{"imu0", "gyroscope_random_walk", "walk", "gyroscope_random_walk is missing"},
                    YamlFault{"imu0", "2.3e-3", "0", "accelerometer_noise_density must be a number greater than 0"}));

TEST_F(EurocFaultsTest, EmptyLists) {
  writeText(camera_ + "/data.csv", "#timestamp [ns],filename\n");
  EXPECT_THAT(openingError(root_), HasSubstr("lists no images"));
  TinyEuroc().write(root_);
  writeText(imu_ + "/data.csv", "");
  EXPECT_THAT(openingError(root_), HasSubstr("holds no samples"));
}

TEST_F(EurocFaultsTest, NoOverlapInTime) {
  writeText(imu_ + "/data.csv", "1000,0,0,0,0,0,9.8\n2000,0,0,0,0,0,9.8\n");
  EXPECT_THAT(openingError(root_), HasSubstr("do not overlap in time"));
  writeText(imu_ + "/data.csv", "1503636579763555584,0,0,0,0,0,9.8\n");
  const Everything all = readAll(root_);
  EXPECT_THAT(all.error, HasSubstr("do not overlap in time"));
  EXPECT_EQ(all.steps.size(), 20u);
}

TEST_F(EurocFaultsTest, MissingAndCutImagesAreSkippedAndTheirImuKept) {
  std::filesystem::remove(imagePath(5));
  std::filesystem::resize_file(imagePath(9), std::filesystem::file_size(imagePath(9)) - 1);
  writeText(imagePath(11), "");
  const Everything all = readAll(root_);
  ASSERT_EQ(all.steps.size(), 17u);
  EXPECT_THAT(all.warnings, ElementsAre(AllOf(HasSubstr(imagePath(5)), HasSubstr("missing")),
                                        AllOf(HasSubstr(imagePath(9)), HasSubstr("not a complete image")),
                                        AllOf(HasSubstr(imagePath(11)), HasSubstr("not a complete image"))));
  EXPECT_EQ(all.steps[5].imu.front().t_ns, all.steps[4].frame.t_ns);
  EXPECT_EQ(all.steps[5].imu.size(), 22u);
}

TEST_F(EurocFaultsTest, ImagesOfAnotherSizeAreRefused) {
  replaceInFile(camera_ + "/sensor.yaml", "[32, 24]", "[64, 48]");
  const Everything all = readAll(root_);
  EXPECT_THAT(all.error, AllOf(HasSubstr("none of 20 images can be used"), HasSubstr("32x24")));
}

TEST_F(EurocFaultsTest, MalformedLinesAreNamed) {
  const std::string line = imuLine(0.5);
  replaceInFile(imu_ + "/data.csv", line, "1403636580,1,2\n");
  const std::string error = readAll(root_).error;
  EXPECT_THAT(error, AllOf(HasSubstr("imu0/data.csv:"), HasSubstr("3 fields, expected 7")));
  TinyEuroc().write(root_);
  replaceInFile(imu_ + "/data.csv", line, "x" + line);
  EXPECT_THAT(readAll(root_).error, HasSubstr("is no time in nanoseconds"));
  TinyEuroc().write(root_);
  replaceInFile(imu_ + "/data.csv", line, line.substr(0, line.size() - 1) + "?\n");
  EXPECT_THAT(readAll(root_).error, HasSubstr("is no number"));
}

TEST_F(EurocFaultsTest, ACutLastLineIsSkipped) {
  for (const std::string& file : {camera_ + "/data.csv", imu_ + "/data.csv"}) {
    const std::string text = bytesOf(file);
    writeText(file, text + "1403636599");
    const Everything all = readAll(root_);
    EXPECT_EQ(all.error, "");
    EXPECT_EQ(all.steps.size(), 20u);
    writeText(file, text);
  }
  std::string text = bytesOf(camera_ + "/data.csv");
  writeText(camera_ + "/data.csv", text.substr(0, text.size() - 30));
  EXPECT_THAT(readAll(root_).warnings, ElementsAre(AllOf(HasSubstr("data.csv:21"), HasSubstr("last line incomplete"))));
}

TEST_F(EurocFaultsTest, DuplicatedAndReorderedSamplesAreSkipped) {
  const std::vector<FrameWithImu> whole = readAll(root_).steps;
  const std::string late = imuLine(0.5), twice = imuLine(0.7);
  replaceInFile(imu_ + "/data.csv", twice, twice + twice + late);
  replaceInFile(camera_ + "/data.csv", "\r\n", "\r\n1,old.png\r\n");
  const Everything all = readAll(root_);
  expectSameSteps(all.steps, whole);
  EXPECT_THAT(all.warnings,
              ElementsAre(AllOf(HasSubstr("data.csv:3: image"), HasSubstr("older")),
                          HasSubstr("same time as the one before"), HasSubstr("older than the one before")));
}

TEST_F(EurocFaultsTest, TwoSamplesAtOneTimeAreOne) {
  const std::vector<FrameWithImu> whole = readAll(root_).steps;
  const std::string line = imuLine(0.5);
  replaceInFile(imu_ + "/data.csv", line, line + line.substr(0, line.find(',')) + ",0,0,0,0,0,9.8\n");
  const Everything all = readAll(root_);
  expectSameSteps(all.steps, whole);
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("same time as the one before: skipped")));
}

TEST_F(EurocFaultsTest, NonFiniteSamplesAreSkipped) {
  const std::string line = imuLine(0.5);
  replaceInFile(imu_ + "/data.csv", line, line.substr(0, line.find(',')) + ",nan,0,0,0,inf,0\n");
  const Everything all = readAll(root_);
  EXPECT_EQ(all.steps.size(), 20u);
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("is not finite: skipped")));
  for (const FrameWithImu& step : all.steps)
    for (const ImuSample& sample : step.imu) EXPECT_TRUE(sample.gyro.allFinite() && sample.accel.allFinite());
}

TEST_F(EurocFaultsTest, AShortDropOutIsBridged) {
  const std::string from = imuLine(0.5), to = imuLine(0.7);
  cutImu(from, to);
  const Everything all = readAll(root_);
  ASSERT_EQ(all.steps.size(), 20u);
  for (std::size_t i = 1; i < all.steps.size(); ++i) {
    const auto& imu = all.steps[i].imu;
    ASSERT_FALSE(imu.empty()) << i;
    const bool inside = all.steps[i].frame.t_ns > std::stoll(from) && all.steps[i].frame.t_ns < std::stoll(to);
    EXPECT_EQ(imu.back().bridged, inside) << i;
  }
  EXPECT_THAT(all.warnings, ElementsAre(HasSubstr("the IMU has a drop-out")));
}

TEST_F(EurocFaultsTest, ALongDropOutLeavesBatchesEmpty) {
  const std::string from = imuLine(0.2), to = imuLine(0.8);
  cutImu(from, to);
  const Everything all = readAll(root_);
  ASSERT_EQ(all.steps.size(), 20u);
  const std::int64_t lost_from = std::stoll(from), lost_to = std::stoll(to);
  int empty = 0;
  for (std::size_t i = 1; i < all.steps.size(); ++i) {
    const bool touched = all.steps[i].frame.t_ns > lost_from - 5000000 && all.steps[i - 1].frame.t_ns < lost_to;
    EXPECT_EQ(all.steps[i].imu.empty(), touched) << i;
    empty += all.steps[i].imu.empty();
  }
  EXPECT_GE(empty, 5);
  EXPECT_THAT(all.warnings, Contains(HasSubstr("the IMU does not cover")));
  EXPECT_THAT(all.warnings, Contains(HasSubstr("more frames without IMU")));
}

}  // namespace
}  // namespace lintel::test
