// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/LineConsistency.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "BoxIndex.h"
#include "LineMatching.h"
#include "lintel/core/Quantiles.h"
#include "lintel/evaluation/TrajectoryErrors.h"

namespace lintel {

namespace {

/// Ends of lines, with their sigmas.
class SigmaCount {
 public:
  void add(double distance_m, double sigma_m) {
    ++ends_;
    within_1_ += distance_m <= sigma_m;
    within_2_ += distance_m <= 2 * sigma_m;
  }
  SigmaShares result() const {
    const auto n = static_cast<double>(ends_);  // 0 / 0 is NaN
    return {ends_, static_cast<double>(within_1_) / n, static_cast<double>(within_2_) / n};
  }

 private:
  std::size_t ends_ = 0, within_1_ = 0, within_2_ = 0;
};

struct CountBySource {
  SigmaCount tracked, mapped, constrained;

  SigmaCount& of(const MapLine& line) { return line.constrained ? constrained : line.mapped ? mapped : tracked; }
  ConsistencyBySource result() const { return {tracked.result(), mapped.result(), constrained.result()}; }
};

double distanceToLine(const Eigen::Vector3d& p, const Segment3& edge) {
  return (p - edge.start).cross(edge.direction()).norm();
}

/// The true world in the keyframes' images.
class TrueImages {
 public:
  TrueImages(const LineMap& map, const StampedPoses& groundtruth, double max_difference_s) : camera_(map.rig.camera) {
    StampedPoses keyframes;
    for (const MapKeyframe& keyframe : map.keyframes) keyframes.emplace_back(keyframe.t_ns, keyframe.T_w_b);
    for (const PosePair& pair : associate(keyframes, groundtruth, max_difference_s))
      T_w_c_.emplace(map.keyframes[pair.estimate].id, groundtruth[pair.groundtruth].second * map.rig.T_b_c);
  }

  /// The distance [px] of the farther end that `share` of the observations keep; empty where no pose is known.
  std::optional<double> offsetOf(const MapLine& line, const Segment3& edge, double share) const {
    std::vector<double> offsets;
    for (const MapLineObservation& seen : line.observations) {
      const auto pose = T_w_c_.find(seen.keyframe_id);
      if (pose == T_w_c_.end()) continue;
      const Pose T_c_w = pose->second.inverse();
      const Eigen::Vector3d normal = (T_c_w * edge.start).cross(T_c_w * edge.end).normalized();
      double worst = 0;
      for (const Eigen::Vector2d& px : {seen.start_px, seen.end_px})
        worst = std::max(worst, std::abs(camera_.ray(px).normalized().dot(normal)));
      offsets.push_back(worst * camera_.meanFocal());
    }
    if (offsets.empty()) return std::nullopt;
    return upperQuantile(offsets, std::min(share, 0.999999));
  }

 private:
  Camera camera_;
  std::unordered_map<std::uint64_t, Pose> T_w_c_;
};

}  // namespace

LineConsistency evaluateConsistency(const LineMap& map, const Similarity& S_truth_map,
                                    const std::vector<TrueLine>& truth, const StampedPoses& groundtruth,
                                    const ConsistencyParams& params) {
  const BoxIndex index = indexOf(truth);
  const TrueImages images(map, groundtruth, params.max_difference_s);
  CountBySource near, seen;
  for (const MapLine& line : map.lines) {
    const Segment3 segment{S_truth_map * line.segment_w.start, S_truth_map * line.segment_w.end};
    if (!(segment.length() > 1e-6) || !segment.start.allFinite() || !segment.end.allFinite()) continue;
    const double sigma_m = S_truth_map.scale * line.sigma_distance_m;
    std::vector<const Segment3*> edges;
    for (const std::size_t i : index.touching(boxAroundMiddle(segment, 0.5 * segment.length() + params.reach_m)))
      if (lineAngle(truth[i].segment_w.direction(), segment.direction()) < params.max_angle_rad)
        edges.push_back(&truth[i].segment_w);
    for (const Eigen::Vector3d& end : {segment.start, segment.end}) {
      const auto nearest = std::min_element(edges.begin(), edges.end(), [&](const Segment3* a, const Segment3* b) {
        return distanceToSegment(end, *a) < distanceToSegment(end, *b);
      });
      if (nearest != edges.end() && distanceToSegment(end, **nearest) <= params.near_m)
        near.of(line).add(distanceToLine(end, **nearest), sigma_m);
    }
    const Segment3* shown = nullptr;
    double least = params.max_offset_px;
    for (const Segment3* edge : edges) {
      if (distanceToSegment(segment.midpoint(), *edge) > params.reach_m) continue;
      const auto offset = images.offsetOf(line, *edge, params.least_share);
      if (offset && *offset <= least) shown = edge, least = *offset;
    }
    if (!shown) continue;
    for (const Eigen::Vector3d& end : {segment.start, segment.end})
      seen.of(line).add(distanceToLine(end, *shown), sigma_m);
  }
  return {near.result(), seen.result()};
}

}  // namespace lintel
