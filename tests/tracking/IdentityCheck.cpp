// SPDX-License-Identifier: BSD-3-Clause
#include "IdentityCheck.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace lintel::truth {
namespace {

constexpr double kOn_px = 1.5;        ///< both ends this near: on the edge
constexpr double kApart_px = 2;       ///< another edge is this much further off
constexpr double kAway_px = 4;        ///< from the former edge
constexpr double kIsolated_px = 6;    ///< no other edge this near
constexpr double kMaxError_px = 4;
constexpr double kOverlap = 0.5;      ///< of the sighting
constexpr int kAwayFrames = 3;

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
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
    Life& life = lives_[line.id];
    ++life.frames;
    const Eigen::Vector2d start = focal * edges_.camera().normalise(line.start_px),
                          end = focal * edges_.camera().normalise(line.end_px);
    const Anchor anchor = anchorOf(start, end, seen);
    double off = 0;
    if (life.edge >= 0) {
      const Eigen::Vector3d former = edges_.lineAt(life.edge, tracks.t_ns);
      off = std::max(std::abs(former.dot(start.homogeneous())), std::abs(former.dot(end.homogeneous())));
    }
    if (anchor.edge < 0) {
      life.away += off > kAway_px;
      continue;
    }
    if (anchor.isolated) {
      errors_.emplace_back(std::abs(anchor.start_px), line.sigma_px);
      errors_.emplace_back(std::abs(anchor.end_px), line.sigma_px);
      if (std::max(std::abs(anchor.start_px), std::abs(anchor.end_px)) > kOn_px) continue;
    }
    ++life.anchored;
    if (life.edge >= 0 && life.edge != anchor.edge && off > kAway_px) {
      life.switched = true;
      switches_.push_back({tracks.t_ns, line.id, life.edge, anchor.edge, 0.5 * (line.start_px + line.end_px), off});
    }
    life.edge = anchor.edge;
    life.away = 0;
  }
}

int IdentityCheck::anchored() const {
  return static_cast<int>(
      std::count_if(lives_.begin(), lives_.end(), [](const auto& entry) { return entry.second.anchored >= 2; }));
}

int IdentityCheck::switched() const {
  return static_cast<int>(
      std::count_if(lives_.begin(), lives_.end(), [](const auto& entry) { return entry.second.switched; }));
}

int IdentityCheck::left() const {
  return static_cast<int>(std::count_if(lives_.begin(), lives_.end(), [](const auto& entry) {
    return !entry.second.switched && entry.second.anchored >= 2 && entry.second.away >= kAwayFrames;
  }));
}

IdentityCheck::SigmaRatios IdentityCheck::sigmaRatios() const {
  SigmaRatios result;
  result.count = errors_.size();
  std::vector<double> ratios, errors;
  double squares = 0;
  for (const auto& [error, sigma] : errors_) {
    ratios.push_back(error / sigma);
    errors.push_back(error);
    squares += ratios.back() * ratios.back();
    result.beyond_3 += ratios.back() > 3;
  }
  if (ratios.empty()) return result;
  const auto n = static_cast<double>(ratios.size());
  result.beyond_3 /= n;
  result.rms = std::sqrt(squares / n);
  result.typical = quantile(ratios, 0.5) / 0.6745;
  result.error_px = quantile(errors, 0.5) / 0.6745;
  return result;
}

void IdentityCheck::printSwitches(std::ostream& out) const {
  for (const Switch& s : switches_)
    out << "  " << s.t_ns << " line " << s.id << " from edge " << s.from << " (" << edges_.kind(s.from) << ") to " << s.to
        << " (" << edges_.kind(s.to) << ") at " << static_cast<int>(s.middle_px.x()) << ","
        << static_cast<int>(s.middle_px.y()) << ", " << s.off_px << " px off, seen " << lives_.at(s.id).frames
        << " frames\n";
}

}  // namespace lintel::truth
