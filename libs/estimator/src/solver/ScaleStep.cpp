// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ScaleStep.h"

#include <algorithm>
#include <cmath>

#include "solver/Factor.h"

namespace lintel {

namespace {

// A window's scale is not known to be positive to a linear step.
constexpr double kLeastChange = -0.5, kMostChange = 1;
constexpr double kThroughOrigin = 1e-6;  // cos(phi) of a line whose moment has no direction

/// `origin`: the point's, seen from the centre that everything moves away from.
PointBlock scaledPoint(const double* block, const Eigen::Vector3d& origin, double change) {
  PointBlock point = PointBlock::Map(block);
  point.head<3>() += change * (point.head<3>() + point[3] * origin);
  return point.normalized();
}

/// How a point's tangent moves with the scale.
Eigen::Vector3d pointRate(const double* block, const Eigen::Vector3d& origin) {
  Eigen::Matrix<double, kPointTangent, kPointSize, Eigen::RowMajor> J;
  manifoldOf(BlockKey::kPoint)->MinusJacobian(block, J.data());
  return J.leftCols<3>() * (Eigen::Vector3d::Map(block) + block[3] * origin);
}

PluckerLine scaledLine(const PluckerLine& line, const Eigen::Vector3d& origin, double change) {
  return {line.n + change * (line.n + origin.cross(line.d)), line.d};
}

/// The moment changes, the direction does not: a turn about the direction, and phi.
Eigen::Vector4d lineRate(const double* block, const Eigen::Vector3d& origin) {
  const OrthonormalLine orthonormal = lineFromBlock(block);
  const PluckerLine line = orthonormal.plucker();
  const double moment = std::cos(orthonormal.phi);
  if (std::abs(moment) < kThroughOrigin) return Eigen::Vector4d::Zero();
  const Eigen::Vector3d dn = orthonormal.U.conjugate() * (line.n + origin.cross(line.d));
  return {0, -dn.z() / moment, 0, -std::sin(orthonormal.phi) * dn.x()};
}

}  // namespace

double landmarkDistance(BlockKey::Kind kind, const Eigen::Vector3d& origin, const double* block) {
  if (kind == BlockKey::kPoint) return (block[3] * origin + Eigen::Vector3d::Map(block)).norm() / std::abs(block[3]);
  return movedOrigin(lineFromBlock(block).plucker(), -origin).distance();
}

const Eigen::Vector3d& originOf(const SlidingWindow& window, const BlockKey& landmark) {
  return landmark.kind == BlockKey::kPoint ? window.points.at(landmark.id).origin_w
                                           : window.lines.at(landmark.id).origin_w;
}

ScaleStep::ScaleStep(const Eigen::Vector3d& centre_w, double change)
    : centre_w_(centre_w), change_(std::clamp(change, kLeastChange, kMostChange)) {}

void ScaleStep::plus(BlockKey::Kind kind, const Eigen::Vector3d& origin_w, const double* block, const double* step,
                     double* moved) const {
  if (change_ == 0) {
    manifoldOf(kind)->Plus(block, step, moved);
    return;
  }
  const Eigen::Vector3d origin = origin_w - centre_w_;
  if (kind == BlockKey::kPoint) {
    const Eigen::Vector3d rest = Eigen::Vector3d::Map(step) - change_ * pointRate(block, origin);
    PointBlock point;
    manifoldOf(kind)->Plus(block, rest.data(), point.data());
    PointBlock::Map(moved) = scaledPoint(point.data(), origin, change_);
  } else {
    const Eigen::Vector4d rest = Eigen::Vector4d::Map(step) - change_ * lineRate(block, origin);
    LineBlock line;
    manifoldOf(kind)->Plus(block, rest.data(), line.data());
    LineBlock::Map(moved) = toBlock(toOrthonormal(scaledLine(lineFromBlock(line.data()).plucker(), origin, change_)));
  }
}

}  // namespace lintel
