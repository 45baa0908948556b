// SPDX-License-Identifier: BSD-3-Clause
#include "AgreedEnds.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr double kAlike_px = 6;
constexpr std::size_t kFewest = 3;  // views that agree, and more than half of those that end at all

/// An end that is not cut off by the image's border.
struct ClosedEnd {
  double place = 0, m_per_px = 0;
};

double medianResolution(const std::vector<ClosedEnd>& ends) {
  std::vector<double> values;
  for (const ClosedEnd& end : ends) values.push_back(end.m_per_px);
  return upperMedian(values);
}

/// Closed ends towards greater places, ascending.
std::vector<ClosedEnd> closedEnds(const std::vector<SeenPiece>& pieces) {
  std::vector<ClosedEnd> ends;
  for (const SeenPiece& piece : pieces)
    if (!piece.to_open) ends.push_back({piece.to, piece.to_m_per_px});
  std::sort(ends.begin(), ends.end(), [](const ClosedEnd& x, const ClosedEnd& y) { return x.place < y.place; });
  return ends;
}

/// The last of most of the ends that are alike; empty when they are fewer than half.
std::optional<double> agreedEnd(const std::vector<ClosedEnd>& ends) {
  if (ends.size() < kFewest) return std::nullopt;
  const double alike_m = kAlike_px * medianResolution(ends);
  std::size_t most = 0, last = 0;
  for (std::size_t first = 0, next = 0; first < ends.size(); ++first) {
    while (next < ends.size() && ends[next].place <= ends[first].place + alike_m) ++next;
    if (next - first > most) most = next - first, last = next - 1;
  }
  if (most < kFewest || 2 * most <= ends.size()) return std::nullopt;
  return ends[last].place;
}

/// The end of a stretch towards greater places.
double endWithin(const std::vector<SeenPiece>& pieces, double share, double end_m) {
  const std::vector<ClosedEnd> ends = closedEnds(pieces);
  const std::optional<double> agreed = agreedEnd(ends);
  if (!agreed || *agreed >= end_m) return end_m;
  std::vector<double> past, before;  // m per px of the views' ends
  for (const SeenPiece& piece : pieces) {
    if (piece.to > *agreed && piece.from < *agreed) past.push_back(piece.to_m_per_px);
    if (piece.to <= *agreed && !piece.to_open) before.push_back(piece.to_m_per_px);
  }
  const double all = static_cast<double>(past.size() + before.size());
  if (past.size() < 2 || static_cast<double>(past.size()) >= share * all) return end_m;
  std::nth_element(past.begin(), past.begin() + 1, past.end());
  return past[1] > upperMedian(before) ? *agreed : end_m;
}

}  // namespace

std::pair<double, double> withinAgreedEnds(const std::vector<SeenPiece>& pieces, double share,
                                           std::pair<double, double> stretch) {
  std::vector<SeenPiece> mirrored;
  for (const SeenPiece& p : pieces)
    mirrored.push_back({-p.to, -p.from, p.to_open, p.from_open, p.to_m_per_px, p.from_m_per_px});
  const double to = endWithin(pieces, share, stretch.second), from = -endWithin(mirrored, share, -stretch.first);
  return from < to ? std::make_pair(from, to) : stretch;
}

}  // namespace lintel
