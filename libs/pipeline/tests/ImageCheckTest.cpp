// SPDX-License-Identifier: BSD-3-Clause
#include "ImageCheck.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace lintel {
namespace {

enum class Image { kGood, kBlack, kRepeated };

/// A hundred frames of a camera that turns at `rate`.
ImageCheck checkOf(const std::function<Image(int)>& kind, double rate = 0.5) {
  ImageCheck check;
  int shown = 0;
  for (int frame = 0; frame < 100; ++frame) {
    auto image = std::make_shared<GrayImage>(GrayImage{100, 80, std::vector<std::uint8_t>(8000)});
    if (kind(frame) == Image::kGood) shown = frame;
    for (std::size_t i = 0; i < 8000 && kind(frame) != Image::kBlack; ++i)
      image->pixels[i] = static_cast<std::uint8_t>((i * 31 + static_cast<std::size_t>(shown) * 7) % 200);
    FrameWithImu step;
    step.frame.image = image;
    for (int i = 0; i < 3; ++i) step.imu.push_back({5'000'000LL * i, {rate, 0, 0}, {0, 0, 9.81}});
    check.add(step);
  }
  return check;
}

TEST(ImageCheck, GoodImagesHaveNoFault) {
  const ImageCheck check = checkOf([](int) { return Image::kGood; });
  EXPECT_EQ(check.blankShare(), 0);
  EXPECT_EQ(check.repeatedShare(), 0);
  EXPECT_EQ(check.fault(), "");
}

TEST(ImageCheck, DarkImagesAreCounted) {
  const ImageCheck check = checkOf([](int i) { return i % 4 == 0 ? Image::kBlack : Image::kGood; });
  EXPECT_DOUBLE_EQ(check.blankShare(), 0.25);
  EXPECT_NE(check.fault().find("25 %"), std::string::npos) << check.fault();
}

TEST(ImageCheck, RepeatedImagesAreCountedWhileTheImuTurns) {
  const auto every_other = [](int i) { return i % 2 == 0 ? Image::kGood : Image::kRepeated; };
  EXPECT_DOUBLE_EQ(checkOf(every_other).repeatedShare(), 0.5);
  EXPECT_NE(checkOf(every_other).fault().find("repeat"), std::string::npos);
  EXPECT_EQ(checkOf(every_other, 0).fault(), "") << "at rest, images may be the same";
}

TEST(ImageCheck, ALostImageIsNoFault) {
  EXPECT_EQ(checkOf([](int i) { return i % 20 == 0 ? Image::kBlack : Image::kGood; }).fault(), "");
}

}  // namespace
}  // namespace lintel
