// SPDX-License-Identifier: BSD-3-Clause
#include "LineSearch.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lintel {

namespace {

constexpr double kLeastSine = 0.02;    // between the planes of a pair: 1.1 degrees
constexpr double kMostSlant = 8;       // between the distances of both ends
constexpr double kLeastOverlap = 0.3;  // of the shorter one of a pair, along the line
constexpr int kFirstLook = 6;          // views that should see it, after which a candidate without support is given up
constexpr int kLeastFirst = 2;         // supporters among these

/// The part of the line through segment `t` of `other` that segment `s` of `view` saw.
std::optional<Segment3> pairOf(const SegmentView& view, std::size_t s, const SegmentView& other, std::size_t t) {
  const Eigen::Vector3d& n = other.normal_w[t];
  const double height = n.dot(other.p_w_c - view.p_w_c);
  const double depth0 = height / n.dot(view.start_w[s]), depth1 = height / n.dot(view.end_w[s]);
  if (!(depth0 > view.near_m && depth0 < view.far_m && depth1 > view.near_m && depth1 < view.far_m)) return {};
  if (std::max(depth0, depth1) > kMostSlant * std::min(depth0, depth1)) return {};
  if (n.cross(view.normal_w[s]).squaredNorm() < kLeastSine * kLeastSine) return {};
  const Segment3 segment{view.p_w_c + depth0 * view.start_w[s], view.p_w_c + depth1 * view.end_w[s]};
  const Eigen::Vector3d a = segment.start - other.p_w_c, b = segment.end - other.p_w_c;
  if (a.cross(b).dot(n) <= 0) return {};  // the other side is the brighter one
  const Eigen::Vector3d &u = other.start_w[t], w = n.cross(u);
  const double from = std::atan2(a.dot(w), a.dot(u)), to = std::atan2(b.dot(w), b.dot(u));
  const double length = other.length(static_cast<Eigen::Index>(t));
  if (std::min(to, length) - std::max(from, 0.0) < kLeastOverlap * std::min(to - from, length)) return {};
  return segment;
}

using Edge = std::pair<std::size_t, std::size_t>;  // view, segment

/// A line that the segment may be the picture of.
struct LineCandidate {
  Segment3 segment_w;
  double score = 0;    ///< what other images cover of it, summed up
  int supporters = 0;  ///< those images
};

/// Looks for a segment in all of `common`; adds the edges that support it to `used`.
LineCandidate lookFor(const DensifyParams& params, const std::vector<SegmentView>& views,
                      const std::vector<std::size_t>& common, const Segment3& segment_w, const EdgeLook& look,
                      std::set<Edge>& used) {
  LineCandidate candidate{segment_w};
  int visible = 0;
  for (std::size_t k = 0; k < common.size(); ++k) {
    if (visible >= kFirstLook && candidate.supporters < kLeastFirst) break;
    const SegmentView& view = views[common[k]];
    const LineSupport support = supportOf(view, seenSegment(view, segment_w), params.tolerance_px, false, &look);
    if (!support.visible) continue;
    ++visible;
    if (support.cover < params.least_cover) continue;
    candidate.score += std::min(1.0, support.cover);
    ++candidate.supporters;
    for (const std::size_t t : support.by) used.insert({common[k], t});
  }
  return candidate;
}

}  // namespace

std::optional<Segment3> searchLine(const DensifyParams& params, const std::vector<SegmentView>& views,
                                   const std::vector<std::size_t>& common, std::size_t i, std::size_t s) {
  std::optional<LineCandidate> best;
  std::set<Edge> used;  // by candidates that have been looked for: the same line again
  const EdgeLook look(views[i].segments[s]);
  const std::size_t partners = std::min(common.size(), static_cast<std::size_t>(params.partners));
  for (std::size_t k = 0; k < partners; ++k) {
    const SegmentView& other = views[common[k]];
    for (std::size_t t = 0; t < other.size(); ++t) {
      if (other.taken[t] || used.count({common[k], t}) > 0) continue;
      if (!look.maybeSame(EdgeLook(other.segments[t]))) continue;
      const auto segment = pairOf(views[i], s, other, t);
      if (!segment) continue;
      const LineCandidate candidate = lookFor(params, views, common, *segment, look, used);
      if (candidate.supporters + 1 >= params.min_keyframes && (!best || candidate.score > best->score))
        best = candidate;
    }
  }
  if (!best) return std::nullopt;
  return best->segment_w;
}

}  // namespace lintel
