// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lintel/evaluation/Statistics.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/geometry/Alignment.h"

namespace lintel {

struct TrajectoryErrorParams {
  AlignmentKind alignment = AlignmentKind::kSe3;
  double max_difference_s = 0.01;  ///< a pose and its true partner are at most so far apart in time [s]
  double max_gap_s = 1.0;          ///< time between neighbouring poses that still counts as covered [s]
  double start_allowance_s = 1.0;  ///< time that any visual-inertial estimate needs before its first pose [s]
  double complete_share = 0.9;     ///< a run that covers less of the duration after that time counts as incomplete
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();  ///< the ground truth before it does not count
  std::int64_t to_ns = std::numeric_limits<std::int64_t>::max();    ///< the ground truth after it does not count
  double max_overshoot = 0.2;  ///< a stretch of the path may be longer than asked for by this share
  std::vector<double> distances_m = {1, 2, 5, 10, 20};  ///< lengths of the stretches of the relative errors [m]
};

/// Indices of an estimated pose and of the true pose nearest to it in time.
struct PosePair {
  std::size_t estimate = 0, groundtruth = 0;
};

/// For every estimated pose the nearest true one in time (of two equally near, the earlier one), if there is one
/// within `max_difference_s`.
std::vector<PosePair> associate(const StampedPoses& estimate, const StampedPoses& groundtruth, double max_difference_s);

/// How far the estimated motion over stretches of the true path differs from the true motion, seen from the start of
/// each stretch: (T_w_b0⁻¹ T_w_b1)_true⁻¹ (T_w_b0⁻¹ T_w_b1)_estimated [Geiger2012]. Every pair starts a stretch.
struct RelativeErrors {
  double distance_m = 0;    ///< length of the stretches along the true path
  bool whole_path = false;  ///< the one stretch from the first pair to the last
  ErrorStatistics translation_m;
  ErrorStatistics rotation_rad;
};

/// How far an estimate is from the truth.
struct TrajectoryErrors {
  std::size_t poses = 0;  ///< estimated
  std::size_t pairs = 0;  ///< of these with a true partner
  AlignmentKind alignment = AlignmentKind::kSe3;
  Similarity S_truth_estimate;        ///< the alignment that the errors below are taken after
  ErrorStatistics position_m;         ///< ATE
  ErrorStatistics rotation_rad;       ///< angle between orientations; meaningful if both are of the same body frame
  double scale = 1;                   ///< of the Sim(3) alignment: truth / estimate; 1 = right
  ErrorStatistics position_sim3_m;    ///< ATE after Sim(3) alignment
  double start_offset_s = 0;          ///< first pair after the start of the ground truth
  double duration_s = 0, path_m = 0;  ///< of the whole ground truth
  double coverage_time = 0;  ///< share of the ground truth's duration between neighbouring pairs (gaps left out)
  double coverage_path = 0;  ///< share of the ground truth's path between neighbouring pairs (gaps left out)
  bool complete = false;     ///< covers at least `complete_share` of what can be covered: comparable with others
  /// RMSE over the whole duration of the ground truth [m]: where there is no estimate, the one nearest in time stands
  /// in. What a run leaves out adds the vehicle's motion meanwhile, so that stopping early does not lower the error.
  double whole_rmse_m = 0;
  std::vector<RelativeErrors> relative;                 ///< one for each distance, then the whole path
  std::vector<std::pair<std::int64_t, double>> series;  ///< (time [ns], position error [m]) of every pair
};

/// Throws EvaluationError when fewer than three poses have a true partner.
TrajectoryErrors evaluateTrajectory(const StampedPoses& estimate, const StampedPoses& groundtruth,
                                    const TrajectoryErrorParams& params = {});

}  // namespace lintel
