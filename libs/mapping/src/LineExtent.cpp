// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "LineViews.h"

namespace lintel {

namespace {

constexpr int kHalvings = 12;     // of an interval: to a four thousandth of it
constexpr double kBorder_px = 8;  // edges end 4 px before the border of the image; half of that counts as there

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

/// Where the position is known best: its standard deviation is the norm of an affine function of the place, and so
/// has one minimum.
double bestPlace(const LineEstimate& line, const std::pair<double, double>& stretch) {
  auto [low, high] = stretch;
  for (int k = 0; k < 2 * kHalvings; ++k) {
    const double third = (high - low) / 3;
    if (line.sigmaPosition(low + third) < line.sigmaPosition(high - third))
      high -= third;
    else
      low += third;
  }
  return 0.5 * (low + high);
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
  const auto open = [&](const Eigen::Vector2d& px) { return !cameras.camera().contains(px, kBorder_px); };
  for (const LineView& v : line.views) {
    std::pair<double, double> stretch;
    if (!v.inlier || !viewStretch(cameras, line.estimate, v, stretch)) continue;
    const auto [start, end] = stretch;
    by_track[v.track].push_back(start < end ? SeenPiece{start, end, open(v.start_px), open(v.end_px)}
                                            : SeenPiece{end, start, open(v.end_px), open(v.start_px)});
  }
  std::optional<std::pair<double, double>> whole;
  for (const auto& [track, pieces] : by_track) {
    const auto piece = coveredStretch(pieces, share);
    if (!piece) continue;
    whole =
        whole ? std::make_pair(std::min(whole->first, piece->first), std::max(whole->second, piece->second)) : *piece;
  }
  return whole;
}

std::optional<std::pair<double, double>> knownPiece(const LineEstimate& line, const std::pair<double, double>& stretch,
                                                    double most_m, double best_most_m) {
  const auto known = [&](double along_m) { return line.sigmaPosition(along_m) <= most_m; };
  if (known(stretch.first) && known(stretch.second)) return stretch;
  const double best = bestPlace(line, stretch);
  if (!(line.sigmaPosition(best) <= best_most_m)) return std::nullopt;
  const auto reach = [&](double end) {
    if (known(end)) return end;
    double inside = best, outside = end;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (inside + outside);
      (known(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  return std::make_pair(reach(stretch.first), reach(stretch.second));
}

Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch) {
  const auto at = [&](double along) -> Eigen::Vector3d {
    return line.estimate.middle_w + along * line.estimate.direction_w;
  };
  bool forward = true;
  for (const LineView& v : line.views) {
    std::pair<double, double> seen;
    if (!v.inlier || !viewStretch(cameras, line.estimate, v, seen)) continue;
    forward = seen.second >= seen.first;
    break;
  }
  return forward ? Segment3{at(stretch.first), at(stretch.second)} : Segment3{at(stretch.second), at(stretch.first)};
}

}  // namespace lintel
