// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace lintel {

/// Grey levels of an 8 bit image at the first `count` places (x, y), interpolated linearly; x and y keep what lies
/// beyond the pixel. Places may lie up to `Beyond` pixels outside the image, as far as memory around it can be read.
/// Loops apart, so that all but the fetching is done for four places at once.
template <int Beyond, std::size_t Most>
void greyLevels(const cv::Mat& image, std::size_t count, std::array<float, Most>& x, std::array<float, Most>& y,
                float* grey) {
  std::array<int, Most> ix, iy;
  std::array<std::uint32_t, Most> four;  // pixels: above, its neighbour to the right, below, its neighbour
  for (std::size_t i = 0; i < count; ++i) {
    ix[i] = static_cast<int>(x[i] + Beyond) - Beyond, iy[i] = static_cast<int>(y[i] + Beyond) - Beyond;
    x[i] -= static_cast<float>(ix[i]), y[i] -= static_cast<float>(iy[i]);
  }
  const auto row = static_cast<std::ptrdiff_t>(image.step[0]);
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned char *above = image.data + iy[i] * row + ix[i], *below = above + row;
    const std::uint32_t upper = above[0] | std::uint32_t{above[1]} << 8,
                        lower = below[0] | std::uint32_t{below[1]} << 8;
    four[i] = upper | lower << 16;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto pixel = [&](int bits) { return static_cast<int>(four[i] >> bits & 255); };
    const float top = static_cast<float>(pixel(0)) + x[i] * static_cast<float>(pixel(8) - pixel(0));
    const float bottom = static_cast<float>(pixel(16)) + x[i] * static_cast<float>(pixel(24) - pixel(16));
    grey[i] = top + y[i] * (bottom - top);
  }
}

}  // namespace lintel
