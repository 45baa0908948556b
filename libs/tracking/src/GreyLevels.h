// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

namespace lintel {

/// Grey levels of an 8 bit image at the first `count` places (x, y), interpolated linearly; x and y keep what lies
/// beyond the pixel. Places may lie up to `Beyond` pixels outside the image, as far as memory around it can be read.
/// Loops apart, so that all but the fetching is done for four places at once.
template <int Beyond, std::size_t Most>
void greyLevels(const cv::Mat& image, std::size_t count, std::array<float, Most>& x, std::array<float, Most>& y,
                float* grey) {
  std::array<int, Most> ix, iy, a0, a1, b0, b1;
  for (std::size_t i = 0; i < count; ++i) {
    ix[i] = static_cast<int>(x[i] + Beyond) - Beyond, iy[i] = static_cast<int>(y[i] + Beyond) - Beyond;
    x[i] -= static_cast<float>(ix[i]), y[i] -= static_cast<float>(iy[i]);
  }
  const auto row = static_cast<std::ptrdiff_t>(image.step[0]);
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned char *above = image.data + iy[i] * row + ix[i], *below = above + row;
    a0[i] = above[0], a1[i] = above[1], b0[i] = below[0], b1[i] = below[1];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float top = static_cast<float>(a0[i]) + x[i] * static_cast<float>(a1[i] - a0[i]);
    const float bottom = static_cast<float>(b0[i]) + x[i] * static_cast<float>(b1[i] - b0[i]);
    grey[i] = top + y[i] * (bottom - top);
  }
}

}  // namespace lintel
