// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// Pinhole camera with radial-tangential distortion: OpenCV's and EuRoC's model with k1 k2 p1 p2.
/// Pixel (0, 0) is the centre of the upper left pixel.
struct PinholeRadtan {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;

  /// Distorts normalised image coordinates (x/z, y/z).
  Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;

  /// Inverse of distort by Newton iterations to 1e-12; diverging inputs (far outside the image) return the last
  /// iterate.
  Eigen::Vector2d undistort(const Eigen::Vector2d& distorted) const;

  /// A point in the camera frame [m] with z > 0 to distorted pixels.
  Eigen::Vector2d project(const Eigen::Vector3d& p_c) const;

  /// Distorted pixels to normalised coordinates (x/z, y/z).
  Eigen::Vector2d normalise(const Eigen::Vector2d& px) const;

  /// Normalised coordinates to distorted pixels.
  Eigen::Vector2d toPixel(const Eigen::Vector2d& normalised) const;

  /// d distort / d normalised.
  Eigen::Matrix2d distortJacobian(const Eigen::Vector2d& normalised) const;

  double meanFocal() const { return 0.5 * (fx + fy); }
  bool contains(const Eigen::Vector2d& px, double border_px = 0) const {
    return px.x() >= border_px && px.y() >= border_px && px.x() <= width - 1 - border_px &&
           px.y() <= height - 1 - border_px;
  }
};

}  // namespace lintel
