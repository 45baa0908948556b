// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeSides.h"

#include <algorithm>
#include <cmath>

namespace lintel {

std::optional<EdgeSides> sidesOf(const LineCamera& camera, const cv::Mat& image, const ImageLine& line) {
  constexpr int kSamples = 12;
  constexpr double kBeside_px = 3;
  EdgeSides sides;
  int samples = 0;
  const Eigen::Vector2d n = line.normal();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d u = line.at((i + 0.5) / kSamples);
    if (!camera.sees(u, kBeside_px + 2)) continue;
    const Eigen::Vector2d px = camera.toImage(u), step = kBeside_px * (camera.imageJacobian(u) * n).normalized();
    const auto grey = [&](const Eigen::Vector2d& at) {
      return static_cast<float>(image.at<unsigned char>(cvRound(at.y()), cvRound(at.x())));
    };
    sides.dark += grey(px - step), sides.bright += grey(px + step);
    ++samples;
  }
  if (2 * samples < kSamples) return std::nullopt;
  sides.dark /= static_cast<float>(samples), sides.bright /= static_cast<float>(samples);
  return sides;
}

bool maybeSame(const EdgeSides& now, const EdgeSides& before) {
  constexpr float kTolerance = 0.5f;  // of the edge's step
  constexpr float kLeast = 8;         // grey levels
  return std::abs(now.mean() - before.mean()) < std::max(kLeast, kTolerance * before.step());
}

}  // namespace lintel
