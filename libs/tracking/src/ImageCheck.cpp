// SPDX-License-Identifier: BSD-3-Clause
#include "ImageCheck.h"

#include <opencv2/core.hpp>

#include "PatchFlow.h"

namespace lintel {
namespace {

constexpr double kWaits_s = 0.5;           ///< after that an image without contrast is what there is to be seen
constexpr double kNoise = 2;               ///< contrast of an image of nothing [grey levels]
constexpr double kTurned_px = 1;           ///< three times the error of optical flow
constexpr double kGyroError_rad_s = 0.01;  ///< of what the gyroscope says beyond the known bias

/// Standard deviation of the grey levels.
double contrastOf(const GrayImage& image) {
  const cv::Mat pixels(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Scalar mean, deviation;
  cv::meanStdDev(pixels, mean, deviation);
  return deviation[0];
}

}  // namespace

ImageWorth ImageCheck::check(const Frame& frame, const ImuBatch& imu_since_last, const Eigen::Vector3d& gyro_bias) {
  if (repeats(frame, imu_since_last, gyro_bias)) return ImageWorth::kRepeats;
  return contrastWorth(frame);
}

ImageWorth ImageCheck::contrastWorth(const Frame& frame) {
  const double contrast = contrastOf(*frame.image);
  const bool waits = 1e-9 * static_cast<double>(frame.t_ns - shown_ns_) < kWaits_s;
  if (contrast < kLeastContrast * contrast_ && waits) return ImageWorth::kShowsNothing;
  contrast_ = contrast;
  shown_ns_ = frame.t_ns;
  return contrast < kNoise ? ImageWorth::kStaysDark : ImageWorth::kGood;
}

bool ImageCheck::repeats(const Frame& frame, const ImuBatch& imu, const Eigen::Vector3d& gyro_bias) {
  const bool same = last_ && frame.image->pixels == last_->pixels;
  last_ = frame.image;
  if (!same) {
    turned_rad_.setZero();
    same_s_ = 0;
    return false;
  }
  for (std::size_t i = 1; i < imu.size(); ++i) {
    const double step_s = 1e-9 * static_cast<double>(imu[i].t_ns - imu[i - 1].t_ns);
    turned_rad_ += (0.5 * (imu[i].gyro + imu[i - 1].gyro) - gyro_bias) * step_s;
    same_s_ += step_s;
  }
  return focal_px_ * (turned_rad_.norm() - kGyroError_rad_s * same_s_) > kTurned_px;
}

}  // namespace lintel
