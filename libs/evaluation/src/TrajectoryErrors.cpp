// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrajectoryErrors.h"

#include <algorithm>
#include <cmath>

#include "RelativeErrors.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

struct Positions {
  std::vector<Eigen::Vector3d> estimate, truth;
};

Positions positionsOf(const StampedPoses& estimate, const StampedPoses& groundtruth,
                      const std::vector<PosePair>& pairs) {
  Positions positions;
  for (const PosePair& pair : pairs) {
    positions.estimate.push_back(estimate[pair.estimate].second.p);
    positions.truth.push_back(groundtruth[pair.groundtruth].second.p);
  }
  return positions;
}

std::vector<double> distancesAfter(const Similarity& S_truth_estimate, const Positions& positions) {
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < positions.truth.size(); ++i)
    distances_m.push_back((S_truth_estimate * positions.estimate[i] - positions.truth[i]).norm());
  return distances_m;
}

/// Fills in what part of the ground truth the estimate covers: between neighbouring pairs, unless they are far apart.
void addCoverage(TrajectoryErrors& result, const StampedPoses& groundtruth, const std::vector<PosePair>& pairs,
                 double max_gap_s) {
  std::vector<double> path_m(groundtruth.size(), 0.0);
  for (std::size_t i = 1; i < groundtruth.size(); ++i)
    path_m[i] = path_m[i - 1] + (groundtruth[i].second.p - groundtruth[i - 1].second.p).norm();
  result.duration_s = seconds(groundtruth.back().first - groundtruth.front().first);
  result.path_m = path_m.back();
  result.start_offset_s = seconds(groundtruth[pairs.front().groundtruth].first - groundtruth.front().first);
  double covered_s = 0, covered_m = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const std::size_t from = pairs[i - 1].groundtruth, to = pairs[i].groundtruth;
    const double gap_s = seconds(groundtruth[to].first - groundtruth[from].first);
    if (gap_s > max_gap_s) continue;
    covered_s += gap_s;
    covered_m += path_m[to] - path_m[from];
  }
  if (result.duration_s > 0) result.coverage_time = covered_s / result.duration_s;
  if (result.path_m > 0) result.coverage_path = covered_m / result.path_m;
}

/// The alignment's error at every true pose: that of its pair, or where no pair is near in time, that of the estimate
/// nearest in time held still. Weighted by the time that a true pose stands for.
double wholeRmse(const Similarity& S_truth_estimate, const StampedPoses& estimate, const StampedPoses& groundtruth,
                 const std::vector<PosePair>& pairs, double max_gap_s) {
  double sum = 0, duration_s = 0;
  std::size_t next = 0;  // the first pair at or after the true pose
  for (std::size_t i = 0; i < groundtruth.size(); ++i) {
    while (next < pairs.size() && pairs[next].groundtruth < i) ++next;
    const PosePair* after = next < pairs.size() ? &pairs[next] : nullptr;
    const PosePair* before = next > 0 ? &pairs[next - 1] : nullptr;
    const auto timeTo = [&](const PosePair* pair) {
      return std::abs(seconds(groundtruth[pair->groundtruth].first - groundtruth[i].first));
    };
    const PosePair* nearest = !after || (before && timeTo(before) <= timeTo(after)) ? before : after;
    const bool covered = before && after && timeTo(before) + timeTo(after) <= max_gap_s;
    const std::size_t truth = covered || nearest->groundtruth == i ? nearest->groundtruth : i;
    const double error_m =
        (S_truth_estimate * estimate[nearest->estimate].second.p - groundtruth[truth].second.p).norm();
    const std::size_t from = i > 0 ? i - 1 : i, to = std::min(i + 1, groundtruth.size() - 1);
    const double weight_s = 0.5 * seconds(groundtruth[to].first - groundtruth[from].first);
    sum += weight_s * error_m * error_m;
    duration_s += weight_s;
  }
  return duration_s > 0 ? std::sqrt(sum / duration_s) : 0;
}

StampedPoses between(const StampedPoses& poses, std::int64_t from_ns, std::int64_t to_ns) {
  StampedPoses part;
  for (const auto& pose : poses)
    if (pose.first >= from_ns && pose.first <= to_ns) part.push_back(pose);
  return part;
}

/// Fills in what needs orientations: rotation errors after alignment, and relative errors.
void addPoseErrors(TrajectoryErrors& result, const StampedPoses& estimate, const StampedPoses& groundtruth,
                   const std::vector<PosePair>& pairs, const TrajectoryErrorParams& params) {
  std::vector<PartneredPose> poses;
  std::vector<double> rotations_rad;
  for (const PosePair& pair : pairs) {
    Pose T_e_b = estimate[pair.estimate].second;
    T_e_b.p *= result.S_truth_estimate.scale;
    const Pose& T_w_b = groundtruth[pair.groundtruth].second;
    poses.push_back({T_e_b, T_w_b});
    rotations_rad.push_back(logRotation(T_w_b.q.conjugate() * result.S_truth_estimate.T_a_b.q * T_e_b.q).norm());
  }
  result.rotation_rad = statisticsOf(rotations_rad);
  result.relative = relativeErrors(poses, params);
}

}  // namespace

std::vector<PosePair> associate(const StampedPoses& estimate, const StampedPoses& groundtruth,
                                double max_difference_s) {
  std::vector<PosePair> pairs;
  const std::int64_t max_difference_ns = std::llround(max_difference_s * 1e9);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::int64_t t_ns = estimate[i].first;
    const auto after = std::lower_bound(groundtruth.begin(), groundtruth.end(), t_ns,
                                        [](const auto& stamped, std::int64_t t) { return stamped.first < t; });
    auto nearest = after;
    if (after == groundtruth.end() ||
        (after != groundtruth.begin() && t_ns - std::prev(after)->first <= after->first - t_ns)) {
      if (after == groundtruth.begin()) break;  // no ground truth at all
      nearest = std::prev(after);
    }
    if (std::abs(nearest->first - t_ns) <= max_difference_ns)
      pairs.push_back({i, static_cast<std::size_t>(nearest - groundtruth.begin())});
  }
  return pairs;
}

TrajectoryErrors evaluateTrajectory(const StampedPoses& estimate, const StampedPoses& whole_groundtruth,
                                    const TrajectoryErrorParams& params) {
  const StampedPoses groundtruth = between(whole_groundtruth, params.from_ns, params.to_ns);
  const std::vector<PosePair> pairs = associate(estimate, groundtruth, params.max_difference_s);
  if (pairs.size() < 3)
    throw EvaluationError("only " + std::to_string(pairs.size()) + " of " + std::to_string(estimate.size()) +
                          " poses have a ground truth within " + std::to_string(params.max_difference_s) +
                          " s; give two files of the same recording");
  const Positions positions = positionsOf(estimate, groundtruth, pairs);

  TrajectoryErrors result;
  result.poses = estimate.size();
  result.pairs = pairs.size();
  result.alignment = params.alignment;
  result.S_truth_estimate = alignPositions(params.alignment, positions.estimate, positions.truth);
  const std::vector<double> errors_m = distancesAfter(result.S_truth_estimate, positions);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    result.series.emplace_back(estimate[pairs[i].estimate].first, errors_m[i]);
  result.position_m = statisticsOf(errors_m);

  const Similarity sim3 = alignPositions(AlignmentKind::kSim3, positions.estimate, positions.truth);
  result.scale = sim3.scale;
  result.position_sim3_m = statisticsOf(distancesAfter(sim3, positions));
  addCoverage(result, groundtruth, pairs, params.max_gap_s);
  const double possible_s = std::max(0.0, result.duration_s - params.start_allowance_s);
  result.complete = result.coverage_time * result.duration_s >= params.complete_share * possible_s;
  result.whole_rmse_m = wholeRmse(result.S_truth_estimate, estimate, groundtruth, pairs, params.max_gap_s);
  addPoseErrors(result, estimate, groundtruth, pairs, params);
  return result;
}

}  // namespace lintel
