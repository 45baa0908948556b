// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/manifold.h>

#include <Eigen/Core>
#include <memory>

namespace lintel {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A manifold that also differentiates the difference of two distant points, as a prior needs it.
class StateManifold : public ceres::Manifold {
 public:
  /// d (y ⊟ x) / d y in ambient coordinates of y: tangent x ambient, exact also for y far from x.
  virtual RowMajorMatrix differenceJacobian(const double* y, const double* x) const = 0;
};

/// R^n.
class VectorManifold final : public StateManifold {
 public:
  explicit VectorManifold(int size) : size_(size) {}
  int AmbientSize() const override { return size_; }
  int TangentSize() const override { return size_; }
  bool Plus(const double* x, const double* delta, double* y) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* delta) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
  RowMajorMatrix differenceJacobian(const double* y, const double* x) const override;

 private:
  int size_;
};

/// R^3 x SO(3): position, then quaternion x y z w; see StateBlocks.h.
class PoseManifold final : public StateManifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* y) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* delta) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
  RowMajorMatrix differenceJacobian(const double* y, const double* x) const override;
};

/// The unit sphere in R^4: homogeneous points. Points are never part of a prior: differenceJacobian throws.
class PointManifold final : public StateManifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* y) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* delta) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
  RowMajorMatrix differenceJacobian(const double* y, const double* x) const override;
};

/// SO(3) x S^1: the orthonormal line [Bartoli2005]; see StateBlocks.h.
class LineManifold final : public StateManifold {
 public:
  int AmbientSize() const override { return 5; }
  int TangentSize() const override { return 4; }
  bool Plus(const double* x, const double* delta, double* y) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* delta) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
  RowMajorMatrix differenceJacobian(const double* y, const double* x) const override;
};

/// The unit sphere in R^3 in gnomonic coordinates about x: Plus and Minus are inverses of each other on the half sphere
/// around x.
class DirectionManifold final : public StateManifold {
 public:
  int AmbientSize() const override { return 3; }
  int TangentSize() const override { return 2; }
  bool Plus(const double* x, const double* delta, double* y) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* delta) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
  RowMajorMatrix differenceJacobian(const double* y, const double* x) const override;
};

}  // namespace lintel
