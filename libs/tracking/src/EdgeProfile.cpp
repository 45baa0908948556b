// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeProfile.h"

#include "GreyLevels.h"

namespace lintel {

void gradientsAcross(const cv::Mat& image, const Eigen::Vector2d& centre, const Eigen::Vector2d& step, double stride,
                     int reach, EdgeProfile& profile) {
  constexpr int kBeyond = 64;  // near the rim
  std::array<float, 2 * (2 * kMaxReach + 5)> x, y, grey;
  const auto places = static_cast<std::size_t>(2 * reach + 5);
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

}  // namespace lintel
