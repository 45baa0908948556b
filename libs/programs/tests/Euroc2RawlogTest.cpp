// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/Euroc2Rawlog.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

/// A folder with an EuRoC recording whose images are never opened, since they are only linked.
class Euroc2RawlogTest : public testing::Test {
 protected:
  Euroc2RawlogTest() {
    const std::string pose =
        "T_BS: {cols: 4, rows: 4, data: [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0]}\n";
    folder_.write("in/mav0/cam0/sensor.yaml", pose +
                                                  "rate_hz: 20\nresolution: [32, 24]\ncamera_model: pinhole\n"
                                                  "intrinsics: [30, 30, 16, 12]\ndistortion_model: radial-tangential\n"
                                                  "distortion_coefficients: [0, 0, 0, 0]\n");
    folder_.write("in/mav0/cam0/data.csv", "#t,file\n1000000000,a.png\n1050000000,b.png\n");
    folder_.write("in/mav0/cam0/data/a.png", "a");
    folder_.write("in/mav0/cam0/data/b.png", "b");
    folder_.write("in/mav0/imu0/sensor.yaml",
                  pose +
                      "rate_hz: 200\ngyroscope_noise_density: 1e-4\ngyroscope_random_walk: 1e-5\n"
                      "accelerometer_noise_density: 1e-3\naccelerometer_random_walk: 1e-3\n");
    folder_.write("in/mav0/imu0/data.csv", "1000000000,0,0,0,0,0,9.8\n1055000000,0,0,0,0,0,9.8\n");
  }
  int run(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv = {"euroc2rawlog"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    out_.str("");
    err_.str("");
    return runEuroc2Rawlog(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  std::string in() const { return folder_ / "in"; }
  std::string rawlog() const { return folder_ / "out.rawlog"; }

  test::TempFolder folder_;
  std::ostringstream out_, err_;
};

TEST_F(Euroc2RawlogTest, WritesARawlogAndSaysWhat) {
  EXPECT_EQ(run({"-i", in(), "-o", rawlog()}), 0);
  EXPECT_TRUE(fs::exists(rawlog()));
  EXPECT_TRUE(fs::exists(folder_ / "out_Images/cam0_b.png"));
  EXPECT_THAT(out_.str(), HasSubstr("out.rawlog: 0.06 s, 2 images cam0, 2 samples imu0\n"));
  EXPECT_THAT(out_.str(), HasSubstr("out_Images: 2 images linked, 0 copied\n"));
  EXPECT_EQ(err_.str(), "");
}

TEST_F(Euroc2RawlogTest, QuietSaysNothing) {
  EXPECT_EQ(run({"-q", "-i", in() + "/mav0", "-o", rawlog(), "-z", "0", "--cameras", "cam0", "--copy"}), 0);
  EXPECT_EQ(out_.str() + err_.str(), "");
  EXPECT_EQ(fs::hard_link_count(folder_ / "out_Images/cam0_b.png"), 1u);
}

TEST_F(Euroc2RawlogTest, OverwritesOnlyWhenAsked) {
  EXPECT_EQ(run({"-i", in(), "-o", rawlog()}), 0);
  EXPECT_EQ(run({"-i", in(), "-o", rawlog()}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("exists already"));
  EXPECT_EQ(run({"-w", "-i", in(), "-o", rawlog()}), 0);
}

TEST_F(Euroc2RawlogTest, BadInputIsOneLine) {
  EXPECT_EQ(run({"-i", in() + "/nowhere", "-o", rawlog()}), 1);
  EXPECT_THAT(err_.str(), StartsWith("euroc2rawlog: " + in() + "/nowhere: no such folder"));
  EXPECT_EQ(err_.str().find('\n'), err_.str().size() - 1);
  EXPECT_EQ(run({"-i", in(), "-o", rawlog(), "--cameras", "cam0,cam1"}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("mav0/cam1: no such camera"));
  EXPECT_EQ(run({"-i", in(), "-o", rawlog(), "--embed"}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("cam0: no image could be read"));
  EXPECT_FALSE(fs::exists(rawlog()));
}

TEST_F(Euroc2RawlogTest, WrongCommandLinesAreUsage) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"-i", in()}), 2);
  EXPECT_EQ(run({"-i", in(), "-o", rawlog(), "-z", "11"}), 2);
  EXPECT_EQ(run({"-i", in(), "-o", rawlog(), "--embed", "--copy"}), 2);
  EXPECT_EQ(run({"-i", in(), "-o", "out.bag"}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("--compress-level"));
  EXPECT_EQ(run({"--version"}), 0);
}

TEST_F(Euroc2RawlogTest, WarnsOfWhatIsLeftOut) {
  fs::remove(folder_ / "in/mav0/cam0/data/a.png");
  EXPECT_EQ(run({"-q", "-i", in(), "-o", rawlog()}), 0);
  EXPECT_THAT(err_.str(), HasSubstr("euroc2rawlog: warning: "));
  EXPECT_THAT(err_.str(), HasSubstr("a.png: image file missing: left out"));
}

}  // namespace
}  // namespace lintel
