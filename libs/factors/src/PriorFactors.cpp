// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PriorFactors.h"

#include <Eigen/Geometry>
#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// p <- R (p - from) + to: the shift and the turn about the vertical that bring the anchor to where it was.
struct Alignment {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 4, kPoseTangent> by_anchor = Eigen::Matrix<double, 4, kPoseTangent>::Zero();

  Alignment() = default;
  Alignment(const Pose& now, const Pose& then) : from(now.p), to(then.p) {
    // the yaw of D = R_now R_then^T: of all turns about the vertical the nearest one
    const Eigen::Matrix3d D = (now.q * then.q.conjugate()).toRotationMatrix();
    const double sine = D(1, 0) - D(0, 1), cosine = D(0, 0) + D(1, 1), squared = sine * sine + cosine * cosine;
    R = Eigen::AngleAxisd(-std::atan2(sine, cosine), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    // D <- Exp(w) D with w = R_now dtheta
    const Eigen::RowVector3d d_sine(-D(2, 0), -D(2, 1), cosine), d_cosine(-D(2, 1), D(2, 0), -sine);
    by_anchor.topLeftCorner<3, 3>().setIdentity();  // `from`, then the angle of R
    by_anchor.block<1, 3>(3, 3) = -(cosine * d_sine - sine * d_cosine) / squared * now.R();
  }
};

/// One block's part of a PriorDifference.
struct BlockDifference {
  Eigen::VectorXd value;
  Eigen::MatrixXd by_block;
  Eigen::Matrix<double, Eigen::Dynamic, 4> by_alignment;
};

BlockDifference poseDifference(const double* block, const double* linearisation, const Alignment& a, bool derivatives) {
  const Pose now = poseFromBlock(block), then = poseFromBlock(linearisation);
  const Eigen::Matrix3d R = a.R * now.R();
  const Eigen::Vector3d p = a.R * (now.p - a.from), turned = logRotation(then.q.conjugate() * Eigen::Quaterniond(R));
  BlockDifference d{Eigen::VectorXd(kPoseTangent), {}, {}};
  d.value << p + a.to - then.p, turned;
  if (!derivatives) return d;
  const Eigen::Matrix3d J = rightJacobianInverse(turned);
  d.by_block.setZero(kPoseTangent, kPoseTangent);
  d.by_block.topLeftCorner<3, 3>() = a.R;
  d.by_block.bottomRightCorner<3, 3>() = J;
  d.by_alignment.setZero(kPoseTangent, 4);
  d.by_alignment.topLeftCorner<3, 3>() = -a.R;
  d.by_alignment.col(3) << Eigen::Vector3d::UnitZ().cross(p), J * R.transpose() * Eigen::Vector3d::UnitZ();
  return d;
}

BlockDifference motionDifference(const double* block, const double* linearisation, const Alignment& a,
                                 bool derivatives) {
  const Eigen::Vector3d v = a.R * velocityOf(block);
  BlockDifference d{Eigen::Map<const MotionBlock>(block) - Eigen::Map<const MotionBlock>(linearisation), {}, {}};
  d.value.segment<3>(kVelocityAt) = v - velocityOf(linearisation);
  if (!derivatives) return d;
  d.by_block.setIdentity(kMotionSize, kMotionSize);
  d.by_block.block<3, 3>(kVelocityAt, kVelocityAt) = a.R;
  d.by_alignment.setZero(kMotionSize, 4);
  d.by_alignment.block<3, 1>(kVelocityAt, 3) = Eigen::Vector3d::UnitZ().cross(v);
  return d;
}

/// Of a homogeneous point (X, w): in the plane that touches the unit sphere at the linearisation.
BlockDifference pointDifference(const double* block, const PriorBlock& prior, const Alignment& a, bool derivatives) {
  const Eigen::Map<const Eigen::Vector4d> point(block);
  const Eigen::Vector3d from = prior.origin_w - a.from, turned = a.R * (point.head<3>() + point[3] * from);
  Eigen::Vector4d moved;
  moved << turned + point[3] * (a.to - prior.origin_w), point[3];
  const double norm = moved.norm();
  const Eigen::Vector4d unit = moved / norm;
  RowMajorMatrix minus(kPointTangent, kPointSize), plus(kPointSize, kPointTangent);
  prior.manifold->MinusJacobian(prior.linearisation.data(), minus.data());
  BlockDifference d{minus * unit, {}, {}};
  if (!derivatives) return d;
  prior.manifold->PlusJacobian(block, plus.data());
  const Eigen::Matrix<double, kPointTangent, kPointSize> by_moved =
      minus * (Eigen::Matrix4d::Identity() - unit * unit.transpose()) / norm;
  Eigen::Matrix4d by_point = Eigen::Matrix4d::Identity(), by_alignment = Eigen::Matrix4d::Zero();
  by_point.topLeftCorner<3, 3>() = a.R;
  by_point.topRightCorner<3, 1>() = a.R * from + a.to - prior.origin_w;
  by_alignment.topLeftCorner<3, 3>() = -point[3] * a.R;
  by_alignment.topRightCorner<3, 1>() = Eigen::Vector3d::UnitZ().cross(turned);
  d.by_block = by_moved * by_point * plus;
  d.by_alignment = by_moved * by_alignment;
  return d;
}

/// Of a block on which the alignment does not act.
BlockDifference plainDifference(const double* block, const PriorBlock& prior, bool derivatives) {
  const StateManifold& manifold = *prior.manifold;
  BlockDifference d{Eigen::VectorXd(manifold.TangentSize()), {}, {}};
  manifold.Minus(block, prior.linearisation.data(), d.value.data());
  if (!derivatives || manifold.AmbientSize() == manifold.TangentSize()) return d;
  RowMajorMatrix plus(manifold.AmbientSize(), manifold.TangentSize());
  manifold.PlusJacobian(block, plus.data());
  d.by_block = manifold.differenceJacobian(block, prior.linearisation.data()).lazyProduct(plus);
  return d;
}

BlockDifference blockDifference(const double* block, const PriorBlock& prior, const Alignment& alignment, bool aligned,
                                bool derivatives) {
  const double* x_0 = prior.linearisation.data();
  if (prior.action == GaugeAction::kPoint) return pointDifference(block, prior, alignment, derivatives);
  if (aligned && prior.action == GaugeAction::kPose) return poseDifference(block, x_0, alignment, derivatives);
  if (aligned && prior.action == GaugeAction::kMotion) return motionDifference(block, x_0, alignment, derivatives);
  return plainDifference(block, prior, derivatives);
}

int firstPose(const std::vector<PriorBlock>& blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].action == GaugeAction::kPose) return static_cast<int>(i);
  return -1;
}

}  // namespace

PriorFactor::PriorFactor(std::vector<PriorBlock> blocks, Eigen::MatrixXd A, Eigen::VectorXd r_0)
    : blocks_(std::move(blocks)),
      A_(std::move(A)),
      r_0_(std::move(r_0)),
      information_(Eigen::MatrixXd::Zero(A_.cols(), A_.cols())),
      anchor_(firstPose(blocks_)) {
  information_.selfadjointView<Eigen::Lower>().rankUpdate(A_.transpose());
  information_.triangularView<Eigen::StrictlyUpper>() = information_.transpose();
  for (const PriorBlock& block : blocks_) mutable_parameter_block_sizes()->push_back(block.manifold->AmbientSize());
  set_num_residuals(static_cast<int>(A_.rows()));
}

PriorDifference PriorFactor::difference(double const* const* parameters, bool derivatives) const {
  PriorDifference result;
  result.value.resize(A_.cols());
  result.by_alignment.setZero(A_.cols(), 4);
  Alignment alignment;
  if (anchor_ >= 0) {
    const auto k = static_cast<std::size_t>(anchor_);
    alignment = Alignment(poseFromBlock(parameters[k]), poseFromBlock(blocks_[k].linearisation.data()));
  }
  result.alignment_by_anchor = alignment.by_anchor;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    BlockDifference d = blockDifference(parameters[i], blocks_[i], alignment, anchor_ >= 0, derivatives);
    result.value.segment(at, d.value.size()) = d.value;
    if (d.by_alignment.size() > 0) result.by_alignment.middleRows(at, d.value.size()) = d.by_alignment;
    at += d.value.size();
    if (derivatives) result.by_block.push_back(std::move(d.by_block));
  }
  return result;
}

bool PriorFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const PriorDifference d = difference(parameters, jacobians != nullptr);
  Eigen::Map<Eigen::VectorXd>(residuals, A_.rows()) = r_0_ + A_ * d.value;
  if (!jacobians) return true;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const StateManifold& manifold = *blocks_[i].manifold;
    const Eigen::Index size = manifold.TangentSize();
    if (jacobians[i]) {
      Eigen::MatrixXd by_tangent = A_.middleCols(at, size);
      if (d.by_block[i].size() > 0) by_tangent = (by_tangent * d.by_block[i]).eval();
      if (static_cast<int>(i) == anchor_) by_tangent += A_ * d.by_alignment * d.alignment_by_anchor;
      RowMajorMatrix lift(size, manifold.AmbientSize());
      manifold.MinusJacobian(parameters[i], lift.data());
      Eigen::Map<RowMajorMatrix>(jacobians[i], A_.rows(), manifold.AmbientSize()).noalias() = by_tangent * lift;
    }
    at += size;
  }
  return true;
}

std::unique_ptr<PriorFactor> makeBlockPrior(std::shared_ptr<const StateManifold> manifold, const Eigen::VectorXd& x_0,
                                            const Eigen::VectorXd& sigma) {
  const Eigen::Index size = manifold->TangentSize();
  std::vector<PriorBlock> blocks{{std::move(manifold), x_0}};
  return std::make_unique<PriorFactor>(std::move(blocks), Eigen::MatrixXd(sigma.cwiseInverse().asDiagonal()),
                                       Eigen::VectorXd::Zero(size));
}

}  // namespace lintel
