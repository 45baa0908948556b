// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "lintel/evaluation/Output.h"

namespace lintel {

namespace {

/// Keeps the keys in the order in which they are written.
using Json = nlohmann::ordered_json;

Json jsonOf(const ErrorStatistics& statistics) {
  return {{"count", statistics.count},   {"rmse", statistics.rmse}, {"mean", statistics.mean},
          {"median", statistics.median}, {"max", statistics.max},   {"p05", statistics.p05},
          {"p25", statistics.p25},       {"p75", statistics.p75},   {"p95", statistics.p95}};
}

Json jsonOf(const Similarity& s) {
  const Pose& T = s.T_a_b;
  return {{"scale", s.scale},
          {"quaternion_xyzw", {T.q.x(), T.q.y(), T.q.z(), T.q.w()}},
          {"translation_m", {T.p.x(), T.p.y(), T.p.z()}}};
}

Json jsonOf(const std::vector<RelativeErrors>& relative) {
  Json json = Json::array();
  for (const RelativeErrors& r : relative)
    json.push_back({{"distance_m", r.distance_m},
                    {"whole_path", r.whole_path},
                    {"translation_m", jsonOf(r.translation_m)},
                    {"rotation_rad", jsonOf(r.rotation_rad)}});
  return json;
}

Json jsonOf(const TrajectoryErrors& e) {
  return {{"poses", e.poses},
          {"pairs", e.pairs},
          {"start_offset_s", e.start_offset_s},
          {"duration_s", e.duration_s},
          {"path_m", e.path_m},
          {"coverage_time", e.coverage_time},
          {"coverage_path", e.coverage_path},
          {"complete", e.complete},
          {"whole_rmse_m", e.whole_rmse_m},
          {"alignment", nameOf(e.alignment)},
          {"transform", jsonOf(e.S_truth_estimate)},
          {"position_m", jsonOf(e.position_m)},
          {"rotation_rad", jsonOf(e.rotation_rad)},
          {"scale", e.scale},
          {"position_sim3_m", jsonOf(e.position_sim3_m)},
          {"relative", jsonOf(e.relative)}};
}

Json jsonOf(const SegmentErrors& e) {
  return {{"count", e.count},
          {"direction_median_rad", e.direction_median_rad},
          {"direction_p90_rad", e.direction_p90_rad},
          {"distance_median_m", e.distance_median_m}};
}

Json jsonOf(const LineErrors& e) {
  return {{"lines", e.lines},
          {"degenerate", e.degenerate},
          {"constrained", e.constrained},
          {"length_m", e.length_m},
          {"observable_m", e.observable_m},
          {"tolerances_m", e.tolerances_m},
          {"surface_precision", e.surface_precision},
          {"surface_length_m", e.surface_length_m},
          {"surface_lines", e.surface_lines},
          {"precision", e.precision},
          {"recall", e.recall},
          {"duplicates", e.duplicates},
          {"true_duplicates", e.true_duplicates},
          {"all_matched", jsonOf(e.all_matched)},
          {"well_determined_matched", jsonOf(e.well_determined_matched)},
          {"degenerate_matched", jsonOf(e.degenerate_matched)},
          {"constrained_matched", jsonOf(e.constrained_matched)}};
}

Json jsonOf(const SquaredErrorSummary& s) {
  return {{"freedom", s.freedom}, {"mean", s.mean}, {"low", s.low}, {"high", s.high}, {"inside", s.inside}};
}

Json jsonOf(const Consistency& c) {
  return {{"poses", c.poses},
          {"pieces", c.pieces},
          {"nees_position", jsonOf(c.position)},
          {"nees_yaw", jsonOf(c.yaw)},
          {"nees_roll_pitch", jsonOf(c.roll_pitch)}};
}

Json jsonOf(const SigmaShares& s) {
  return {{"ends", s.ends}, {"within_1_sigma", s.within_1}, {"within_2_sigma", s.within_2}};
}

Json jsonOf(const ConsistencyBySource& c) {
  return {{"tracked", jsonOf(c.tracked)}, {"mapped", jsonOf(c.mapped)}, {"constrained", jsonOf(c.constrained)}};
}

}  // namespace

std::string toJson(const std::optional<TrajectoryErrors>& trajectory,
                   const std::optional<TrajectoryErrors>& map_trajectory, const std::optional<LineErrors>& lines,
                   const std::optional<Consistency>& consistency, const std::optional<LineConsistency>& line_sigmas) {
  Json json = Json::object();
  if (trajectory) json["trajectory"] = jsonOf(*trajectory);
  if (map_trajectory) json["map_trajectory"] = jsonOf(*map_trajectory);
  if (lines) json["lines"] = jsonOf(*lines);
  if (consistency) json["consistency"] = jsonOf(*consistency);
  if (line_sigmas)
    json["line_sigmas"] = {{"near_an_edge", jsonOf(line_sigmas->near)}, {"edge_seen", jsonOf(line_sigmas->seen)}};
  return json.dump(2) + "\n";
}

}  // namespace lintel
