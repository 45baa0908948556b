// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "lintel/factors/ImageFactor.h"
#include "lintel/factors/TrackLoss.h"
#include "solver/CameraEquations.h"
#include "solver/Factor.h"

namespace lintel {

/// A point or a line that is eliminated: its residuals, its part of the normal equations, and its last elimination.
template <class Target>
struct LandmarkBlock {
  static constexpr int T = Target::kTangent, kSize = Target::kSize;
  static constexpr BlockKey::Kind kKind = kKindOf<Target>;
  using CameraPart = Eigen::Matrix<double, kCameraTangent, T>;

  struct Sighting {
    const ImageFactor<Target>* factor = nullptr;
    int camera = 0;
    ImageLinearisation<Target> linearised;
    CameraPart W = CameraPart::Zero(), Y = CameraPart::Zero();  ///< camera-landmark block of H; the same times the
                                                                ///< inverse root of the landmark's block
  };

  double* block = nullptr;
  const ceres::LossFunction* loss = nullptr;                      ///< of a sighting
  TrackLoss track_loss{std::numeric_limits<double>::infinity()};  ///< of all sightings together
  std::vector<Sighting> sightings;
  const Factor* tie = nullptr;  ///< ties a line to a direction
  int direction = -1;           ///< its place among the kept targets

  Eigen::Matrix<double, T, T> H, inverse_root;
  Eigen::Matrix<double, T, 1> b, step;
  CameraPart W_intrinsics, Y_intrinsics;
  Eigen::Matrix<double, kDirectionTangent, T> W_direction, Y_direction;

  /// The landmark's robust cost at the blocks' present values.
  double cost(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout) const;

  /// Takes residuals and Jacobians, adds the cameras' part to `eq`; returns the cost.
  double linearise(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout,
                   CameraEquations& eq);

  /// Takes the landmark out of `eq`, `damping` times its diagonal added.
  void eliminate(double damping, const CameraLayout& layout, CameraEquations& eq);

  /// Its reaction to a step of the cameras, in `step`; returns its part of the model's decrease.
  double backSubstitute(const Eigen::VectorXd& camera_step, double damping, const CameraLayout& layout);

 private:
  /// The cost of sightings whose squared residuals, robust, have this sum, and the weight that their track has.
  double trackCost(double squared, double& weight) const {
    return track_loss.cost(squared, Target::kRows * static_cast<int>(sightings.size()), T, weight);
  }
  void addSighting(Sighting& sighting, double track_weight, const RowMajorMatrix& plus, const CameraLayout& layout,
                   CameraEquations& eq);
  double addTie(const CameraLayout& layout, CameraEquations& eq);
  void eliminateTie(const Eigen::Matrix<double, T, 1>& y, const CameraLayout& layout, CameraEquations& eq);
};

/// A residual of an image whose target is kept; it has no loss of its track.
template <class Target>
struct KeptSighting {
  const ImageFactor<Target>* factor = nullptr;
  const ceres::LossFunction* loss = nullptr;
  int camera = 0, target = 0;

  double cost(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout) const;
  double linearise(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout,
                   CameraEquations& eq) const;
};

// no factor ties a point to a direction
template <>
double LandmarkBlock<PointTarget>::addTie(const CameraLayout& layout, CameraEquations& eq);
template <>
void LandmarkBlock<PointTarget>::eliminateTie(const Eigen::Vector3d& y, const CameraLayout& layout,
                                              CameraEquations& eq);
template <>
double LandmarkBlock<LineTarget>::addTie(const CameraLayout& layout, CameraEquations& eq);
template <>
void LandmarkBlock<LineTarget>::eliminateTie(const Eigen::Vector4d& y, const CameraLayout& layout, CameraEquations& eq);

// Compiled in PointBlock.cpp, LineBlock.cpp, KeptSighting.cpp.
extern template struct LandmarkBlock<PointTarget>;
extern template struct LandmarkBlock<LineTarget>;
extern template struct KeptSighting<PointTarget>;
extern template struct KeptSighting<LineTarget>;
extern template struct KeptSighting<DirectionTarget>;

}  // namespace lintel
