// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <deque>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "CarriedView.h"
#include "KeyframeClusters.h"
#include "lintel/factors/AxesImuFactor.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/mapping/BatchRefinement.h"

namespace lintel {

/// Lines that share a direction: places in the material.
struct ParallelLines {
  Eigen::Vector3d direction_w = Eigen::Vector3d::UnitX();
  double sigma_rad = 0;  ///< how parallel they are
  std::vector<std::size_t> lines;
};

/// One adjustment as a Ceres problem: makes blocks and residuals from a material, solves, writes back.
///
/// Ceres orders blocks by their addresses: all lie in one array (points, lines, calibration, directions, keyframes in
/// their order), so that the same sums are made in the same order every run.
class BatchProblem {
 public:
  /// `use_point`, `use_line`: which landmarks take part, by place in the material; `most_views` of each have residuals.
  /// `groups` of parallel lines share a direction each. Keyframes that are not anchors are carried by theirs.
  BatchProblem(const Rig& calibrated, const EstimatorParams& estimator, MapMaterial& material,
               const std::vector<Anchors>& anchors, const std::vector<bool>& use_point,
               const std::vector<bool>& use_line, std::size_t most_views, const std::vector<ParallelLines>& groups,
               const RefinementParams& refinement);

  struct Summary {
    bool usable = false;
    int iterations = 0;
    std::size_t residuals = 0;
    double cost_before = 0, cost_after = 0;
  };
  /// Solves for anchors, calibration and landmarks; then for the keyframes between the anchors, all else held.
  /// Ends when an iteration lowers the cost by less than `least_gain` for each coordinate of the anchors' poses and
  /// changes the scale by less than a thousandth, or when `goOn`, called after every iteration with their number, says
  /// so. A cost is half of a chi-square: a gain of 1/2 moves a coordinate by a standard deviation. Compared with the
  /// cost itself, drift between visits of one place would not count on a long flight: it costs little beside the views
  /// of all landmarks.
  Summary solve(int max_iterations, double least_gain, const std::function<bool(int)>& goOn);

  /// Keyframes and calibration as solved, into the material. Landmarks are estimated anew by MapFitting.
  void writeBack();

  /// What the adjustment leaves open of the keyframes' cameras; empty when that cannot be said. Of a problem without
  /// groups, which it ends: nothing can be solved afterwards.
  std::vector<CameraErrors> drawErrors();

  /// RMS of the IMU residuals without the biases' walks, in standard deviations, at the blocks' present values.
  double imuError() const;

 private:
  double* at(std::size_t offset) { return values_.data() + offset; }
  void placeBlocks();
  void findStretches();
  void placeCorrections();
  void addCorrectionChanges();
  void writeBackOffsets();
  void addPriors();
  bool beginsWorld(FrameId keyframe) const;
  void countStamps(std::size_t from, std::size_t to, Preintegration& imu) const;
  void addImu();
  std::unique_ptr<AxesImuFactor> imuFactor(std::size_t k) const;
  void findMeanBiases();
  void placeMeanBiases();
  void addMeanBiasWalk();
  std::size_t mostViewsOf(const PointRecord& point) const;
  void addPoints();
  void addLines();
  void addGroups();
  template <class Target>
  void addView(ImageFactor<Target>& factor, ceres::LossFunction& loss, std::size_t keyframe, double* landmark);
  std::vector<CameraErrors> cameraErrors(const Eigen::MatrixXd& drawn, const std::vector<std::size_t>& anchors) const;
  std::vector<double*> blocksOfErrors(const std::vector<std::size_t>& anchors, std::vector<int>& tiles);
  std::pair<double, double> viewWeights(const std::vector<ceres::ResidualBlockId>& blocks) const;
  void release();
  bool isAnchor(std::size_t k) const;
  double anchorCount() const;

  /// From anchor to anchor where the IMU leads from one to the other, as the blocks have it [m], 3 x n.
  Eigen::Matrix3Xd wayOfAnchors() const;

  void findCarriages();
  void placeCarriageScales();
  void addCarriageScalePriors();
  void carryAlong();
  void settle();
  void settleBetween(std::size_t from, std::size_t to);
  Eigen::Vector3d originOf(FrameId keyframe) const;

  std::size_t stretches() const { return stretches_.empty() ? 1 : stretches_.back() + 1; }
  std::size_t correctionOf(std::size_t stretch) const { return correction_at_ + stretch * kCorrectionSize; }
  std::size_t correctionAt(std::size_t k) const { return correctionOf(stretches_[k]); }
  std::size_t meanBiases() const { return mean_biases_.empty() ? 0 : mean_biases_.back() + 1; }
  std::size_t meanBiasOf(std::size_t stretch) const { return mean_biases_at_ + stretch * kMeanBiasSize; }
  std::size_t meanBiasAt(std::size_t k) const { return meanBiasOf(mean_biases_[k]); }
  std::size_t carriageScales() const { return runs_.empty() ? 0 : runs_.back() + 1; }
  std::size_t carriageScaleOf(std::size_t run) const { return carriage_scales_at_ + run * kCarriageScaleSize; }
  std::size_t carriageScaleAt(std::size_t k) const { return carriageScaleOf(runs_[k]); }
  std::size_t poseAt(std::size_t k) const { return keyframes_at_ + k * (kPoseSize + kMotionSize); }
  std::size_t motionAt(std::size_t k) const { return poseAt(k) + kPoseSize; }

  static ceres::Problem::Options problemOptions();
  static StateManifold* poseManifold();

  /// A view from a keyframe that hangs on another one.
  struct CarriedResidual {
    ceres::CostFunction* factor;  ///< with the keyframe's own pose
    ceres::LossFunction* loss;
    std::size_t keyframe;
    double* landmark;
  };

  Rig calibrated_;
  const EstimatorParams& estimator_;
  MapMaterial& material_;
  const std::vector<Anchors> anchors_;
  std::vector<Carriage> carriages_;  // by place: how a keyframe hangs on its anchors; that of an anchor says nothing
  std::vector<std::size_t> runs_;  // along which the IMU leads, by place: each has a scale of the carriages of its own
  std::size_t most_views_;
  const RefinementParams& refinement_;
  std::vector<std::size_t> points_, lines_;  // places in the material
  std::vector<ParallelLines> groups_;
  std::vector<std::int64_t> keyframe_places_;  // by id
  std::vector<std::size_t> stretches_;         // of time, by place: each has a correction block of its own
  std::vector<std::size_t> mean_biases_;       // the same for mean biases
  std::vector<FrameMotion> motions_;           // by place
  std::vector<double> values_;
  std::size_t points_at_ = 0, lines_at_ = 0, extrinsics_at_ = 0, correction_at_ = 0, directions_at_ = 0,
              mean_biases_at_ = 0, axes_at_ = 0, carriage_scales_at_ = 0, keyframes_at_ = 0;

  ceres::CauchyLoss point_loss_, line_loss_, calibration_loss_, structural_loss_, offset_loss_;
  std::deque<PointFactor> point_factors_;
  std::deque<LineFactor> line_factors_;
  std::vector<std::unique_ptr<AxesImuFactor>> anchor_imu_factors_;  // from anchor to anchor
  std::vector<std::size_t> landmark_residuals_;  // the first residual block of each point, of each line; then the end
  std::vector<CarriedResidual> carried_views_;
  std::vector<std::unique_ptr<ceres::CostFunction>> own_factors_;  // the others
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace lintel
