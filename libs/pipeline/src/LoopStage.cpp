// SPDX-License-Identifier: BSD-3-Clause
#include "LoopStage.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

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
  views_.push_back(std::make_unique<PlaceView>(describer_.describe(frame, tracked, down_c)));
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

/// Runs are the material's pieces, and tracks its points: one that outlived an interruption is there once a piece.
void LoopStage::nameByPieces(const MapMaterial& material) {
  if (material.pieces.size() < 2) {
    for (PlaceKeyframe& frame : frames_) frame.run = 0;
    return;
  }
  std::vector<std::unordered_map<TrackId, TrackId>> names(material.pieces.size());
  for (const PointRecord& point : material.points) {
    if (point.views.empty()) continue;
    auto& of_piece = names[pieceOf(material.pieces, point.views.front().keyframe)];
    of_piece.emplace(point.track, point.id);
    of_piece.emplace(point.id, point.id);
  }
  std::size_t piece = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    while (piece + 1 < names.size() && material.pieces[piece + 1].first_ns <= views_[k]->t_ns) ++piece;
    frames_[k].run = static_cast<int>(piece);
    for (PlaceFeature& feature : views_[k]->features) {
      const auto name = names[piece].find(static_cast<TrackId>(feature.track));
      feature.track = name == names[piece].end() ? PlaceFeature::kNoTrack : static_cast<std::int64_t>(name->second);
    }
  }
}

LoopResult LoopStage::find(const MapMaterial& material, const std::function<bool(double)>& progress) {
  LoopResult loops;
  loops.searched = params_.enabled;
  if (!params_.enabled) return loops;
  nameByPieces(material);
  searched_ = true;
  loops.places = findPlaces(material.rig.camera, frames_, knownPoints(material), params_, progress);
  for (const PlacePair& pair : loops.places.pairs)
    if (pair.refusal.empty() && !pair.joinsRuns()) loops.drift_before_m.push_back(pair.drift_m);
  thinDescriptions();
  return loops;
}

/// Leaves descriptions at the distance that the map keeps, and the times of all.
void LoopStage::thinDescriptions() {
  const double interval_ns = 1e9 * params_.keep_interval_s - 1;
  const PlaceView* kept = nullptr;
  for (const std::unique_ptr<PlaceView>& view : views_) {
    if (interval_ns > 0 && (!kept || static_cast<double>(view->t_ns - kept->t_ns) >= interval_ns))
      kept = view.get();
    else
      view->features = {};
  }
}

std::unordered_map<std::int64_t, Pose> LoopStage::cameras() const {
  std::unordered_map<std::int64_t, Pose> poses;
  for (const PlaceKeyframe& frame : frames_) poses.emplace(frame.view->t_ns, frame.T_w_c);
  return poses;
}

void LoopStage::measureDrift(const MapMaterial& refined, LoopResult& loops) const {
  const std::unordered_map<std::int64_t, Pose> poses = posesOf(refined);
  const std::unordered_map<std::int64_t, Pose> causal = cameras();
  for (const PlacePair& pair : loops.places.pairs) {
    if (!pair.refusal.empty() || pair.joinsRuns()) continue;
    const auto earlier = poses.find(pair.earlier_ns), later = poses.find(pair.later_ns);
    const Pose seen = causal.at(pair.earlier_ns).inverse() * pair.T_w_c;
    const bool known = earlier != poses.end() && later != poses.end();
    loops.drift_after_m.push_back(known ? (seen.p - (earlier->second.inverse() * later->second).p).norm()
                                        : pair.drift_m);
  }
}

std::vector<MapView> LoopStage::takeViews(const LineMap& map, const MapMaterial& material) {
  std::unordered_map<TrackId, TrackId> names;  // of tracks and merged points, those that the map has
  std::unordered_set<TrackId> known;
  for (const MapPoint& point : map.points) known.insert(point.id);
  for (const PointRecord& point : material.points) {
    if (known.count(point.id) == 0) continue;
    names.emplace(point.id, point.id);
    for (const TrackId track : point.joined) names.emplace(track, point.id);
  }
  std::vector<MapView> views;
  const bool keep = searched_ && !map.pieces.empty();
  for (std::size_t k = 0; keep && k < views_.size(); ++k) {
    PlaceView& looks = *views_[k];
    if (looks.features.empty()) continue;
    for (PlaceFeature& feature : looks.features) {
      const auto name = names.find(static_cast<TrackId>(feature.track));
      feature.track = name == names.end() ? PlaceFeature::kNoTrack : static_cast<std::int64_t>(name->second);
    }
    views.push_back({frames_[k].run, std::move(looks)});
  }
  frames_.clear();
  views_.clear();
  return views;
}

std::vector<PointJoin> joinsOf(const LoopResult& loops) {
  std::vector<PointJoin> joins;
  for (const SamePoint& same : loops.places.same) joins.push_back({same.earlier, same.later, same.votes});
  return joins;
}

std::vector<PlaceSighting> sightingsOf(const PlaceReport& places,
                                       const std::unordered_map<std::int64_t, Pose>& odometry) {
  std::unordered_map<int, Pose> moves;
  for (const RunAlignment& alignment : places.alignments) moves.emplace(alignment.run, alignment.world_from_run);
  const auto moveOf = [&](int run) { return moves.count(run) > 0 ? moves.at(run) : Pose{}; };
  std::vector<PlaceSighting> sightings;
  for (const PlacePair& pair : places.pairs) {
    const auto later = odometry.find(pair.later_ns);
    if (!pair.refusal.empty() || later == odometry.end()) continue;
    sightings.push_back({pair.earlier_ns, pair.later_ns, moveOf(pair.later_run) * later->second,
                         moveOf(pair.earlier_run) * pair.T_w_c});
  }
  return sightings;
}

void alignPieces(const std::vector<RunAlignment>& alignments, MapMaterial& material) {
  for (const RunAlignment& alignment : alignments) {
    const auto piece = static_cast<std::size_t>(alignment.run);
    movePiece(piece, alignment.world_from_run, material);
    material.pieces[piece].world = alignment.world;
  }
}

}  // namespace lintel
