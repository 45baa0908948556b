// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/BatchRefinement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "BatchProblem.h"
#include "CameraErrors.h"
#include "Evidence.h"
#include "KeyframeClusters.h"
#include "LineGroups.h"
#include "MapFitting.h"
#include "SampleCorrection.h"
#include "TrajectoryChange.h"
#include "lintel/core/FreeMemory.h"
#include "lintel/core/Quantiles.h"
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

/// Without landmarks, which are most of a material.
MapMaterial camerasOf(const MapMaterial& material) {
  MapMaterial cameras;
  cameras.rig = material.rig;
  cameras.time_offset_s = material.time_offset_s;
  cameras.keyframes = material.keyframes;
  return cameras;
}

/// Whether a point track is held out: every n-th is left out of the adjustment, and its error shows how good that is.
bool isHeldOut(const PointRecord& point, double share) {
  const auto period = static_cast<std::uint64_t>(std::lround(1 / std::max(share, 1e-6)));
  return share > 0 && point.id % std::max<std::uint64_t>(2, period) == 1;
}

/// Mean error of each held-out point, estimated with the given cameras.
std::vector<double> heldOutErrors(const MapParams& map, const MapMaterial& cameras_of, std::vector<PointRecord> points,
                                  int min_views) {
  const KeyframeCameras cameras(cameras_of);
  PointFitParams fit;
  fit.max_error_px = 1e3;  // all views count: marking views as outliers must not lower the error
  fit.min_depth_m = map.min_depth_m;
  std::vector<double> errors;
  for (PointRecord& point : points) {
    if (static_cast<int>(point.views.size()) < min_views) continue;
    point.known = false;
    errors.push_back(fitPoint(cameras, fit, point) ? point.error_px : fit.max_error_px);
  }
  return errors;
}

/// How the held-out points fit before and after: medians, and by how many of its own standard deviations the mean
/// logarithm of the errors has grown.
void compareHeldOut(const std::vector<double>& before_px, const std::vector<double>& after_px,
                    RefinementReport& report) {
  constexpr double kFloor_px = 0.1;  // below it a ratio of errors says nothing
  const std::size_t n = before_px.size();
  if (n == 0) return;
  const auto median = [](std::vector<double> errors) { return upperMedian(errors); };
  report.held_out = n;
  report.held_out_before_px = median(before_px);
  report.held_out_after_px = median(after_px);
  double sum = 0, sum_of_squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double growth = std::log((after_px[i] + kFloor_px) / (before_px[i] + kFloor_px));
    sum += growth;
    sum_of_squares += growth * growth;
  }
  const auto count = static_cast<double>(n);
  const double mean = sum / count, variance = (sum_of_squares - count * mean * mean) / std::max(1.0, count - 1);
  report.held_out_growth = n < 3 ? 0 : mean / std::sqrt(std::max(variance, 1e-12) / count);
}

/// Whether the held-out points fit worse by more than chance explains (one adjustment of forty that changes nothing).
bool fitsWorse(const RefinementReport& report) {
  return report.held_out_after_px > 1.02 * report.held_out_before_px + 0.01 && report.held_out_growth > 2;
}

void measureChange(const MapMaterial& before, const MapMaterial& after, RefinementReport& report, double& travelled_m) {
  const TrajectoryChange change = trajectoryChange(before.keyframes, after.keyframes, after.pieces);
  report.moved_m = change.moved_m;
  report.turned_rad = change.turned_rad;
  travelled_m = change.travelled_m;
  for (const RetiredKeyframe& k : after.keyframes) {
    report.least_offset_s = std::min(report.least_offset_s, k.offset_change_s);
    report.most_offset_s = std::max(report.most_offset_s, k.offset_change_s);
  }
}

/// How far the IMU alone may have led the causal trajectory astray where it saw nothing.
double blindDrift(const std::vector<RetiredKeyframe>& keyframes) {
  constexpr double kUnknownAcceleration_m_s2 = 0.1;  // a bias of 0.05, and half a degree of tilt
  double drift_m = 0, blind_s = 0;
  for (const RetiredKeyframe& keyframe : keyframes) {
    if (keyframe.blind && keyframe.imu) {
      blind_s += keyframe.imu->dt_s();
    } else {
      drift_m += 0.5 * kUnknownAcceleration_m_s2 * blind_s * blind_s;
      blind_s = 0;
    }
  }
  return drift_m;
}

bool isFinite(const MapMaterial& material) {
  return material.rig.T_b_c.p.allFinite() && std::isfinite(material.rig.camera.fx) &&
         std::all_of(material.keyframes.begin(), material.keyframes.end(), [](const RetiredKeyframe& k) {
           return k.T_w_b.p.allFinite() && k.T_w_b.q.coeffs().allFinite() && k.v_w_b.allFinite();
         });
}

/// Takes out of the points those that are left out of the adjustment.
std::vector<PointRecord> takeHeldOut(double share, std::vector<PointRecord>& points) {
  const auto first =
      std::stable_partition(points.begin(), points.end(), [&](const PointRecord& p) { return !isHeldOut(p, share); });
  std::vector<PointRecord> held_out(std::make_move_iterator(first), std::make_move_iterator(points.end()));
  points.erase(first, points.end());
  return held_out;
}

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

/// Why the result must not be used; empty when it may.
std::string objection(const MapMaterial& after, const EstimatorParams& estimator, const RefinementParams& params,
                      const RefinementReport& report, double may_move_m) {
  if (!isFinite(after)) return "the adjustment diverged";
  if (!(report.cost_after <= report.cost_before)) return "the adjustment did not lower its cost";
  if (fitsWorse(report))
    return text("points left out of it fit worse (%.3f px, before %.3f px)", report.held_out_after_px,
                report.held_out_before_px);
  if (report.imu_after > std::max(params.max_imu_error, report.imu_before))
    return text("the IMU contradicts it (%.1f standard deviations)", report.imu_after);
  if (report.moved_m > may_move_m) return text("a keyframe moved by %.2f m", report.moved_m);
  if (report.turned_rad > params.max_turned_rad) return text("a keyframe turned by %.3f rad", report.turned_rad);
  for (const RetiredKeyframe& k : after.keyframes)
    if (k.bias.accel.norm() > estimator.failure.max_bias_accel || k.bias.gyro.norm() > estimator.failure.max_bias_gyro)
      return "an IMU bias is implausible";
  return {};
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

BatchRefinement::Used BatchRefinement::usedOf(const MapMaterial& material) const {
  Used used;
  for (const PointRecord& p : material.points) used.points.push_back(p.known && inliersOf(p) >= params_.min_views);
  for (const LineRecord& l : material.lines)
    used.lines.push_back(params_.lines && l.known && keyframesOf(l) >= params_.min_views &&
                         l.estimate.sigmaDirection() <= params_.line_max_sigma_direction_rad &&
                         l.estimate.sigmaPosition(0) <= params_.line_max_relative_sigma * l.distance_m);
  takeFewer(material, used);
  return used;
}

/// Where there are so many landmarks that each could have too few views, every n-th takes part, and the points that
/// were seen again.
void BatchRefinement::takeFewer(const MapMaterial& material, Used& used) const {
  if (params_.most_residuals == 0) return;
  const auto count = static_cast<std::size_t>(std::count(used.points.begin(), used.points.end(), true) +
                                              std::count(used.lines.begin(), used.lines.end(), true));
  const std::size_t n =
      1 + count * static_cast<std::size_t>(params_.min_views) / static_cast<std::size_t>(params_.most_residuals);
  std::size_t at = 0;
  for (std::size_t i = 0; i < used.points.size(); ++i)
    if (used.points[i] && material.points[i].extra_sigma_px == 0) used.points[i] = at++ % n == 0;
  for (std::size_t i = 0; i < used.lines.size(); ++i)
    if (used.lines[i]) used.lines[i] = at++ % n == 0;
}

/// The most views of a landmark that may have residuals, so that all together keep to `most_residuals`. Views of
/// landmarks grow with the time at a place, what they tell about it hardly.
std::size_t BatchRefinement::viewsEach(const MapMaterial& material, const Used& used) const {
  const auto most_views = static_cast<std::size_t>(params_.max_views);
  if (params_.most_residuals == 0) return most_views;
  std::vector<std::size_t> views;
  const auto add = [&](int inliers) {
    const auto n = static_cast<std::size_t>(inliers);
    views.push_back(most_views == 0 ? n : std::min(n, most_views));
  };
  for (std::size_t i = 0; i < material.points.size(); ++i)
    if (used.points[i]) add(inliersOf(material.points[i]));
  for (std::size_t i = 0; i < material.lines.size(); ++i)
    if (used.lines[i]) add(inliersOf(material.lines[i]));
  std::sort(views.begin(), views.end());
  auto left = static_cast<std::size_t>(params_.most_residuals);
  for (std::size_t n = 0; n < views.size(); ++n) {  // the shortest tracks have all, the others share what is left
    const std::size_t share = left / (views.size() - n);
    if (views[n] > share) return std::max(share, static_cast<std::size_t>(params_.min_views));
    left -= views[n];
  }
  return most_views;
}

std::vector<CameraErrors> BatchRefinement::errorsOf(MapMaterial& material) const {
  constexpr double kInterval_s = 0.25;  // errors of poses change slowly: those between follow from their neighbours
  const Used used = usedOf(material);
  BatchProblem problem(calibrated_, estimator_, material,
                       fewAnchors(material.keyframes, (params_.most_keyframes + 1) / 2, kInterval_s), used.points,
                       used.lines, viewsEach(material, used), {}, params_);
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
  judge(before, held_out, material, report);
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
  if (round > 0) report.merged += fitting.merge(last ? 0 : map_.merge.max_drift_px);
  const std::size_t separate = material.points.size();
  const double relative = round / std::max(1.0, params_.rounds - 1.0);
  report.joined =
      fitting.join(joins, params_.join_first_px * std::pow(params_.join_last_px / params_.join_first_px, relative),
                   params_.join_sigma_px);
  const Used used = usedOf(material);
  std::vector<ParallelLines> groups;
  if (round > 0 && params_.groups) groups = parallelLines(map_, material);
  returnFreeMemory();
  const bool few = material.keyframes.size() <= static_cast<std::size_t>(params_.most_keyframes);
  const int share = (last ? 1 : 2) * (few ? 1 : 2);
  const std::vector<Anchors> anchors = fewAnchors(material.keyframes, (params_.most_keyframes + share - 1) / share);
  BatchProblem problem(calibrated_, estimator_, material, anchors, used.points, used.lines, viewsEach(material, used),
                       groups, params_);
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

void BatchRefinement::judge(const MapMaterial& before, const std::vector<PointRecord>& held_out,
                            const MapMaterial& material, RefinementReport& report) const {
  double travelled_m = 0;
  measureChange(before, material, report, travelled_m);
  compareHeldOut(heldOutErrors(map_, before, held_out, params_.min_views),
                 heldOutErrors(map_, material, held_out, params_.min_views), report);
  const double may_move_m = params_.max_moved_m + params_.max_moved_share * travelled_m + blindDrift(before.keyframes);
  const std::string reason = objection(material, estimator_, params_, report, may_move_m);
  report.accepted = reason.empty();
  if (!report.accepted) report.verdict = "not refined: " + reason;
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
      text("refined: keyframes moved by up to %.3f m; points without part in it fit to %.2f px (before %.2f)",
           report.moved_m, report.held_out_after_px, report.held_out_before_px);
  if (material.camera_errors.empty()) return;
  report.scale_sigma = std::hypot(scaleSigma(material), sigmaOfAccelerometer(report.axes));
  report.verdict += text("; the size of everything is known to %.1f %%", 100 * report.scale_sigma);
}

}  // namespace lintel
