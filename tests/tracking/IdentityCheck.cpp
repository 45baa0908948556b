// SPDX-License-Identifier: BSD-3-Clause
#include "IdentityCheck.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "lintel/core/Quantiles.h"

namespace lintel::truth {
namespace {

constexpr double kOn_px = 1.5;      ///< both ends this near: on the edge
constexpr double kApart_px = 2;     ///< another edge is this much further off
constexpr double kAway_px = 4;      ///< from the former edge
constexpr double kIsolated_px = 6;  ///< no other edge this near
constexpr double kMaxError_px = 4;
constexpr double kOverlap = 0.5;  ///< of the sighting
constexpr int kAwayFrames = 3;
constexpr int kSightings = 2;
constexpr double kLong = 10;  ///< sightings of a line that give a useful mean
constexpr double kMedianOfNormal = 0.6745;

/// Of absolute values, over that of normally distributed ones of sigma 1; 0 without any.
double scaledMedian(std::vector<double>& values) {
  return values.empty() ? 0 : lowerQuantile(values, 0.5) / kMedianOfNormal;
}

double rootMeanSquare(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / std::max(1.0, static_cast<double>(values.size())));
}

}  // namespace

IdentityCheck::Anchor IdentityCheck::anchorOf(const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                                              const std::vector<SeenEdge>& seen) const {
  Anchor anchor;
  double best = 1e9, second = 1e9;
  const Eigen::Vector2d d = (end - start).normalized();
  const double length = (end - start).norm();
  for (const SeenEdge& edge : seen) {
    const double at_start = edge.line.dot(start.homogeneous()), at_end = edge.line.dot(end.homogeneous());
    const double off = std::max(std::abs(at_start), std::abs(at_end));
    const double a = d.dot(edge.start - start), b = d.dot(edge.end - start);
    const double overlap = std::min(length, std::max(a, b)) - std::max(0.0, std::min(a, b));
    if (overlap < (off < best ? kOverlap : 0.5 * kOverlap) * length) continue;
    if (off >= best) {
      second = std::min(second, off);
      continue;
    }
    second = best;
    best = off;
    anchor = {edge.id, false, at_start, at_end};
  }
  anchor.isolated = second > kIsolated_px && best < kMaxError_px;
  if (!anchor.isolated && (best > kOn_px || second < best + kApart_px)) anchor.edge = -1;
  return anchor;
}

void IdentityCheck::add(const FrameTracks& tracks) {
  const std::vector<SeenEdge> seen = edges_.seenAt(tracks.t_ns);
  const double focal = edges_.camera().meanFocal();
  for (const LineObservation& line : tracks.lines) {
    Track& track = tracks_[line.id];
    ++track.frames;
    const Eigen::Vector2d start = focal * edges_.camera().normalise(line.start_px),
                          end = focal * edges_.camera().normalise(line.end_px);
    track.ends.push_back({tracks.t_ns, {start.x(), start.y(), end.x(), end.y()}});
    const Anchor anchor = anchorOf(start, end, seen);
    double off = 0;
    if (track.edge >= 0) {
      const Eigen::Vector3d former = edges_.lineAt(track.edge, tracks.t_ns);
      off = std::max(std::abs(former.dot(start.homogeneous())), std::abs(former.dot(end.homogeneous())));
    }
    if (anchor.edge < 0) {
      track.away += off > kAway_px;
      continue;
    }
    if (anchor.isolated) {
      errors_[line.id].push_back({anchor.start_px, line.sigma_px});
      errors_[line.id].push_back({anchor.end_px, line.sigma_px});
      if (std::max(std::abs(anchor.start_px), std::abs(anchor.end_px)) > kOn_px) continue;
    }
    ++track.anchored;
    if (track.edge >= 0 && track.edge != anchor.edge && off > kAway_px &&
        sightingsOnlyOn(track, track.edge, anchor.edge) >= kSightings) {
      track.switched = true;
      switches_.push_back({tracks.t_ns, line.id, track.edge, anchor.edge, 0.5 * (line.start_px + line.end_px), off,
                           historyOf(track, track.edge, 12)});
    }
    track.edge = anchor.edge;
    track.away = 0;
  }
}

int IdentityCheck::sightingsOnlyOn(const Track& track, int edge, int other) const {
  int sightings = 0;
  for (const auto& [t_ns, ends] : track.ends) {
    const auto off = [&, time = t_ns, at = ends](int id) {
      const Eigen::Vector3d line = edges_.lineAt(id, time);
      return std::max(std::abs(line.dot(at.head<2>().homogeneous())), std::abs(line.dot(at.tail<2>().homogeneous())));
    };
    sightings += off(edge) < kOn_px && off(other) > kAway_px;
  }
  return sightings;
}

std::string IdentityCheck::historyOf(const Track& track, int edge, std::size_t sightings) const {
  std::string text;
  for (std::size_t i = track.ends.size() - std::min(sightings, track.ends.size()); i < track.ends.size(); ++i) {
    const auto& [t_ns, ends] = track.ends[i];
    const Eigen::Vector3d line = edges_.lineAt(edge, t_ns);
    char cell[48];
    std::snprintf(cell, sizeof cell, " %.1f/%.1f", line.dot(ends.head<2>().homogeneous()),
                  line.dot(ends.tail<2>().homogeneous()));
    text += cell;
  }
  return text;
}

int IdentityCheck::anchored() const {
  return static_cast<int>(
      std::count_if(tracks_.begin(), tracks_.end(), [](const auto& entry) { return entry.second.anchored >= 2; }));
}

int IdentityCheck::switched() const {
  return static_cast<int>(
      std::count_if(tracks_.begin(), tracks_.end(), [](const auto& entry) { return entry.second.switched; }));
}

int IdentityCheck::left() const {
  return static_cast<int>(std::count_if(tracks_.begin(), tracks_.end(), [](const auto& entry) {
    return !entry.second.switched && entry.second.anchored >= 2 && entry.second.away >= kAwayFrames;
  }));
}

IdentityCheck::SigmaRatios IdentityCheck::sigmaRatios() const {
  SigmaRatios result;
  std::vector<double> ratios, errors, within;
  for (const auto& [id, ends] : errors_) {
    double mean[2] = {0, 0};
    const double n = 0.5 * static_cast<double>(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) mean[i % 2] += ends[i].px / n;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      ratios.push_back(std::abs(ends[i].px) / ends[i].sigma_px);
      errors.push_back(std::abs(ends[i].px));
      if (n >= kLong) within.push_back(std::abs(ends[i].px - mean[i % 2]) / ends[i].sigma_px * std::sqrt(n / (n - 1)));
    }
  }
  result.count = ratios.size();
  result.typical = scaledMedian(ratios);
  result.rms = rootMeanSquare(ratios);
  result.within_typical = scaledMedian(within);
  result.within_rms = rootMeanSquare(within);
  result.error_px = scaledMedian(errors);
  result.beyond_3 = static_cast<double>(std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 3; })) /
                    std::max(1.0, static_cast<double>(ratios.size()));
  return result;
}

void IdentityCheck::printSwitches(std::ostream& out) const {
  for (const Switch& s : switches_)
    out << "  " << s.t_ns << " line " << s.id << " from edge " << s.from << " (" << edges_.kind(s.from) << ") to "
        << s.to << " (" << edges_.kind(s.to) << ") at " << static_cast<int>(s.middle_px.x()) << ","
        << static_cast<int>(s.middle_px.y()) << ", " << s.off_px << " px off, seen " << tracks_.at(s.id).frames
        << " frames:" << s.history << "\n";
}

}  // namespace lintel::truth
