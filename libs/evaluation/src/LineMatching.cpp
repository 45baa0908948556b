// SPDX-License-Identifier: BSD-3-Clause
#include "LineMatching.h"

#include <algorithm>
#include <limits>
#include <map>

namespace lintel {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNeighbourhood_m = 0.5;  // edges farther off cannot matter: above any tolerance and match distance

struct Neighbour {
  std::size_t index;
  bool same_direction;  // within max_angle_rad
};

std::vector<Neighbour> neighboursOf(const Segment3& segment, const std::vector<TrueLine>& truth, const BoxIndex& index,
                                    const LineErrorParams& params) {
  const double radius_m = 0.5 * segment.length() + kNeighbourhood_m;
  std::vector<Neighbour> neighbours;
  for (const std::size_t i : index.touching(boxAroundMiddle(segment, radius_m))) {
    const Segment3& edge = truth[i].segment_w;
    const double angle = lineAngle(segment.direction(), edge.direction());
    if (angle >= params.match_angle_rad) continue;
    if (distanceToSegment(segment.midpoint(), edge) < radius_m) neighbours.push_back({i, angle < params.max_angle_rad});
  }
  return neighbours;
}

}  // namespace

std::vector<Eigen::Vector3d> piecesOf(const Segment3& segment, double step_m) {
  const std::size_t n = std::max<std::size_t>(1, static_cast<std::size_t>(segment.length() / step_m));
  std::vector<Eigen::Vector3d> middles;
  for (std::size_t i = 0; i < n; ++i)
    middles.push_back(segment.start +
                      (static_cast<double>(i) + 0.5) / static_cast<double>(n) * (segment.end - segment.start));
  return middles;
}

BoxIndex indexOf(const std::vector<TrueLine>& truth) {
  std::vector<BoxIndex::Box> boxes;
  boxes.reserve(truth.size());
  for (const TrueLine& line : truth) boxes.push_back(boxOf(line.segment_w));
  return BoxIndex(boxes);
}

LineMatch matchLine(const Segment3& segment_w, const std::vector<TrueLine>& truth, const BoxIndex& index,
                    const LineErrorParams& params) {
  const std::vector<Neighbour> neighbours = neighboursOf(segment_w, truth, index, params);
  const auto pieces = piecesOf(segment_w, params.step_m);
  LineMatch match;
  std::map<std::size_t, std::size_t> votes;
  for (const Eigen::Vector3d& p : pieces) {
    double nearest = kInfinity, nearest_same_direction = kInfinity;
    std::size_t nearest_index = 0;
    for (const Neighbour& neighbour : neighbours) {
      const double distance = distanceToSegment(p, truth[neighbour.index].segment_w);
      if (neighbour.same_direction) nearest_same_direction = std::min(nearest_same_direction, distance);
      if (distance >= nearest) continue;
      nearest = distance;
      nearest_index = neighbour.index;
    }
    match.distances_m.push_back(nearest_same_direction);
    if (nearest < params.match_distance_m) ++votes[nearest_index];
  }
  const auto most =
      std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != votes.end() && 2 * most->second >= pieces.size()) match.edge = most->first;
  return match;
}

}  // namespace lintel
