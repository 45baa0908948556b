// SPDX-License-Identifier: BSD-3-Clause
#include "ImageCheck.h"

#include <cmath>
#include <cstdio>

namespace lintel {

namespace {

constexpr std::size_t kEvery = 97;       // pixels that are looked at: a prime, so that all columns take their turn
constexpr double kLeastContrast = 2;     // grey levels: the noise of a camera
constexpr double kTurning_rad_s = 0.05;  // one pixel in 50 ms: a camera's image changes
constexpr double kShare = 0.1;

double meanRate(const ImuBatch& imu) {
  double sum = 0;
  for (const ImuSample& sample : imu) sum += sample.gyro.norm();
  return imu.empty() ? 0 : sum / static_cast<double>(imu.size());
}

}  // namespace

void ImageCheck::add(const FrameWithImu& step) {
  const std::vector<std::uint8_t>& pixels = step.frame.image->pixels;
  sampled_.clear();
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < pixels.size(); i += kEvery) {
    const double value = pixels[i];
    sampled_.push_back(pixels[i]);
    sum += value;
    squares += value * value;
  }
  if (sampled_.empty()) return;
  const auto n = static_cast<double>(sampled_.size());
  const bool blank = squares / n - (sum / n) * (sum / n) < kLeastContrast * kLeastContrast;
  ++images_;
  blank_ += blank;
  repeated_ += !blank && sampled_ == before_ && meanRate(step.imu) > kTurning_rad_s;
  before_.swap(sampled_);
}

std::string ImageCheck::fault() const {
  char text[160];
  if (blankShare() > kShare) {
    std::snprintf(text, sizeof text, "%.0f %% of the images show nothing (dark, covered or overexposed)",
                  100 * blankShare());
    return text;
  }
  if (repeatedShare() > kShare) {
    std::snprintf(text, sizeof text,
                  "%.0f %% of the images repeat the one before although the IMU turns: the recorder lost images",
                  100 * repeatedShare());
    return text;
  }
  return {};
}

}  // namespace lintel
