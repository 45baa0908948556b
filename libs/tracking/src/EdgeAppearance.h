// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "ImageLine.h"

namespace lintel {

constexpr int kMaxReach = 8;  ///< places of a gradient profile to each side of its centre

/// Gradients at places across an edge, one after the other, in 32 times grey levels a pixel.
using GradientProfile = std::array<float, 2 * kMaxReach + 3>;

/// Gradients along `step` (`stride` pixels of `image`) at 2 reach + 3 places around `centre`, from the image itself:
/// derivatives of the whole image would be four times as large and not be in the cache. Each grey level is the mean of
/// two places half a pixel to both sides along the edge, and each gradient a difference over two steps, so that noise
/// is as low as after Scharr's filter. The caller keeps the places within the image or the pixels readable around it.
void gradientsAcross(const cv::Mat& image, const Eigen::Vector2d& centre, const Eigen::Vector2d& step, double stride,
                     int reach, GradientProfile& profile);

/// Mean grey levels on the darker and on the brighter side of a segment.
struct SideLevels {
  float dark = 0, bright = 0;
  float contrast() const { return bright - dark; }
  float mean() const { return 0.5f * (dark + bright); }
};

/// The grey levels a few pixels beside an edge: neighbouring edges of the same direction and sign differ in them. Empty
/// where less than half of the segment is in the image (8 bit grey).
std::optional<SideLevels> sideLevels(const LineCamera& camera, const cv::Mat& image, const ImageLine& line);

/// Whether an edge may be the one that had the levels `before`. Blur brings the levels of both sides closer and keeps
/// their mean; the next edge of a staircase has another mean.
bool maybeSameEdge(const SideLevels& now, const SideLevels& before);

}  // namespace lintel
