// SPDX-License-Identifier: BSD-3-Clause
#include "LoopStage.h"

#include <algorithm>
#include <unordered_map>

#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr std::size_t kViews = 3;  // of a point whose position counts

std::unordered_map<TrackId, Eigen::Vector3d> knownPoints(const MapMaterial& material) {
  std::unordered_map<TrackId, Eigen::Vector3d> points_w;
  for (const PointRecord& point : material.points)
    if (point.known && point.views.size() >= kViews) points_w.emplace(point.id, point.p_w);
  return points_w;
}

std::unordered_map<std::int64_t, Pose> posesOf(const MapMaterial& material) {
  std::unordered_map<std::int64_t, Pose> poses;
  for (const auto& [t_ns, T_w_b] : material.trajectory) poses.emplace(t_ns, T_w_b * material.rig.T_b_c);
  return poses;
}

}  // namespace

LoopStage::LoopStage(const Rig& rig, const PlaceParams& params) : rig_(rig), params_(params), describer_(rig.camera) {
  checkRanges(params, "loops.");
}

bool LoopStage::isWanted(const WindowUpdate& update) const {
  if (!params_.enabled || update.status != EstimatorStatus::kTracking || (update.at_rest && at_rest_)) return false;
  return views_.empty() || static_cast<double>(update.t_ns - views_.back()->t_ns) >= 1e9 * params_.interval_s - 1;
}

void LoopStage::add(const Frame& frame, const std::vector<PointObservation>& tracked, const WindowUpdate& update) {
  if (update.startWasWrong()) withdrawRun();
  if (update.status == EstimatorStatus::kLost) ++run_;
  if (!isWanted(update)) return;
  at_rest_ = update.at_rest;
  const Pose T_w_c = update.T_w_b * rig_.T_b_c;
  const Eigen::Vector3d down_c = T_w_c.q.conjugate() * -Eigen::Vector3d::UnitZ();
  views_.push_back(std::make_unique<const PlaceView>(describer_.describe(frame, tracked, down_c)));
  double travelled_m = frames_.empty() ? 0 : frames_.back().travelled_m;
  if (!frames_.empty() && frames_.back().run == run_) travelled_m += (T_w_c.p - frames_.back().T_w_c.p).norm();
  frames_.push_back({T_w_c, run_, travelled_m, views_.back().get()});
}

void LoopStage::withdrawRun() {
  while (!frames_.empty() && frames_.back().run == run_) {
    frames_.pop_back();
    views_.pop_back();
  }
}

LoopResult LoopStage::find(const MapMaterial& material, const std::function<bool(double)>& progress) const {
  LoopResult loops;
  loops.searched = params_.enabled;
  if (!params_.enabled) return loops;
  loops.places = findPlaces(material.rig.camera, frames_, knownPoints(material), params_, progress);
  for (const PlacePair& pair : loops.places.pairs)
    if (pair.refusal.empty()) loops.drift_before_m.push_back(pair.drift_m);
  return loops;
}

void LoopStage::measureDrift(const MapMaterial& refined, LoopResult& loops) const {
  const std::unordered_map<std::int64_t, Pose> poses = posesOf(refined);
  std::unordered_map<std::int64_t, Pose> causal;
  for (const PlaceKeyframe& frame : frames_) causal.emplace(frame.view->t_ns, frame.T_w_c);
  for (const PlacePair& pair : loops.places.pairs) {
    if (!pair.refusal.empty()) continue;
    const auto earlier = poses.find(pair.earlier_ns), later = poses.find(pair.later_ns);
    const Pose seen = causal.at(pair.earlier_ns).inverse() * pair.T_w_c;
    const bool known = earlier != poses.end() && later != poses.end();
    loops.drift_after_m.push_back(known ? (seen.p - (earlier->second.inverse() * later->second).p).norm()
                                        : pair.drift_m);
  }
}

std::vector<PointJoin> joinsOf(const LoopResult& loops) {
  std::vector<PointJoin> joins;
  for (const SamePoint& same : loops.places.same) joins.push_back({same.earlier, same.later, same.votes});
  return joins;
}

}  // namespace lintel
