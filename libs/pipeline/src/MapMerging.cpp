// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/MapMerging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "LoopStage.h"
#include "MapDamage.h"
#include "MapTimes.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/FarLines.h"
#include "lintel/mapping/LineSpacing.h"
#include "lintel/mapping/MapBuilder.h"

namespace lintel {

namespace {

constexpr double kSameFocal = 0.03, kSameTurn_rad = 0.1, kSamePlace_m = 0.05;  // of one camera, calibrated twice
constexpr double kStillApart_m = 0.15;  // two keyframes' relative pose after the adjustment from what their images say

using Poses = std::unordered_map<std::int64_t, Pose>;

bool ofOneCamera(const Rig& a, const Rig& b) {
  return a.camera.width == b.camera.width && a.camera.height == b.camera.height && a.camera.model == b.camera.model &&
         std::abs(a.camera.fx / b.camera.fx - 1) < kSameFocal && std::abs(a.camera.fy / b.camera.fy - 1) < kSameFocal &&
         logRotation(a.T_b_c.q.conjugate() * b.T_b_c.q).norm() < kSameTurn_rad &&
         (a.T_b_c.p - b.T_b_c.p).norm() < kSamePlace_m;
}

bool isTheSame(const LineMap& a, const LineMap& b) {
  const auto same = [](const MapKeyframe& x, const MapKeyframe& y) {
    return x.t_ns == y.t_ns && x.T_w_b.p == y.T_w_b.p;
  };
  return std::equal(a.keyframes.begin(), a.keyframes.end(), b.keyframes.begin(), b.keyframes.end(), same);
}

std::string objection(const LineMap& first, const LineMap& second) {
  for (const LineMap* map : {&first, &second})
    if (map->keyframes.empty())
      return std::string("the ") + (map == &first ? "first" : "second") + " one holds no keyframes";
  for (const LineMap* map : {&first, &second})
    if (map->views.empty() || map->pieces.empty())
      return std::string("the ") + (map == &first ? "first" : "second") +
             " one keeps no views of its places: make it again, with loops.enabled and loops.keep_interval_s above 0";
  for (const LineMap* map : {&first, &second})
    if (isDamaged(*map))
      return std::string("the ") + (map == &first ? "first" : "second") +
             " one has poses, IMU samples or times that are out of range";
  if (isTheSame(first, second)) return "both are the map of one run";
  if (!ofOneCamera(first.rig, second.rig)) return "they were made with different cameras or calibrations";
  return {};
}

std::vector<std::string> recordingsOf(const LineMap& map) {
  return map.recordings.empty() ? std::vector<std::string>{map.source} : map.recordings;
}

/// Both maps as one, times of all recordings behind one another; nothing is aligned.
struct Together {
  MapMaterial material;
  std::vector<MapView> views;
  std::vector<std::string> recordings;
  std::vector<std::int64_t> moved_ns;  ///< by recording
  int pieces_of_first = 0;
};

Together putTogether(const MapParams& params, const LineMap& first, const LineMap& second) {
  Together t;
  LineMap a = first, b = second;
  t.recordings = recordingsOf(a);
  const auto recordings_of_first = static_cast<int>(t.recordings.size());
  for (const std::string& name : recordingsOf(b)) t.recordings.push_back(name);
  for (MapPiece& piece : b.pieces) piece.recording += recordings_of_first;
  std::vector<MapPiece> all = a.pieces;
  all.insert(all.end(), b.pieces.begin(), b.pieces.end());
  t.moved_ns = timesBehindOneAnother(all);
  moveTimes(t.moved_ns, a);
  moveTimes(t.moved_ns, b);
  t.material = materialOf(params, a);
  const AppendedIds ids = appendMaterial(materialOf(params, b), t.material);
  t.pieces_of_first = ids.pieces;
  t.views = std::move(a.views);
  for (MapView& view : b.views) {
    view.piece += ids.pieces;
    for (PlaceFeature& feature : view.looks.features)
      if (feature.track != PlaceFeature::kNoTrack) feature.track += static_cast<std::int64_t>(ids.points);
    t.views.push_back(std::move(view));
  }
  return t;
}

Poses camerasOf(const MapMaterial& material) {
  Poses poses;
  for (const auto& [t_ns, T_w_b] : material.trajectory) poses.emplace(t_ns, T_w_b * material.rig.T_b_c);
  return poses;
}

/// Views with the poses of the maps; a run is a world of the maps.
std::vector<PlaceKeyframe> keyframesOf(const Together& together, const Poses& poses) {
  std::vector<PlaceKeyframe> keyframes;
  for (const MapView& view : together.views) {
    const auto pose = poses.find(view.looks.t_ns);
    if (pose == poses.end()) continue;
    const MapPiece& piece = together.material.pieces[static_cast<std::size_t>(view.piece)];
    double travelled_m = 0;
    if (!keyframes.empty()) {
      const PlaceKeyframe& before = keyframes.back();
      travelled_m = before.travelled_m + (before.run == piece.world ? (pose->second.p - before.T_w_c.p).norm() : 0);
    }
    keyframes.push_back({pose->second, piece.world, travelled_m, &view.looks, piece.recording});
  }
  return keyframes;
}

/// Pairs of one keyframe of each map.
std::vector<PlacePair> betweenMaps(const std::vector<PlacePair>& pairs, int pieces_of_first) {
  std::vector<PlacePair> between;
  for (const PlacePair& pair : pairs)
    if (pair.earlier_run < pieces_of_first && pair.later_run >= pieces_of_first) between.push_back(pair);
  return between;
}

/// How far the adjusted keyframes are from what the images of the pairs say, median.
double stillApart(const std::vector<PlacePair>& pairs, const Poses& before, const Poses& after) {
  std::vector<double> apart_m;
  for (const PlacePair& pair : pairs) {
    if (!pair.refusal.empty()) continue;
    const Pose seen = before.at(pair.earlier_ns).inverse() * pair.T_w_c;
    apart_m.push_back((seen.p - (after.at(pair.earlier_ns).inverse() * after.at(pair.later_ns)).p).norm());
  }
  return apart_m.empty() ? 0 : upperMedian(apart_m);
}

std::string noCommonPlace(const std::vector<PlacePair>& pairs) {
  if (pairs.empty()) return "no place of the second is recognised in the first";
  std::map<std::string, int> reasons;
  for (const PlacePair& pair : pairs) ++reasons[pair.refusal];
  const auto most = std::max_element(reasons.begin(), reasons.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return "no common place is certain: " + std::to_string(pairs.size()) + " pairs of images look alike, but " +
         most->first;
}

void alignWorlds(const std::vector<RunAlignment>& alignments, MapMaterial& material) {
  for (const RunAlignment& alignment : alignments)
    for (std::size_t p = 0; p < material.pieces.size(); ++p) {
      if (material.pieces[p].world != alignment.run) continue;
      movePiece(p, alignment.world_from_run, material);
      material.pieces[p].world = alignment.world;
    }
}

LineMap drawTogether(const MapParams& params, Together& together) {
  LineMap map = drawMap(params, together.material);
  spaceLines(params, map);
  map.recordings = together.recordings;
  for (const std::string& name : map.recordings) map.source += (map.source.empty() ? "" : " + ") + name;
  std::unordered_map<TrackId, TrackId> names;  // points that were merged have one id
  for (const PointRecord& point : together.material.points)
    for (const TrackId track : point.joined) names.emplace(track, point.id);
  for (MapView& view : together.views)
    for (PlaceFeature& feature : view.looks.features) {
      const auto name = names.find(static_cast<TrackId>(feature.track));
      if (name != names.end()) feature.track = static_cast<std::int64_t>(name->second);
    }
  map.views = std::move(together.views);
  for (std::int64_t& by_ns : together.moved_ns) by_ns = -by_ns;
  moveTimes(together.moved_ns, map);
  return map;
}

}  // namespace

MapMerging mergeMaps(const LineMap& first, const LineMap& second, const MapMergingOptions& options) {
  MapMerging result;
  result.refusal = objection(first, second);
  if (!result.refusal.empty()) return result;
  const Configuration& configuration = options.configuration;
  Together together = putTogether(configuration.map, first, second);
  MapMaterial& material = together.material;
  const MapParams drawn = withFarLines(configuration.map, material, kShareOfOwnLines);
  const Poses before = camerasOf(material);
  LoopResult loops;
  std::unordered_map<TrackId, Eigen::Vector3d> points_w;
  for (const PointRecord& point : material.points) points_w.emplace(point.id, point.p_w);
  loops.places =
      findPlaces(first.rig.camera, keyframesOf(together, before), points_w, configuration.loops, options.searching);
  result.pairs = betweenMaps(loops.places.pairs, together.pieces_of_first);
  if (std::none_of(result.pairs.begin(), result.pairs.end(), [](const PlacePair& p) { return p.refusal.empty(); })) {
    result.refusal = noCommonPlace(result.pairs);
    return result;
  }
  alignWorlds(loops.places.alignments, material);
  spreadDrift(sightingsOf(loops.places, before), material);
  const BatchRefinement refinement(first.rig, configuration.estimator, configuration.map, configuration.refinement);
  result.refinement = refinement.refine(material, options.refining, joinsOf(loops));
  if (!result.refinement.accepted || result.refinement.joins_refused) {
    result.refusal = "together they fail the checks of the adjustment" +
                     (result.refinement.accepted ? std::string() : ": " + result.refinement.verdict);
    return result;
  }
  if (stillApart(result.pairs, before, camerasOf(material)) > kStillApart_m) {
    result.refusal = "after the adjustment the common places are still apart";
    return result;
  }
  result.map = drawTogether(drawn, together);
  result.map.configuration = writeConfiguration(configuration);
  return result;
}

std::vector<std::pair<std::int64_t, Pose>> trajectoryOf(const LineMap& map, int recording) {
  std::vector<std::pair<std::int64_t, Pose>> trajectory;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    if (map.pieces[p].recording != recording) continue;
    const auto [from, to] = posesOf(map.pieces, p, map.trajectory.size());
    trajectory.insert(trajectory.end(), map.trajectory.begin() + static_cast<std::ptrdiff_t>(from),
                      map.trajectory.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return trajectory;
}

}  // namespace lintel
