// SPDX-License-Identifier: BSD-3-Clause
#include "../src/ImageCheck.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

constexpr double kRate_hz = 20;

Camera camera() {
  Camera camera;
  camera.width = 64, camera.height = 48;
  camera.fx = camera.fy = 400;
  camera.cx = 32, camera.cy = 24;
  return camera;
}

/// Stripes between `dark` and `bright`, different from number to number.
std::shared_ptr<const GrayImage> stripes(int number, int dark, int bright) {
  auto image = std::make_shared<GrayImage>();
  image->width = 64, image->height = 48;
  for (int y = 0; y < image->height; ++y)
    for (int x = 0; x < image->width; ++x)
      image->pixels.push_back(static_cast<std::uint8_t>((x + number) / 8 % 2 == 0 ? dark : bright));
  return image;
}

/// Shows images at 20 Hz to a check while the camera turns.
class Show {
 public:
  explicit Show(double rate_rad_s) : rate_rad_s_(rate_rad_s), check_(camera()) {}

  ImageWorth operator()(const std::shared_ptr<const GrayImage>& image) {
    const std::int64_t before_ns = t_ns_;
    t_ns_ += static_cast<std::int64_t>(1e9 / kRate_hz);
    ImuBatch imu;
    for (const std::int64_t t_ns : {before_ns, t_ns_}) {
      ImuSample sample;
      sample.t_ns = t_ns;
      sample.gyro = {0, rate_rad_s_, 0};
      imu.push_back(sample);
    }
    return check_.check({t_ns_, image}, imu, Eigen::Vector3d::Zero());
  }

 private:
  double rate_rad_s_;
  ImageCheck check_;
  std::int64_t t_ns_ = 0;
};

TEST(ImageCheck, blackAndWhiteImagesShowNothing) {
  Show show(0.1);
  EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kGood);
  EXPECT_EQ(show(stripes(1, 0, 1)), ImageWorth::kShowsNothing);
  EXPECT_EQ(show(stripes(2, 255, 255)), ImageWorth::kShowsNothing);
  EXPECT_EQ(show(stripes(3, 80, 120)), ImageWorth::kGood);
}

TEST(ImageCheck, aDimmerImageIsGood) {
  Show show(0.1);
  EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kGood);
  EXPECT_EQ(show(stripes(1, 20, 30)), ImageWorth::kGood);
}

TEST(ImageCheck, whatStaysDarkForHalfASecondIsTheScene) {
  Show show(0.1);
  show(stripes(0, 80, 120));
  int left_out = 0;
  ImageWorth last = ImageWorth::kGood;
  for (int i = 1; i < 20; ++i) {
    last = show(stripes(i, 10, 12));
    left_out += last == ImageWorth::kShowsNothing;
  }
  EXPECT_EQ(left_out, static_cast<int>(0.5 * kRate_hz) - 1);
  EXPECT_EQ(last, ImageWorth::kStaysDark);
}

TEST(ImageCheck, aRecordingMayBeginInTheDark) {
  Show show(0.1);
  EXPECT_EQ(show(stripes(0, 0, 0)), ImageWorth::kStaysDark);
  EXPECT_EQ(show(stripes(1, 80, 120)), ImageWorth::kGood);
}

TEST(ImageCheck, theSameImageWhileTheCameraTurnsIsARepetition) {
  Show show(0.2);  // 4 px from image to image
  EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kGood);
  EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kRepeats);
  EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kRepeats);
  EXPECT_EQ(show(stripes(1, 80, 120)), ImageWorth::kGood);
}

TEST(ImageCheck, aCameraThatHangsIsFoundInASlowTurn) {
  Show show(0.03);  // 0.6 px from image to image
  show(stripes(0, 80, 120));
  ImageWorth last = ImageWorth::kGood;
  for (int i = 0; i < 6; ++i) last = show(stripes(0, 80, 120));
  EXPECT_EQ(last, ImageWorth::kRepeats);
}

TEST(ImageCheck, theSameImageAtRestIsGood) {
  Show show(0.005);  // the gyroscope's bias
  for (int i = 0; i < 200; ++i) EXPECT_EQ(show(stripes(0, 80, 120)), ImageWorth::kGood);
}

}  // namespace
}  // namespace lintel
