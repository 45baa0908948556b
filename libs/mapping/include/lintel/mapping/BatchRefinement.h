// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/mapping/MapParams.h"
#include "lintel/mapping/PointJoin.h"

namespace lintel {

/// The batch adjustment after the causal pass.
struct RefinementParams {
  bool enabled = true;
  int rounds = 3;           ///< of: estimate and merge landmarks, adjust, reject outliers
  int max_iterations = 25;  ///< of a round
  /// So many are all adjusted in the last round; where there are more, half as many, spread in time. In the other
  /// rounds half of that. Those between are carried by them, and their views count. 0: all.
  int most_keyframes = 800;
  bool lines = true;   ///< lines have residuals too; off: they follow the poses
  bool groups = true;  ///< lines of a parallel group share a direction, as far as the group is parallel
  /// Standard deviations of points and lines against the window's, which are larger than its residuals because what it
  /// marginalises is never linearised again.
  double sigma_scale = 0.5;
  int min_views = 3;            ///< keyframes that see a landmark of the adjustment
  int max_views = 40;           ///< of a landmark that have residuals, spread over all it has; 0: all
  int most_residuals = 200000;  ///< views of all landmarks together; beyond it each has fewer; 0: all
  /// A view farther from its landmark has no residual. Wide: while poses are wrong, views that the right ones explain
  /// are pixels off, and without them nothing would mend the poses.
  double view_max_error_px = 10;
  double line_max_sigma_direction_rad = 0.10;  ///< vaguer lines have no residuals
  double line_max_relative_sigma = 0.10;       ///< of their distance
  // points that were seen again, see joinPoints()
  double join_sigma_px = 1;      ///< of a join, at least, beside that of the views
  double join_first_px = 30;     ///< two visits of a point may be so far apart in the images in the first round, and
  double join_last_px = 3;       ///< so far in the last one
  double held_out_share = 0.05;  ///< of the points: left out, to check the result with
  /// By how much the offset between the clocks of camera and IMU changes within a second, standard deviation; it may
  /// jump by more. 0: never.
  double offset_walk_s = 3e-4;
  // acceptance
  double max_moved_share = 1;  ///< keyframes may move by this share of the way travelled, and
  double max_moved_m = 0.30;   ///< this much more
  double max_turned_rad = 0.15;
  double max_imu_error = 3.0;  ///< RMS of the IMU's residuals in standard deviations; or no worse than before

  template <class F>
  void fields(F&& field) {
    field("enabled", enabled);
    field("rounds", rounds, Range{1, 100});
    field("max_iterations", max_iterations, Range{1, 1000});
    field("most_keyframes", most_keyframes, Range{0, 1000000});
    field("lines", lines);
    field("groups", groups);
    field("sigma_scale", sigma_scale, Range{0.01, 100});
    field("min_views", min_views, Range{2, 1000});
    field("max_views", max_views, Range{0, 100000});
    field("most_residuals", most_residuals, Range{0, 100000000});
    field("view_max_error_px", view_max_error_px, ReferencePixels{0.1, 1000});
    field("line_max_sigma_direction_rad", line_max_sigma_direction_rad, Range{0.0001, 10});
    field("line_max_relative_sigma", line_max_relative_sigma, Range{0.0001, 100});
    field("join_sigma_px", join_sigma_px, Range{0.01, 100});
    field("join_first_px", join_first_px, ReferencePixels{0.1, 1000});
    field("join_last_px", join_last_px, ReferencePixels{0.1, 1000});
    field("held_out_share", held_out_share, Range{0, 0.5});
    field("offset_walk_s", offset_walk_s, Range{0, 1});
    field("max_moved_share", max_moved_share, Range{0, 10});
    field("max_moved_m", max_moved_m, Range{0, 1000});
    field("max_turned_rad", max_turned_rad, Range{0, 3.2});
    field("max_imu_error", max_imu_error, Range{0.1, 1000});
  }
};

/// What a refinement did, and whether it may be used.
struct RefinementReport {
  bool accepted = false, cancelled = false;
  bool joins_refused = false;  ///< the checks failed with joins and another start; this is the result without
  std::string verdict;         ///< in words: why, or why not
  int rounds = 0, iterations = 0, merged = 0;
  int joined = 0;  ///< of the points that were seen again, those that are one point in the last round
  std::size_t residuals = 0, points = 0, lines = 0;
  double cost_before = 0, cost_after = 0;                ///< robust, of the last adjustment's residuals
  double held_out_before_px = 0, held_out_after_px = 0;  ///< median error of points left out of it
  std::size_t held_out = 0;                              ///< how many these are
  double held_out_growth = 0;  ///< of their errors, in standard deviations of its mean; 0 with fewer than three
  double imu_before = 0, imu_after = 0;            ///< RMS, standard deviations
  double moved_m = 0, turned_rad = 0;              ///< most, of a keyframe, beside what all of its world have in common
  double least_offset_s = 0, most_offset_s = 0;    ///< of the keyframes, between the clocks, beside their mean
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();  ///< A of Rig::axes, as it should be
  Eigen::Matrix3d gyro_axes = Eigen::Matrix3d::Zero();  ///< G of Rig::axes, as it should be
  double scale_sigma = 0;  ///< relative standard deviation of the size of everything: by what the residuals leave open,
                           ///< and by the accelerometer's own scale
};

/// Called at every iteration with the share that is done, in [0, 1]. Its result below 1 says whether to go on: after
/// `false` the refinement is not accepted.
using RefinementProgress = std::function<bool(double)>;

/// Full adjustment over all keyframes: poses, velocities, biases, calibration, points and lines; IMU between
/// consecutive keyframes; robust losses. Landmarks found to be the same are joined between the rounds, which
/// constrains the trajectory where a place was seen again. Deterministic; one thread.
///
/// The result is checked (report.accepted): cost, points left out of the adjustment, IMU residuals, plausible
/// changes. When it is not accepted the caller keeps the former estimate.
class BatchRefinement {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range. `calibrated`: the rig as calibrated,
  /// before any estimate; its priors hold the calibration.
  BatchRefinement(const Rig& calibrated, const EstimatorParams& estimator, const MapParams& map,
                  const RefinementParams& params);

  /// Refines `material` (as MapBuilder::material() gives it): keyframes, calibration, landmarks, trajectory. When the
  /// checks fail, only its landmarks are estimated, with the poses as they were. `joins`: points that were probably
  /// seen again; `place` moves keyframes, landmarks and trajectory to where the adjustment shall start. When the
  /// checks fail with these, it is tried without.
  RefinementReport refine(MapMaterial& material, const RefinementProgress& progress = {},
                          const std::vector<PointJoin>& joins = {},
                          const std::function<void(MapMaterial&)>& place = {}) const;

 private:
  std::vector<CameraErrors> errorsOf(MapMaterial& material) const;
  RefinementReport adjust(MapMaterial& material, const RefinementProgress& progress,
                          const std::vector<PointJoin>& joins) const;
  /// One round; false: no solution, or `goOn` ended it.
  bool adjustOnce(int round, const std::vector<PointJoin>& joins, const std::function<bool(int)>& goOn,
                  MapMaterial& material, RefinementReport& report) const;
  /// Landmarks, those held out too, and errors of the cameras of a result that is used.
  void complete(const std::vector<PointRecord>& held_out, MapMaterial& material, RefinementReport& report) const;

  Rig calibrated_;
  EstimatorParams estimator_;
  MapParams map_;
  RefinementParams params_;
};

/// The refined pose of every frame of `causal.trajectory`: between two keyframes the IMU carries the refined state on,
/// and what is missing at the next keyframe is spread over the interval (cubic: position and velocity meet at both
/// ends); elsewhere frames move with the nearest keyframe.
std::vector<std::pair<std::int64_t, Pose>> refinedTrajectory(const MapMaterial& causal,
                                                             const std::vector<RetiredKeyframe>& refined);

}  // namespace lintel
