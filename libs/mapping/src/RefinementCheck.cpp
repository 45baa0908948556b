// SPDX-License-Identifier: BSD-3-Clause
#include "RefinementCheck.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "PointFitting.h"
#include "TrajectoryChange.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

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

/// Why the result must not be used; empty when it may.
std::string objection(const MapMaterial& after, const EstimatorParams& estimator, const RefinementParams& params,
                      const RefinementReport& report, double may_move_m) {
  if (!isFinite(after)) return "the adjustment diverged";
  if (!(report.cost_after <= report.cost_before)) return "the adjustment did not lower its cost";
  if (fitsWorse(report))
    return formatted("points left out of it fit worse (%.3f px, before %.3f px)", report.held_out_after_px,
                     report.held_out_before_px);
  if (report.imu_after > std::max(params.max_imu_error, report.imu_before))
    return formatted("the IMU contradicts it (%.1f standard deviations)", report.imu_after);
  if (report.moved_m > may_move_m) return formatted("a keyframe moved by %.2f m", report.moved_m);
  if (report.turned_rad > params.max_turned_rad) return formatted("a keyframe turned by %.3f rad", report.turned_rad);
  for (const RetiredKeyframe& k : after.keyframes)
    if (k.bias.accel.norm() > estimator.failure.max_bias_accel || k.bias.gyro.norm() > estimator.failure.max_bias_gyro)
      return "an IMU bias is implausible";
  return {};
}

}  // namespace

std::vector<PointRecord> takeHeldOut(double share, std::vector<PointRecord>& points) {
  const auto first =
      std::stable_partition(points.begin(), points.end(), [&](const PointRecord& p) { return !isHeldOut(p, share); });
  std::vector<PointRecord> held_out(std::make_move_iterator(first), std::make_move_iterator(points.end()));
  points.erase(first, points.end());
  return held_out;
}

MapMaterial camerasOf(const MapMaterial& material) {
  MapMaterial cameras;
  cameras.rig = material.rig;
  cameras.time_offset_s = material.time_offset_s;
  cameras.keyframes = material.keyframes;
  return cameras;
}

void judgeRefinement(const MapMaterial& before, const std::vector<PointRecord>& held_out, const MapMaterial& after,
                     const EstimatorParams& estimator, const MapParams& map, const RefinementParams& params,
                     RefinementReport& report) {
  double travelled_m = 0;
  measureChange(before, after, report, travelled_m);
  compareHeldOut(heldOutErrors(map, before, held_out, params.min_views),
                 heldOutErrors(map, after, held_out, params.min_views), report);
  const double may_move_m = params.max_moved_m + params.max_moved_share * travelled_m + blindDrift(before.keyframes);
  const std::string reason = objection(after, estimator, params, report, may_move_m);
  report.accepted = reason.empty();
  if (!report.accepted) report.verdict = "not refined: " + reason;
}

}  // namespace lintel
