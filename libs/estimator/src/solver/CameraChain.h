// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/CameraEquations.h"

namespace lintel {

/// Where states lie among the columns of some equations; negative: a constant.
struct StatePlaces {
  std::vector<Eigen::Index> poses;  ///< of the cameras' frames
  Eigen::Index extrinsics = -1, correction = -1;
  std::vector<Eigen::Index> kept;  ///< of CameraLayout::kept
};

/// The chain rule between the cameras' tangent spaces and the states: a camera hangs on its frame's pose, on the
/// extrinsics and on the time offset; the rest of the correction and kept targets are states themselves. All equations:
/// lower triangles.
class CameraChain {
 public:
  /// `layout` and `views` must outlive the chain.
  CameraChain(const CameraLayout& layout, const std::vector<CameraView>& views, const StatePlaces& places);

  /// Adds the cameras' equations to those of the states: H += G^T H_cameras G, b += G^T b_cameras.
  void add(const CameraEquations& cameras, Eigen::MatrixXd& H, Eigen::VectorXd& b) const;
  void addGradient(const Eigen::VectorXd& b_cameras, Eigen::VectorXd& b) const;

  /// How a step of the states moves cameras, correction and kept targets.
  Eigen::VectorXd cameraStep(const Eigen::VectorXd& step) const;

 private:
  static constexpr int kShared = kPoseTangent + 1;
  using SharedJacobian = Eigen::Matrix<double, kCameraTangent, kShared>;

  /// A stretch of the tail (extrinsics, time offset, rest of the correction, kept targets) and its place among the
  /// states.
  struct Piece {
    Eigen::Index at, size, state;
  };

  void addPiece(const Piece& piece);
  void addPoses(const CameraEquations& cameras, Eigen::MatrixXd& H) const;
  void addTail(const CameraEquations& cameras, Eigen::MatrixXd& H) const;
  Eigen::Index tailSize() const { return kShared + layout_.size() - layout_.correction(); }

  const CameraLayout& layout_;
  const std::vector<CameraView>& views_;
  std::vector<Eigen::Index> poses_;
  std::vector<Piece> tail_;
  std::vector<SharedJacobian> shared_;  ///< of each camera, with respect to extrinsics and time offset
};

}  // namespace lintel
