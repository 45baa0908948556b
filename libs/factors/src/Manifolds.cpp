// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/Manifolds.h"

#include <ceres/sphere_manifold.h>

#include <stdexcept>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

Eigen::Quaterniond quaternionAt(const double* x) { return Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)); }

void plusRotation(const double* q, const double* delta, double* result) {
  Eigen::Map<Eigen::Vector4d>(result, 4) =
      (quaternionAt(q) * expRotation(Eigen::Map<const Eigen::Vector3d>(delta))).normalized().coeffs();
}

Eigen::Vector3d minusRotation(const double* y, const double* x) {
  return logRotation(quaternionAt(x).conjugate() * quaternionAt(y));
}

/// d Log(x^-1 y) / d coefficients of y.
Eigen::Matrix<double, 3, 4> rotationDifferenceJacobian(const double* y, const double* x) {
  return rightJacobianInverse(minusRotation(y, x)) * rotationLift(quaternionAt(y));
}

using RowMajorMap = Eigen::Map<RowMajorMatrix>;
using PointSphere = ceres::SphereManifold<kPointSize>;

}  // namespace

bool VectorManifold::Plus(const double* x, const double* delta, double* y) const {
  for (int i = 0; i < size_; ++i) y[i] = x[i] + delta[i];
  return true;
}
bool VectorManifold::PlusJacobian(const double*, double* jacobian) const {
  RowMajorMap(jacobian, size_, size_).setIdentity();
  return true;
}
bool VectorManifold::Minus(const double* y, const double* x, double* delta) const {
  for (int i = 0; i < size_; ++i) delta[i] = y[i] - x[i];
  return true;
}
bool VectorManifold::MinusJacobian(const double* x, double* jacobian) const { return PlusJacobian(x, jacobian); }
RowMajorMatrix VectorManifold::differenceJacobian(const double*, const double*) const {
  return RowMajorMatrix::Identity(size_, size_);
}

bool PoseManifold::Plus(const double* x, const double* delta, double* y) const {
  for (int i = 0; i < 3; ++i) y[i] = x[i] + delta[i];
  plusRotation(x + 3, delta + 3, y + 3);
  return true;
}
bool PoseManifold::PlusJacobian(const double* x, double* jacobian) const {
  RowMajorMap J(jacobian, 7, 6);
  J.setZero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<4, 3>() = rotationPlus(quaternionAt(x + 3));
  return true;
}
bool PoseManifold::Minus(const double* y, const double* x, double* delta) const {
  for (int i = 0; i < 3; ++i) delta[i] = y[i] - x[i];
  Eigen::Map<Eigen::Vector3d>(delta + 3) = minusRotation(y + 3, x + 3);
  return true;
}
bool PoseManifold::MinusJacobian(const double* x, double* jacobian) const {
  RowMajorMap(jacobian, 6, 7) = differenceJacobian(x, x);
  return true;
}
RowMajorMatrix PoseManifold::differenceJacobian(const double* y, const double* x) const {
  RowMajorMatrix J = RowMajorMatrix::Zero(6, 7);
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<3, 4>() = rotationDifferenceJacobian(y + 3, x + 3);
  return J;
}

bool PointManifold::Plus(const double* x, const double* delta, double* y) const {
  return PointSphere().Plus(x, delta, y);
}
bool PointManifold::PlusJacobian(const double* x, double* jacobian) const {
  return PointSphere().PlusJacobian(x, jacobian);
}
bool PointManifold::Minus(const double* y, const double* x, double* delta) const {
  return PointSphere().Minus(y, x, delta);
}
bool PointManifold::MinusJacobian(const double* x, double* jacobian) const {
  return PointSphere().MinusJacobian(x, jacobian);
}
RowMajorMatrix PointManifold::differenceJacobian(const double*, const double*) const {
  throw std::logic_error("PointManifold: a point cannot be part of a prior");
}

bool LineManifold::Plus(const double* x, const double* delta, double* y) const {
  plusRotation(x, delta, y);
  y[4] = x[4] + delta[3];
  return true;
}
bool LineManifold::PlusJacobian(const double* x, double* jacobian) const {
  RowMajorMap J(jacobian, 5, 4);
  J.setZero();
  J.topLeftCorner<4, 3>() = rotationPlus(quaternionAt(x));
  J(4, 3) = 1;
  return true;
}
bool LineManifold::Minus(const double* y, const double* x, double* delta) const {
  Eigen::Map<Eigen::Vector3d>(delta, 3) = minusRotation(y, x);
  delta[3] = y[4] - x[4];
  return true;
}
bool LineManifold::MinusJacobian(const double* x, double* jacobian) const {
  RowMajorMap(jacobian, 4, 5) = differenceJacobian(x, x);
  return true;
}
RowMajorMatrix LineManifold::differenceJacobian(const double* y, const double* x) const {
  RowMajorMatrix J = RowMajorMatrix::Zero(4, 5);
  J.topLeftCorner<3, 4>() = rotationDifferenceJacobian(y, x);
  J(3, 4) = 1;
  return J;
}

bool DirectionManifold::Plus(const double* x, const double* delta, double* y) const {
  const Eigen::Vector3d d = Eigen::Vector3d::Map(x);
  Eigen::Vector3d::Map(y) = (d + tangentBasis(d) * Eigen::Vector2d::Map(delta)).normalized();
  return true;
}
bool DirectionManifold::PlusJacobian(const double* x, double* jacobian) const {
  RowMajorMap(jacobian, 3, 2) = tangentBasis(Eigen::Vector3d::Map(x));
  return true;
}
bool DirectionManifold::Minus(const double* y, const double* x, double* delta) const {
  const Eigen::Vector3d to = Eigen::Vector3d::Map(y), from = Eigen::Vector3d::Map(x);
  Eigen::Vector2d::Map(delta) = tangentBasis(from).transpose() * to / from.dot(to);
  return true;
}
bool DirectionManifold::MinusJacobian(const double* x, double* jacobian) const {
  RowMajorMap(jacobian, 2, 3) = differenceJacobian(x, x);
  return true;
}
RowMajorMatrix DirectionManifold::differenceJacobian(const double* y, const double* x) const {
  const Eigen::Vector3d to = Eigen::Vector3d::Map(y), from = Eigen::Vector3d::Map(x);
  const Eigen::Matrix<double, 2, 3> Bt = tangentBasis(from).transpose();
  const double cosine = from.dot(to);
  return Bt / cosine - Bt * to * from.transpose() / (cosine * cosine);
}

}  // namespace lintel
