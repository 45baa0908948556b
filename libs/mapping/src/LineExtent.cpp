// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "AgreedEnds.h"
#include "LineViews.h"

namespace lintel {

namespace {

constexpr double kBorder_px = 8;  // edges are cut 4 px before the border, and their ends then fitted

/// What happens at a place of the line to the number of observations that cover it and that end before it.
struct Change {
  double place = 0;
  int covered = 0, missed = 0;
};

std::vector<Change> changesAlong(const std::vector<SeenPiece>& pieces) {
  std::vector<Change> changes;
  for (const SeenPiece& piece : pieces) {
    changes.push_back({piece.from, +1, piece.from_open ? 0 : -1});
    changes.push_back({piece.to, -1, piece.to_open ? 0 : +1});
  }
  std::sort(changes.begin(), changes.end(), [](const Change& x, const Change& y) {
    return x.place != y.place ? x.place < y.place : x.covered > y.covered;
  });
  return changes;
}

}  // namespace

std::optional<std::pair<double, double>> coveredStretch(const std::vector<SeenPiece>& pieces, double share) {
  int covered = 0, missed = 0;
  for (const SeenPiece& piece : pieces) missed += piece.from_open ? 0 : 1;
  const auto well = [&] { return covered >= 2 && covered >= share * (covered + missed); };
  std::optional<double> from;
  double to = 0;
  for (const Change& change : changesAlong(pieces)) {
    const bool before = well();
    covered += change.covered, missed += change.missed;
    if (!before && well() && !from) from = change.place;
    if (before && !well()) to = change.place;
  }
  if (!from || !(to > *from)) return std::nullopt;
  return std::make_pair(*from, to);
}

std::optional<std::pair<double, double>> seenStretch(const KeyframeCameras& cameras, const LineRecord& line,
                                                     double share) {
  std::map<TrackId, std::vector<SeenPiece>> by_track;
  std::vector<SeenPiece> all;
  const auto open = [&](const Eigen::Vector2d& px) { return !cameras.camera().contains(px, kBorder_px); };
  for (const LineView& v : line.views) {
    if (!v.inlier) continue;
    const std::optional<ViewStretch> seen = viewStretch(cameras, line.estimate, v);
    if (!seen) continue;
    const auto [start, end, start_m_per_px, end_m_per_px] = *seen;
    all.push_back(start < end ? SeenPiece{start, end, open(v.start_px.cast<double>()), open(v.end_px.cast<double>()),
                                          start_m_per_px, end_m_per_px}
                              : SeenPiece{end, start, open(v.end_px.cast<double>()), open(v.start_px.cast<double>()),
                                          end_m_per_px, start_m_per_px});
    by_track[v.track].push_back(all.back());
  }
  std::optional<std::pair<double, double>> whole;
  for (const auto& [track, pieces] : by_track) {
    const auto piece = coveredStretch(pieces, share);
    if (!piece) continue;
    whole =
        whole ? std::make_pair(std::min(whole->first, piece->first), std::max(whole->second, piece->second)) : *piece;
  }
  return whole ? std::make_optional(withinAgreedEnds(all, share, *whole)) : whole;
}

Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch) {
  const auto at = [&](double along) -> Eigen::Vector3d {
    return line.estimate.middle_w + along * line.estimate.direction_w;
  };
  bool forward = true;
  for (const LineView& v : line.views) {
    if (!v.inlier) continue;
    const std::optional<ViewStretch> seen = viewStretch(cameras, line.estimate, v);
    if (!seen) continue;
    forward = seen->end >= seen->start;
    break;
  }
  return forward ? Segment3{at(stretch.first), at(stretch.second)} : Segment3{at(stretch.second), at(stretch.first)};
}

}  // namespace lintel
