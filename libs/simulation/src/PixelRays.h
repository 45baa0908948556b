// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "lintel/geometry/Camera.h"

namespace lintel {

/// The rays (Camera.h) of a camera's pixels, undistorted once and for all.
class PixelRays {
 public:
  explicit PixelRays(const Camera& camera)
      : width_(camera.width), height_(camera.height), angle_(static_cast<float>(1 / camera.meanFocal())) {
    directions_.reserve(static_cast<std::size_t>(width_) * height_);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        directions_.push_back(camera.ray({static_cast<double>(x), static_cast<double>(y)}).cast<float>());
      }
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  /// About what one pixel covers [rad].
  float angle() const { return angle_; }

  Eigen::Vector3f direction(int x, int y) const { return at(x, y); }

  /// Beside the pixel's centre by (dx, dy) [px], at most half a pixel: linear from the neighbours.
  Eigen::Vector3f direction(int x, int y, float dx, float dy) const {
    const int x0 = std::clamp(x, 1, width_ - 2), y0 = std::clamp(y, 1, height_ - 2);
    const Eigen::Vector3f along_x = 0.5f * (at(x0 + 1, y0) - at(x0 - 1, y0));
    const Eigen::Vector3f along_y = 0.5f * (at(x0, y0 + 1) - at(x0, y0 - 1));
    return at(x, y) + dx * along_x + dy * along_y;
  }

 private:
  const Eigen::Vector3f& at(int x, int y) const { return directions_[static_cast<std::size_t>(y) * width_ + x]; }

  int width_, height_;
  float angle_;
  std::vector<Eigen::Vector3f> directions_;
};

}  // namespace lintel
