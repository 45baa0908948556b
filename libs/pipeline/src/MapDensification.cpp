// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/MapDensification.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "MapDamage.h"
#include "lintel/mapping/FarLines.h"
#include "lintel/mapping/LineSpacing.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/mapping/MapStructure.h"

namespace lintel {

namespace {

constexpr std::int64_t kMostBetween_ns = 250'000'000;  // poses farther apart say nothing of the time between

std::string objection(const LineMap& map) {
  if (map.keyframes.empty()) return "holds no keyframes, whose images would be searched: take a map of lintel-vio";
  if (isDamaged(map)) return "has poses, IMU samples or times that are out of range: take a map of lintel-vio";
  return {};
}

std::optional<Pose> poseAt(const PosesInTime& poses, std::int64_t t_ns) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_ns,
                                      [](const auto& pose, std::int64_t t) { return pose.first < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->first == t_ns) return after->second;
  if (after == poses.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const std::int64_t between_ns = after->first - before->first;
  if (between_ns > kMostBetween_ns) return std::nullopt;
  return interpolate(before->second, after->second,
                     static_cast<double>(t_ns - before->first) / static_cast<double>(between_ns));
}

template <class Record>
void forget(const std::set<FrameId>& gone, std::vector<Record>& records) {
  for (Record& record : records)
    record.views.erase(std::remove_if(record.views.begin(), record.views.end(),
                                      [&](const auto& view) { return gone.count(view.keyframe) > 0; }),
                       record.views.end());
}

/// Puts other poses in the place of the material's; how many keyframes have none.
std::size_t takePoses(const PosesInTime& poses, MapMaterial& material) {
  std::set<FrameId> gone;
  std::vector<RetiredKeyframe> kept;
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (const auto pose = poseAt(poses, keyframe.t_ns)) {
      keyframe.T_w_b = *pose;
      keyframe.v_w_b.setZero();  // in the frame of the former poses
      kept.push_back(keyframe);
    } else {
      gone.insert(keyframe.id);
    }
  }
  if (kept.size() < 2) throw PosesError("fewer than two keyframes of the map have a pose");
  for (RetiredKeyframe& keyframe : kept) keyframe.imu.reset(), keyframe.offset_change_s = 0;
  material.time_offset_s = 0;  // they are those at which the images were taken
  material.keyframes = std::move(kept);
  material.camera_errors.clear();  // these poses are taken as they are
  material.trajectory = poses;
  material.pieces.clear();
  forget(gone, material.points);
  forget(gone, material.lines);
  for (PointRecord& point : material.points) point.known = false;
  for (LineRecord& line : material.lines) line.known = false, line.tie.reset();
  return gone.size();
}

class EdgeReader {
 public:
  EdgeReader(const MapMaterial& material, const MapDensificationOptions& options) : options_(options) {
    const std::int64_t interval_ns = std::llround(1e9 * options.configuration.densification.interval_s);
    std::optional<std::int64_t> last_ns;
    for (const RetiredKeyframe& keyframe : material.keyframes) {
      if (last_ns && keyframe.t_ns - *last_ns < interval_ns) continue;
      wanted_.insert(keyframe.t_ns);
      last_ns = keyframe.t_ns;
    }
  }

  ImageEdges read(Recording& recording, const Rig& rig) {
    SegmentDetector detector(rig, options_.configuration.densification.segments);
    ImageEdges edges;
    std::size_t frames = 0;
    while (!wanted_.empty() && !(options_.cancelled && options_.cancelled())) {
      const auto step = recording.next();
      if (!step || step->frame.t_ns > *wanted_.rbegin()) break;
      if (options_.reading) options_.reading(++frames, recording.expectedFrames());
      if (wanted_.erase(step->frame.t_ns) > 0) edges.emplace(step->frame.t_ns, detector.detect(*step->frame.image));
    }
    return edges;
  }

  std::size_t missing() const { return wanted_.size(); }

 private:
  const MapDensificationOptions& options_;
  std::set<std::int64_t> wanted_;
};

}  // namespace

MapDensification densifyMap(const LineMap& map, Recording& recording, const MapDensificationOptions& options) {
  MapDensification result;
  result.refusal = objection(map);
  if (!result.refusal.empty()) return result;
  MapMaterial material = materialOf(options.configuration.map, map);
  MapParams params = withFarLines(options.configuration.map, material, kShareOfOwnLines);
  if (!options.poses.empty()) {
    result.keyframes_without_pose = takePoses(options.poses, material);
    prepareMaterial(params, material);
  }
  EdgeReader reader(material, options);
  const ImageEdges edges = reader.read(recording, map.rig);
  result.keyframes_without_image = reader.missing();
  const auto searching = [&](double share) {
    return !(options.cancelled && options.cancelled()) && (!options.searching || options.searching(share));
  };
  result.report = densify(options.configuration.densification, params, edges, material, options.threads, searching);
  settleLines(params, material);
  params = withFarLines(params, material, params.least_share);
  result.map = drawMap(params, material);
  spaceLines(params, result.map);
  findStructure(result.map);
  result.map.configuration = map.configuration;
  result.map.source = map.source;
  result.map.recordings = map.recordings;
  if (options.poses.empty()) result.map.views = map.views;
  return result;
}

}  // namespace lintel
