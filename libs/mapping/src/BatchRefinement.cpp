// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/BatchRefinement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "AdjustedLandmarks.h"
#include "BatchProblem.h"
#include "CameraErrors.h"
#include "KeyframeClusters.h"
#include "LineGroups.h"
#include "MapFitting.h"
#include "RefinementCheck.h"
#include "SampleCorrection.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/FreeMemory.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/mapping/MapBuilder.h"

namespace lintel {

namespace {

// of the cost, for each coordinate of a pose: smaller steps are not worth an iteration. Landmarks are chosen and
// classified anew after every round but the last: those need not converge.
constexpr double kFirstGain = 0.1, kLastGain = 0.01;
constexpr double kUsualIterations = 12;  // of a round, at most; those for which the scale goes on are rare

/// Standard deviation of an accelerometer's scale, which no residual shows: a calibrated one's, or what its axes are
/// wrong by, where they show.
double sigmaOfAccelerometer(const Eigen::Matrix3d& axes) {
  constexpr double kCalibrated = 0.005;
  return std::max(kCalibrated, axes.norm() / std::sqrt(static_cast<double>(axes.size())));
}

/// The groups of the lines that would be drawn now.
std::vector<ParallelLines> parallelLines(const MapParams& params, const MapMaterial& material) {
  const LineMap map = drawMap(params, material);
  const std::vector<bool> certain = certainGroups(map);
  std::vector<ParallelLines> groups;
  for (const MapGroup& group : map.groups) groups.push_back({group.direction_w, sigmaOf(group), {}});
  auto drawn = map.lines.begin();
  for (std::size_t i = 0; i < material.lines.size() && drawn != map.lines.end(); ++i) {
    if (material.lines[i].id != drawn->id) continue;
    const auto group = static_cast<std::size_t>(drawn->group);
    if (drawn->group >= 0 && certain[group]) groups[group].lines.push_back(i);
    ++drawn;
  }
  groups.erase(std::remove_if(groups.begin(), groups.end(), [](const ParallelLines& g) { return g.lines.empty(); }),
               groups.end());
  return groups;
}

}  // namespace

BatchRefinement::BatchRefinement(const Rig& calibrated, const EstimatorParams& estimator, const MapParams& map,
                                 const RefinementParams& params)
    : calibrated_(calibrated),
      estimator_(paramsFor(calibrated.camera, estimator)),
      map_(scaledTo(calibrated.camera, map)),
      params_(scaledTo(calibrated.camera, params)) {
  checkRanges(estimator, "estimator.");
  checkRanges(map, "map.");
  checkRanges(params, "refinement.");
  estimator_.factors.point_sigma_px *= params.sigma_scale;
  estimator_.factors.line_sigma_px *= params.sigma_scale;
}

RefinementReport BatchRefinement::refine(MapMaterial& material, const RefinementProgress& progress,
                                         const std::vector<PointJoin>& joins,
                                         const std::function<void(MapMaterial&)>& place) const {
  RefinementReport report;
  MapMaterial refined = material;
  if (place) place(refined);
  if (material.keyframes.size() < 3) {
    report.verdict = "not refined: fewer than three keyframes";
  } else {
    report = adjust(refined, progress, joins);
    if (!report.accepted && !report.cancelled && (place || !joins.empty())) {
      refined = material;
      refined.pieces = separatePieces(material);  // nothing holds them to one another
      report = adjust(refined, progress, {});
      report.joins_refused = true;
    }
  }
  if (report.accepted) {
    correctSamples(refined.axes, refined.keyframes);
    refined.trajectory = refinedTrajectory(material, refined.keyframes);
    material = std::move(refined);
  } else {
    prepareMaterial(map_, material);
  }
  if (progress) progress(1);
  return report;
}

std::vector<CameraErrors> BatchRefinement::errorsOf(MapMaterial& material) const {
  constexpr double kInterval_s = 0.25;  // errors of poses change slowly: those between follow from their neighbours
  const AdjustedLandmarks used = landmarksToAdjust(material, params_);
  BatchProblem problem(calibrated_, estimator_, material,
                       fewAnchors(material.keyframes, (params_.most_keyframes + 1) / 2, kInterval_s), used.points,
                       used.lines, used.most_views, {}, params_);
  return problem.drawErrors();
}

RefinementReport BatchRefinement::adjust(MapMaterial& material, const RefinementProgress& progress,
                                         const std::vector<PointJoin>& joins) const {
  RefinementReport report;
  const MapMaterial before = camerasOf(material);
  material.axes.mean_f = meanSpecificForce(material.keyframes);
  const std::vector<PointRecord> held_out = takeHeldOut(params_.held_out_share, material.points);
  const auto goOn = [&](int round, int iteration) {
    const double done = round + std::min(1.0, iteration / std::min(kUsualIterations, 1.0 * params_.max_iterations));
    if (progress && !progress(done / params_.rounds) && done < params_.rounds) report.cancelled = true;
    return !report.cancelled;
  };
  for (int round = 0; round < params_.rounds; ++round) {
    const bool is_solved =
        goOn(round, 0) && adjustOnce(
                              round, joins, [&](int iteration) { return goOn(round, iteration); }, material, report);
    if (!is_solved || report.cancelled) {
      report.verdict =
          report.cancelled ? "not refined: the run was cancelled" : "not refined: the adjustment found no solution";
      return report;
    }
  }
  returnFreeMemory();
  judgeRefinement(before, held_out, material, estimator_, map_, params_, report);
  if (report.accepted) complete(held_out, material, report);
  return report;
}

bool BatchRefinement::adjustOnce(int round, const std::vector<PointJoin>& joins, const std::function<bool(int)>& goOn,
                                 MapMaterial& material, RefinementReport& report) const {
  returnFreeMemory();
  MapParams fit = map_;
  fit.view_max_error_px = params_.view_max_error_px;
  MapFitting fitting(fit, material);
  fitting.fitAll();
  // The causal poses drift: estimates of the same landmark coincide only after a first adjustment.
  // Passes that come closer now can be told apart better in the next round; the last one must be right.
  const bool last = round + 1 == params_.rounds;
  MergeAllowance allowance;
  if (!last) allowance.drift_px = map_.merge.max_drift_px;
  if (round > 0) report.merged += fitting.merge(allowance);
  const std::size_t separate = material.points.size();
  const double relative = round / std::max(1.0, params_.rounds - 1.0);
  report.joined =
      fitting.join(joins, params_.join_first_px * std::pow(params_.join_last_px / params_.join_first_px, relative),
                   params_.join_sigma_px);
  const AdjustedLandmarks used = landmarksToAdjust(material, params_);
  std::vector<ParallelLines> groups;
  if (round > 0 && params_.groups) groups = parallelLines(map_, material);
  returnFreeMemory();
  const bool few = material.keyframes.size() <= static_cast<std::size_t>(params_.most_keyframes);
  const int share = (last ? 1 : 2) * (few ? 1 : 2);
  const std::vector<Anchors> anchors = fewAnchors(material.keyframes, (params_.most_keyframes + share - 1) / share);
  BatchProblem problem(calibrated_, estimator_, material, anchors, used.points, used.lines, used.most_views, groups,
                       params_);
  if (round == 0) report.imu_before = problem.imuError();
  const auto summary = problem.solve(params_.max_iterations, last ? kLastGain : kFirstGain, goOn);
  if (report.cancelled || !summary.usable) return false;
  report.cost_before = summary.cost_before;
  report.cost_after = summary.cost_after;
  report.imu_after = problem.imuError();
  report.iterations += summary.iterations;
  report.residuals = summary.residuals;
  report.points = static_cast<std::size_t>(std::count(used.points.begin(), used.points.end(), true));
  report.lines = static_cast<std::size_t>(std::count(used.lines.begin(), used.lines.end(), true));
  problem.writeBack();
  material.points.resize(separate);
  ++report.rounds;
  return true;
}

void BatchRefinement::complete(const std::vector<PointRecord>& held_out, MapMaterial& material,
                               RefinementReport& report) const {
  material.points.insert(material.points.end(), held_out.begin(), held_out.end());
  std::sort(material.points.begin(), material.points.end(),
            [](const PointRecord& a, const PointRecord& b) { return a.id < b.id; });
  prepareMaterial(map_, material);
  material.camera_errors = errorsOf(material);
  report.axes = followedBy(calibrated_.axes.A, material.axes.A);
  report.gyro_axes = followedBy(calibrated_.axes.G, material.axes.G);
  report.verdict =
      formatted("refined: keyframes moved by up to %.3f m; points without part in it fit to %.2f px (before %.2f)",
                report.moved_m, report.held_out_after_px, report.held_out_before_px);
  if (material.camera_errors.empty()) return;
  report.scale_sigma = std::hypot(scaleSigma(material), sigmaOfAccelerometer(report.axes));
  report.verdict += formatted("; the size of everything is known to %.1f %%", 100 * report.scale_sigma);
}

}  // namespace lintel
