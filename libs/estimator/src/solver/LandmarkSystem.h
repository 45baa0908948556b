// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "solver/LandmarkBlock.h"
#include "solver/ScaleStep.h"

namespace lintel {

/// Mean squares of the whitened residuals of tracks, each for a degree of freedom.
struct ResidualLevels {
  std::vector<double> points, lines;
};

/// The residuals of a window's images in the cameras' tangent spaces, and the elimination of points and lines.
///
/// How a factor is linearised follows from what it is:
/// - an ImageFactor by `linearise`, for all residuals of an image with the camera worked out once;
/// - a LineDirectionFactor, one a line, together with its line;
/// - any other, over whatever blocks, by its Evaluate among the states (`others`). Points and lines that it touches are
///   not eliminated one by one but stay among the states: right for any factor, and slower the more they are.
class LandmarkSystem {
 public:
  /// Groups the factors; `camera_of` gives every frame its place. Window and factors must outlive the system.
  LandmarkSystem(SlidingWindow& window, const std::vector<Factor>& factors, const std::map<FrameId, int>& camera_of,
                 const std::set<BlockKey>& staying = {});

  const CameraLayout& layout() const { return layout_; }

  /// The states that its residuals depend on.
  std::set<BlockKey> states(const SlidingWindow& window) const;

  /// Factors that are none of its residuals, in their order.
  const std::vector<const Factor*>& others() const { return others_; }

  /// The body's motion at a camera's image, as its factors say.
  const FrameMotion& motion(int camera) const { return motions_[static_cast<std::size_t>(camera)]; }

  /// LandmarkBlock::mean_square of all that have it, after a linearisation.
  ResidualLevels levels() const;

  double cost(const std::vector<CameraView>& views) const;
  double linearise(const std::vector<CameraView>& views);

  /// Of the residuals alone, landmarks held fixed: lower triangle of H.
  const CameraEquations& direct() const { return direct_; }

  /// Landmarks eliminated, `damping` times their diagonal added: lower triangle of H. Without damping, directions of a
  /// landmark that no residual sees are left out.
  const CameraEquations& eliminate(double damping);

  /// The landmarks' reaction to a step of the cameras; their part of the model's decrease.
  double backSubstitute(const Eigen::VectorXd& camera_step, double damping);

  /// How far away landmarks are [m]; infinite where there is none.
  double medianDistance(const Eigen::Vector3d& from_w) const;

  void apply(const ScaleStep& scale, std::vector<double>& saved);  ///< appends the former values
  std::size_t revert(const std::vector<double>& saved, std::size_t at);

 private:
  /// Landmarks of a kind that are eliminated.
  template <class Target>
  struct Landmarks {
    std::vector<LandmarkBlock<Target>> blocks;
    std::map<TrackId, std::size_t> places;
  };

  template <class Target>
  bool addSighting(SlidingWindow& window, const Factor& factor, const std::map<FrameId, int>& camera_of);
  template <class Target>
  LandmarkBlock<Target>& landmarkOf(SlidingWindow& window, TrackId id);
  int keep(SlidingWindow& window, const BlockKey& key);

  const double* correction_;
  std::vector<FrameMotion> motions_;
  std::vector<bool> seeing_;    ///< cameras with residuals
  std::set<BlockKey> staying_;  ///< points and lines that are not eliminated
  CameraLayout layout_;
  std::map<BlockKey, int> kept_places_;
  std::tuple<Landmarks<PointTarget>, Landmarks<LineTarget>> landmarks_;
  std::tuple<std::vector<KeptSighting<PointTarget>>, std::vector<KeptSighting<LineTarget>>,
             std::vector<KeptSighting<DirectionTarget>>>
      kept_;
  std::vector<const Factor*> others_;
  CameraEquations direct_, reduced_;
};

}  // namespace lintel
