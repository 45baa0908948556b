// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <set>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/CameraView.h"
#include "window/WindowFactors.h"

namespace lintel {

/// Normal equations over cameras (6 each, in the order of the window's frames), intrinsics (6), directions (2 each).
struct CameraEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// Where the columns of CameraEquations lie.
struct CameraLayout {
  int cameras = 0;
  std::map<std::uint64_t, int> directions;  ///< id of a direction to its place
  std::vector<const double*> direction_blocks;

  Eigen::Index camera(int k) const { return kCameraTangent * k; }
  Eigen::Index intrinsics() const { return kCameraTangent * cameras; }
  Eigen::Index direction(int k) const { return intrinsics() + kIntrinsicsSize + kDirectionTangent * k; }
  Eigen::Index size() const { return direction(static_cast<int>(directions.size())); }
};

/// One kind of landmark (its factor class, what a linearisation of it is, ambient and tangent size).
struct PointKind {
  using Factor = PointFactor;
  using Linearisation = PointLinearisation;
  static constexpr int kSize = kPointSize, kTangent = kPointTangent;
};
struct LineKind {
  using Factor = LineFactor;
  using Linearisation = LineLinearisation;
  static constexpr int kSize = kLineSize, kTangent = kLineTangent;
};

/// A landmark of a kind with its residuals, its part of the normal equations, and its last elimination.
template <class Kind>
struct LandmarkBlock {
  static constexpr int T = Kind::kTangent;
  using CameraPart = Eigen::Matrix<double, kCameraTangent, T>;

  struct Sighting {
    const typename Kind::Factor* factor = nullptr;
    int camera = 0;
    CameraPart W = CameraPart::Zero(), Y = CameraPart::Zero();  ///< camera-landmark block of H; the same times the
                                                                ///< inverse root of the landmark's block
  };

  double* block = nullptr;
  const ceres::LossFunction* loss = nullptr;
  std::vector<Sighting> sightings;
  const lintel::Factor* structural = nullptr;  ///< ties a line to a shared direction
  int direction = -1;

  Eigen::Matrix<double, T, T> H, inverse_root;
  Eigen::Matrix<double, T, 1> b, step;
  CameraPart W_intrinsics, Y_intrinsics;
  Eigen::Matrix<double, kDirectionTangent, T> W_direction, Y_direction;
};

/// A sighting of a line that has a direction only.
struct DirectionSighting {
  const VanishingFactor* factor = nullptr;
  const ceres::LossFunction* loss = nullptr;
  int camera = 0, direction = 0;
};

/// All points and lines of a window: their residuals in the cameras' tangent spaces and their elimination.
class LandmarkSystem {
 public:
  /// Groups the factors of landmarks; `camera_of` gives every frame its place.
  LandmarkSystem(SlidingWindow& window, const std::vector<Factor>& factors, const std::map<FrameId, int>& camera_of);

  /// Whether a factor depends on images, and thus belongs here.
  static bool isVision(const Factor& factor);

  const CameraLayout& layout() const { return layout_; }

  /// The states that its residuals depend on.
  std::set<BlockKey> states(const SlidingWindow& window) const;

  const FrameMotion& motion(int camera) const {
    return motions_[static_cast<std::size_t>(camera)];
  }  ///< as its factors say
  double cost(const std::vector<CameraView>& views) const;
  double linearise(const std::vector<CameraView>& views);

  /// Of the residuals alone, landmarks held fixed: lower triangle of H.
  const CameraEquations& direct() const { return direct_; }

  /// Landmarks eliminated, `damping` times their diagonal added: lower triangle of H. Without damping, directions of a
  /// landmark that no residual sees are left out.
  CameraEquations eliminate(double damping);

  /// The landmarks' reaction to a step of the cameras; their part of the model's decrease.
  double backSubstitute(const Eigen::VectorXd& camera_step, double damping);

  void apply(std::vector<double>& saved);  ///< appends the former values
  std::size_t revert(const std::vector<double>& saved, std::size_t at);

 private:
  template <class F>
  void each(F&& f) {
    for (auto& point : points_) f(point);
    for (auto& line : lines_) f(line);
  }
  template <class F>
  void each(F&& f) const {
    for (const auto& point : points_) f(point);
    for (const auto& line : lines_) f(line);
  }
  int directionOf(SlidingWindow& window, const BlockKey& key);

  const double* correction_;
  std::vector<FrameMotion> motions_;
  std::vector<bool> seeing_;  ///< cameras with residuals
  CameraLayout layout_;
  std::vector<LandmarkBlock<PointKind>> points_;
  std::vector<LandmarkBlock<LineKind>> lines_;
  std::vector<DirectionSighting> vanishing_;
  CameraEquations direct_;
};

}  // namespace lintel
