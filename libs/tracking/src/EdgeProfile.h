// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace lintel {

constexpr int kMaxReach = 8;  ///< profiles reach this far at most

/// Gradients across an edge, one after the other, in 32 times grey levels a pixel.
using EdgeProfile = std::array<float, 2 * kMaxReach + 3>;

/// Gradients along `step` (`stride` pixels of `image`) at 2 reach + 3 places around `centre`, from the image itself:
/// derivatives of the whole image would be four times as large and not be in the cache. Each grey level is the mean of
/// two places half a pixel to both sides along the edge, and each gradient a difference over two steps, so that noise
/// is as low as after Scharr's filter. The caller keeps the places within the image or the pixels readable around it.
void gradientsAcross(const cv::Mat& image, const Eigen::Vector2d& centre, const Eigen::Vector2d& step, double stride,
                     int reach, EdgeProfile& profile);

}  // namespace lintel
