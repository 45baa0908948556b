// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeAppearance.h"

#include <algorithm>
#include <cmath>

#include "GreyLevels.h"

namespace lintel {

void gradientsAcross(const cv::Mat& image, const Eigen::Vector2d& centre, const Eigen::Vector2d& step, double stride,
                     int reach, GradientProfile& profile) {
  constexpr int kBeyond = 64;  // more than a profile near the border reaches out of the image
  std::array<float, std::size_t{2} * (2 * kMaxReach + 5)> x, y, grey;
  const std::size_t places = 2 * static_cast<std::size_t>(reach) + 5;
  const Eigen::Vector2f s = step.cast<float>();
  const Eigen::Vector2f beside = Eigen::Vector2f(-s.y(), s.x()) * static_cast<float>(0.5 / stride);
  const Eigen::Vector2f first = centre.cast<float>() - static_cast<float>(reach + 2) * s;
  for (std::size_t i = 0; i < places; ++i) {
    const auto f = static_cast<float>(i);
    x[i] = first.x() + f * s.x() - beside.x(), y[i] = first.y() + f * s.y() - beside.y();
    x[i + places] = first.x() + f * s.x() + beside.x(), y[i + places] = first.y() + f * s.y() + beside.y();
  }
  greyLevels<kBeyond>(image, 2 * places, x, y, grey.data());
  const auto scale = static_cast<float>(8 / stride);  // 32, of two places, over two steps
  for (std::size_t i = 0; i + 2 < places; ++i)
    profile[i] = scale * (grey[i + 2] + grey[i + 2 + places] - grey[i] - grey[i + places]);
}

std::optional<SideLevels> sideLevels(const LineCamera& camera, const cv::Mat& image, const ImageLine& line) {
  constexpr int kSamples = 12;      // along the line: the mean of noise of 5 grey levels is good to 1.5
  constexpr double kBeside_px = 3;  // beyond the blur of the edge itself
  SideLevels sides;
  int samples = 0;
  const Eigen::Vector2d n = line.normal();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d u = line.at((i + 0.5) / kSamples);
    const auto px = camera.seenAt(u, line.axis);
    if (!px || !camera.uses(*px, kBeside_px + 2)) continue;
    const Eigen::Vector2d step = kBeside_px * (camera.imageJacobian(u, line.axis) * n).normalized();
    const auto grey = [&](const Eigen::Vector2d& at) {
      return static_cast<float>(image.at<unsigned char>(cvRound(at.y()), cvRound(at.x())));
    };
    sides.dark += grey(*px - step), sides.bright += grey(*px + step);
    ++samples;
  }
  if (2 * samples < kSamples) return std::nullopt;
  sides.dark /= static_cast<float>(samples), sides.bright /= static_cast<float>(samples);
  return sides;
}

bool maybeSameEdge(const SideLevels& now, const SideLevels& before) {
  constexpr float kTolerance =
      0.5f;                    // of the contrast: the middle between this edge and one that shares a side with it
  constexpr float kLeast = 8;  // grey levels: changes of exposure from frame to frame
  return std::abs(now.mean() - before.mean()) < std::max(kLeast, kTolerance * before.contrast());
}

}  // namespace lintel
