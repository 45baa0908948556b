// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/RunStatistics.h"

#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/LensNames.h"

namespace lintel {

namespace {

using Json = nlohmann::ordered_json;

Json stageJson(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  const auto quantile = [&](double q) {
    return ms.empty() ? 0 : ms[std::min(ms.size() - 1, static_cast<std::size_t>(q * static_cast<double>(ms.size())))];
  };
  double sum = 0;
  for (const double v : ms) sum += v;
  return {{"count", ms.size()},
          {"mean_ms", ms.empty() ? 0 : sum / static_cast<double>(ms.size())},
          {"median_ms", quantile(0.5)},
          {"p95_ms", quantile(0.95)},
          {"max_ms", ms.empty() ? 0 : ms.back()}};
}

Json stagesJson(const OdometryStatistics& s) {
  Json stages{{"decoding", stageJson(s.decoding.ms())},
              {"tracking", stageJson(s.tracking.ms())},
              {"estimation", stageJson(s.estimation.ms())},
              {"mapping", stageJson(s.mapping.ms())},
              {"loops", stageJson(s.loops.ms())},
              {"map fitting", stageJson(s.map_fitting.ms())},
              {"refinement", stageJson(s.refinement.ms())},
              {"edges", stageJson(s.edges.ms())},
              {"densification", stageJson(s.densification.ms())}};
  for (const auto& [name, times] : s.front_end.stages)
    stages["tracking: " + name] = stageJson(std::vector<double>(times.ms.begin(), times.ms.end()));
  return stages;
}

Json trackingJson(const FrontEndStatistics& f) {
  return {{"points",
           {{"tracked", f.points.tracked},
            {"detected", f.points.detected},
            {"lost_klt", f.points.lost_klt},
            {"lost_backward", f.points.lost_backward},
            {"lost_epipolar", f.points.lost_epipolar},
            {"median_length", f.points.lifetimes.median()}}},
          {"lines",
           {{"tracked", f.lines.tracked},
            {"created", f.lines.created},
            {"detections", f.lines.detections},
            {"merged", f.lines.merged},
            {"share_seen_in_10_frames", f.lines.lifetimes.shareOfAtLeast(10)},
            {"median_length", f.lines.lifetimes.median()}}},
          {"images_without_contrast", f.images_without_contrast},
          {"images_repeated", f.images_repeated},
          {"vehicle_share", f.vehicle_share}};
}

Json blindJson(const OdometryStatistics& s) {
  Json stretches = Json::array();
  for (const Stretch& blind : s.blind) stretches.push_back({blind.from_s, blind.to_s});
  return stretches;
}

/// Stretches between interruptions of the estimate; those of one world are in one frame.
Json piecesJson(const OdometryResult& result) {
  Json pieces = Json::array();
  const auto seconds = [&](std::int64_t t_ns) {
    return 1e-9 * static_cast<double>(t_ns - result.statistics.first_frame_ns);
  };
  for (const MapPiece& piece : result.map.pieces)
    pieces.push_back({{"from_s", seconds(piece.first_ns)}, {"to_s", seconds(piece.last_ns)}, {"frame", piece.world}});
  return pieces;
}

Json loopsJson(const OdometryResult& result) {
  const LoopResult& loops = result.loops;
  std::size_t accepted = 0;
  Json refused = Json::object();
  for (const PlacePair& pair : loops.places.pairs) {
    if (pair.refusal.empty())
      ++accepted;
    else
      refused[pair.refusal] = refused.value(pair.refusal, 0) + 1;
  }
  const auto median = [](std::vector<double> values) { return values.empty() ? Json() : Json(upperMedian(values)); };
  return {{"searched", loops.searched},
          {"frames_described", loops.places.described},
          {"pairs", accepted},
          {"pairs_refused", refused},
          {"points", loops.places.same.size()},
          {"points_joined", result.refinement.joined},
          {"refused_by_refinement", result.refinement.joins_refused},
          {"median_drift_m", {median(loops.drift_before_m), median(loops.drift_after_m)}}};
}

/// Row by row.
Json axesJson(const Eigen::Matrix3d& A) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({A(row, 0), A(row, 1), A(row, 2)});
  return rows;
}

Json refinementJson(const OdometryResult& result) {
  const RefinementReport& r = result.refinement;
  return {{"accepted", r.accepted},
          {"verdict", r.verdict.empty() ? "left out" : r.verdict},
          {"poses", result.refined_trajectory.size()},
          {"iterations", r.iterations},
          {"residuals", r.residuals},
          {"points", r.points},
          {"lines", r.lines},
          {"landmarks_joined", r.merged},
          {"cost", {r.cost_before, r.cost_after}},
          {"held_out_points_px", {r.held_out_before_px, r.held_out_after_px}},
          {"imu_sigmas", {r.imu_before, r.imu_after}},
          {"moved_m", r.moved_m},
          {"turned_rad", r.turned_rad},
          {"scale_sigma", r.scale_sigma},
          {"accelerometer_axes", axesJson(r.axes)},
          {"gyroscope_axes", axesJson(r.gyro_axes)},
          {"time_offset_change_s", {r.least_offset_s, r.most_offset_s}}};
}

Json densificationJson(const DensifyReport& d) {
  return {{"images", d.images}, {"edges", d.segments}, {"views_added", d.views}, {"lines", d.lines}};
}

Json cameraJson(const Camera& c, const Pose& T_b_c, double time_offset_s, double readout_s) {
  return {{"intrinsics_px", {c.fx, c.fy, c.cx, c.cy}},
          {"lens", lensName(c.model).name},
          {"distortion", lensCoefficients(c)},
          {"p_b_c_m", {T_b_c.p.x(), T_b_c.p.y(), T_b_c.p.z()}},
          {"q_b_c_xyzw", {T_b_c.q.x(), T_b_c.q.y(), T_b_c.q.z(), T_b_c.q.w()}},
          {"time_offset_s", time_offset_s},
          {"readout_s", readout_s}};
}

/// The final calibration; beside it what was given, and what the last window made of it, with its sigmas.
Json calibrationJson(const OdometryResult& result, const Rig& given) {
  Json json = cameraJson(result.rig.camera, result.rig.T_b_c, result.time_offset_s, result.rig.readout_s());
  json["stamp_jitter_s"] = result.window_calibration.stamp_jitter_s;
  json["given"] = cameraJson(given.camera, given.T_b_c, 0, given.readout_s());
  const CalibrationEstimate& last = result.window_calibration;
  if (!last.sigma) return json;
  const CalibrationSigma& s = *last.sigma;
  json["window"] = cameraJson(last.camera, last.T_b_c, last.time_offset_s, last.readout_s);
  json["window"]["accelerometer_axes"] = axesJson(last.accelerometer_axes);
  json["window"]["gyroscope_axes"] = axesJson(last.gyroscope_axes);
  json["window"]["sigma"] = {{"intrinsics_px", {s.camera[0], s.camera[1], s.camera[2], s.camera[3]}},
                             {"distortion", {s.camera[4], s.camera[5]}},
                             {"p_b_c_m", {s.p_b_c_m.x(), s.p_b_c_m.y(), s.p_b_c_m.z()}},
                             {"R_b_c_rad", {s.R_b_c_rad.x(), s.R_b_c_rad.y(), s.R_b_c_rad.z()}},
                             {"time_offset_s", s.time_offset_s},
                             {"accelerometer_axes", axesJson(s.accelerometer_axes)},
                             {"gyroscope_axes", axesJson(s.gyroscope_axes)},
                             {"readout_s", s.readout_s}};
  return json;
}

Json cpuJson(const OdometryStatistics& statistics, const RunCosts& costs, double process_ms) {
  Json json;
  for (const auto& [stage, ms] : costs.breakdown(statistics, process_ms)) json[stage] = ms;
  json["whole process"] = process_ms;
  return json;
}

}  // namespace

std::string statisticsJson(const OdometryResult& result, const Rig& given, const RunCosts& costs,
                           const std::vector<std::string>& warnings, const std::vector<std::string>& command) {
  const OdometryStatistics& s = result.statistics;
  const double wall_s = costs.wall_s, process_ms = processTimeMs();
  const Json json{{"command", command},
                  {"frames", s.frames},
                  {"frames_with_pose", s.frames_with_pose},
                  {"first_frame_ns", s.first_frame_ns},
                  {"last_frame_ns", s.last_frame_ns},
                  {"window_frames", s.window_frames},
                  {"keyframes", s.keyframes},
                  {"first_pose_s", s.first_pose_s},
                  {"resets", s.resets},
                  {"reset_reasons", s.failures},
                  {"blind_s", blindJson(s)},
                  {"mean_points_used", s.mean_points_used},
                  {"mean_lines_tracked", s.mean_lines_tracked},
                  {"mean_lines_placed", s.mean_lines_placed},
                  {"mean_lines_used", s.mean_lines_used},
                  {"mean_lines_degenerate", s.mean_lines_degenerate},
                  {"mean_lines_constrained", s.mean_lines_constrained},
                  {"degenerate_share", s.mean_lines_placed > 0 ? s.mean_lines_degenerate / s.mean_lines_placed : 0},
                  {"mean_lines_degenerate_by_reason",
                   {{"through_epipole", s.mean_lines_through_epipole},
                    {"direction_unknown", s.mean_lines_direction_unknown},
                    {"distance_unknown", s.mean_lines_distance_unknown}}},
                  {"map_points", result.map.points.size()},
                  {"map_lines", result.map.lines.size()},
                  {"map_lines_beside", result.lines_beside},
                  {"loops", loopsJson(result)},
                  {"pieces", piecesJson(result)},
                  {"refinement", refinementJson(result)},
                  {"densification", densificationJson(result.densification)},
                  {"calibration", calibrationJson(result, given)},
                  {"cpu_ms_per_frame", s.frames > 0 ? process_ms / static_cast<double>(s.frames) : 0},
                  {"cpu_ms", cpuJson(s, costs, process_ms)},
                  {"wall_s", wall_s},
                  {"frames_per_s", wall_s > 0 ? static_cast<double>(s.frames) / wall_s : 0},
                  {"peak_memory_mb", peakMemoryMb()},
                  {"stages", stagesJson(s)},
                  {"tracking", trackingJson(s.front_end)},
                  {"warnings", warnings},
                  {"checks", result.evidence},
                  {"not_to_be_trusted", result.fault()},
                  {"ended_early", result.error},
                  {"partial", result.cancelled || !result.error.empty()}};
  return json.dump(2) + "\n";
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // kilobytes on Linux
}

}  // namespace lintel
