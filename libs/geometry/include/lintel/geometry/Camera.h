// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace lintel {

/// How a lens bends light, and the order of its coefficients in Camera::lens.
enum class LensModel : int {
  kRadialTangential,  ///< k1 k2 p1 p2 k3 as OpenCV; all 0: no distortion
  kRational,          ///< k1 k2 p1 p2 k3 k4 k5 k6 as OpenCV
  kEquidistant,       ///< k1 k2 k3 k4 as OpenCV's fisheye; [Kannala2006]
  kDoubleSphere,      ///< xi alpha [Usenko2018]
  kExtendedUnified,   ///< alpha beta [Khomutenko2016]
};

/// fx fy cx cy and the first two coefficients of the lens: what online calibration refines, in this order.
constexpr int kIntrinsicsSize = 6;

/// Derivatives of a projected pixel.
struct PixelJacobians {
  Eigen::Matrix<double, 2, 3> point;                     ///< by the point in the camera frame
  Eigen::Matrix<double, 2, kIntrinsicsSize> intrinsics;  ///< by the intrinsics
};

/// A camera with one centre of projection. Pixel (0, 0) is the centre of the upper left pixel.
///
///   px = (fx, fy) * image(lens, p_c) + (cx, cy)
///
/// Directions of view are *rays*: (x/z, y/z, 1) of lenses that see less than 180 degrees, and vectors of unit length of
/// wide ones, whose rays may point sideways and backwards (z <= 0).
struct Camera {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  std::array<double, 8> lens{};           ///< coefficients of `model`; those that it does not have are 0
  LensModel model = LensModel::kRadialTangential;

  /// Whether rays are on the unit sphere; else they are on the plane z = 1.
  bool wide() const { return model >= LensModel::kEquidistant; }

  /// The ray of a pixel; false where the lens maps no ray there: `ray` is then the nearest that was found.
  bool unproject(const Eigen::Vector2d& px, Eigen::Vector3d& ray) const;

  /// The same for pixels known to be seen.
  Eigen::Vector3d ray(const Eigen::Vector2d& px) const;

  /// The ray of a point in the camera frame: scaled to z = 1 (z > 0) or unit length.
  Eigen::Vector3d rayTo(const Eigen::Vector3d& p_c) const {
    return wide() ? Eigen::Vector3d(p_c.normalized()) : Eigen::Vector3d(p_c.x() / p_c.z(), p_c.y() / p_c.z(), 1);
  }

  /// Depth of a point in the camera frame that is looked for along `ray`: z, or the distance along the ray.
  double depth(const Eigen::Vector3d& p_c, const Eigen::Vector3d& ray) const { return wide() ? p_c.dot(ray) : p_c.z(); }

  /// A point in the camera frame to pixels. Says nothing about points that the lens cannot see: ask projects().
  Eigen::Vector2d project(const Eigen::Vector3d& p_c) const;

  /// Whether the model holds at a point in the camera frame: in front of a lens with z = 1, within the angle up to
  /// which the image grows with the angle. The pixel may be outside the image all the same.
  bool projects(const Eigen::Vector3d& p_c) const;

  /// The pixel, and the derivatives of `scale` times the pixel.
  Eigen::Vector2d project(const Eigen::Vector3d& p_c, double scale, PixelJacobians& scaled) const;

  /// The intrinsics in the order of kIntrinsicsSize.
  double& intrinsic(int k) {
    double* const values[] = {&fx, &fy, &cx, &cy, &lens[0], &lens[1]};
    return *values[k];
  }
  double intrinsic(int k) const { return Camera(*this).intrinsic(k); }

  /// Pixels of a radian at the optical axis, without k1 and further coefficients.
  double meanFocal() const { return 0.5 * (fx + fy) / (model == LensModel::kDoubleSphere ? 1 + lens[0] : 1); }
  bool contains(const Eigen::Vector2d& px, double border_px = 0) const {
    return px.x() >= border_px && px.y() >= border_px && px.x() <= width - 1 - border_px &&
           px.y() <= height - 1 - border_px;
  }

  // Of lenses that are not wide, between coordinates (x/z, y/z) without and with distortion.

  Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;

  /// Inverse of distort by Newton iterations to 1e-12, from a place near it; diverging inputs (far outside the image)
  /// return the last iterate.
  Eigen::Vector2d undistort(const Eigen::Vector2d& distorted, const Eigen::Vector2d& near) const;
  Eigen::Vector2d undistort(const Eigen::Vector2d& distorted) const { return undistort(distorted, distorted); }

  /// d distort / d normalised.
  Eigen::Matrix2d distortJacobian(const Eigen::Vector2d& normalised) const;

  /// d distort / d first two coefficients.
  Eigen::Matrix2d coefficientJacobian(const Eigen::Vector2d& normalised) const;

  /// Distorted pixels to (x/z, y/z), and back.
  Eigen::Vector2d normalise(const Eigen::Vector2d& px) const;
  Eigen::Vector2d normalise(const Eigen::Vector2d& px, const Eigen::Vector2d& near) const;  ///< from a place near it
  Eigen::Vector2d toPixel(const Eigen::Vector2d& normalised) const;
};

/// The largest angle between the optical axis and a ray of the image [rad].
double largestAngle(const Camera& camera);

}  // namespace lintel
