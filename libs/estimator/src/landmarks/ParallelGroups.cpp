// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/ParallelGroups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "landmarks/EndpointTriangulation.h"
#include "landmarks/LineDegeneracy.h"
#include "landmarks/LineTriangulation.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr double kKnown_rad = 0.03;        // a direction known this well supports a group
constexpr double kSame_rad = 0.035;        // directions closer than this are taken as one
constexpr double kApart_rad = 0.10;        // a new direction is at least this far from the others
constexpr double kLeastSigma_rad = 0.004;  // of an observation plane: poses and calibration have errors too
constexpr double kRandomShare = 0.05;      // share of arbitrary lines whose planes contain a given direction, at most
constexpr double kContradiction_rad = 0.08, kContradiction = 2.5;  // of ends with a direction; in standard deviations
constexpr FrameId kForget = 100;  // window frames after which an unused direction is forgotten

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {  // unit vectors without sign
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

Eigen::Vector3d directionOf(const LineTrack& track) {
  return lineFromBlock(track.line.data()).plucker().d.normalized();
}

struct Rays {
  Eigen::Vector3d start_w, end_w;  // unit
};

Rays raysOf(const CameraPoses& poses, const LineSighting& s) {
  const Eigen::Quaterniond R_w_c = poses.T_w_c(s.frame).q;
  return {R_w_c * s.start.corrected(poses.correction()).normalized(),
          R_w_c * s.end.corrected(poses.correction()).normalized()};
}

bool isMember(const LineTrack& track) { return track.triangulated && track.group != 0; }
bool isCandidate(const LineTrack& track) {
  return track.group == 0 && track.degenerate() && track.sightings.size() > 1;
}
bool isWitness(const LineTrack& track) {
  return track.triangulated && !track.degenerate() && track.sigma_direction_rad < kKnown_rad;
}

/// Whether a degenerate line may have this direction: its planes contain it, and its end points do not contradict. Ends
/// that may still do so are waited for.
bool mayBeParallel(const CameraPoses& poses, const EstimatorParams& params, const LineTrack& track,
                   const Eigen::Vector3d& d_w, double max_misfit) {
  if (directionMisfit(poses, params, track, d_w) > max_misfit) return false;
  const SeenEnds ends = triangulateEnds(poses, track);
  if (ends.verdict == EndsVerdict::kTooEarly) return track.group != 0;
  if (ends.verdict == EndsVerdict::kNoCorners) return true;
  const double angle = angleBetween((ends.end_w - ends.start_w).normalized(), d_w);
  return angle <= std::max(kContradiction_rad, kContradiction * ends.sigma_direction_rad);
}

double medianDepth(const SlidingWindow& window) {
  const Pose T_c_w = window.T_w_c(window.frames.back()).inverse();
  std::vector<double> depths;
  for (const auto& [id, track] : window.points)
    if (track.triangulated) depths.push_back((T_c_w * window.positionOf(track)).z());
  return depths.empty() ? 5 : std::max(0.5, upperMedian(depths));
}

/// Gives a line the group's direction within its newest plane, and the depth of its ends where they show one.
void joinGroup(const CameraPoses& poses, LineTrack& track, std::uint64_t group, const Eigen::Vector3d& d_w,
               double depth) {
  const LineSighting& newest = track.sightings.back();
  const Rays rays = raysOf(poses, newest);
  const Pose& T_w_c = poses.T_w_c(newest.frame);
  const Eigen::Vector3d n_w = rays.start_w.cross(rays.end_w).normalized();
  const Eigen::Vector3d d = (d_w - d_w.dot(n_w) * n_w).normalized();
  Eigen::Vector3d p_w = T_w_c.p + depth * (rays.start_w + rays.end_w).normalized();
  if (const SeenEnds ends = triangulateEnds(poses, track); ends.verdict == EndsVerdict::kCorners)
    p_w = 0.5 * (ends.start_w + ends.end_w);
  track.origin_w = T_w_c.p;
  track.line = toBlock(toOrthonormal(movedOrigin(lineThrough(p_w, p_w + d), track.origin_w)));
  track.group = group;
  track.triangulated = true;
  track.distance_known = false;
  track.sigma_distance_m = std::numeric_limits<double>::infinity();
  track.sigma_direction_rad = kKnown_rad;
}

/// Whether the direction of a line is known without its group; if so the line takes that.
bool isKnownWithoutGroup(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track) {
  if (track.distance_known) return !track.degenerate();
  LineTrack own = track;
  own.group = 0;
  own.distance_known = true;
  if (!triangulateLine(poses, params, own) || own.degenerate()) return false;
  track = own;
  return true;
}

/// Triangulates a member with the shared direction if its distance is not known or no longer fits its sightings.
void triangulateMember(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track, double depth) {
  const std::uint64_t group = track.group;
  const Eigen::Vector3d d_w = poses.window().directions.at(group).d_w;
  if (track.distance_known && lineError(poses, track) <= params.landmarks.line_max_error_px) return;
  joinGroup(poses, track, group, d_w, depth);
  track.distance_known = triangulateTied(poses, params, track, d_w);
}

/// Members whose sightings contradict the direction, or whose own direction is known by now, leave their group; the
/// others are triangulated with it.
void updateMembers(SlidingWindow& window, const CameraPoses& poses, const EstimatorParams& params, double depth) {
  for (auto& [id, track] : window.lines) {
    if (track.group == 0) continue;
    if (static_cast<int>(track.sightings.size()) < params.landmarks.line_min_observations) continue;
    const bool fits =
        mayBeParallel(poses, params, track, window.directions.at(track.group).d_w, 1.5 * params.degeneracy.max_misfit);
    if (fits && !isKnownWithoutGroup(poses, params, track)) {
      triangulateMember(poses, params, track, depth);
    } else {
      track.group = 0;
      track.distance_known = true;
      triangulateLine(poses, params, track);  // what it had was the group's direction, not its own
    }
  }
}

/// Degenerate lines join the group whose direction fits them best, if one does.
void joinExisting(SlidingWindow& window, const CameraPoses& poses, const EstimatorParams& params, double depth) {
  for (auto& [id, track] : window.lines) {
    if (!isCandidate(track)) continue;
    std::uint64_t best = 0;
    double least = params.degeneracy.max_misfit;
    for (const auto& [group, direction] : window.directions)
      if (const double misfit = directionMisfit(poses, params, track, direction.d_w); misfit < least) {
        least = misfit;
        best = group;
      }
    if (best != 0 && mayBeParallel(poses, params, track, window.directions.at(best).d_w, params.degeneracy.max_misfit))
      joinGroup(poses, track, best, window.directions.at(best).d_w, depth);
  }
}

/// Directions that might be shared: of lines whose direction is known, of the motion, of gravity.
std::vector<Eigen::Vector3d> possibleDirections(const SlidingWindow& window) {
  std::vector<Eigen::Vector3d> result{Eigen::Vector3d::UnitZ()};
  const Eigen::Vector3d way = window.T_w_c(window.frames.back()).p - window.T_w_c(window.frames.front()).p;
  if (way.norm() > 0.05) result.push_back(way.normalized());
  for (const auto& [id, track] : window.lines)
    if (isWitness(track)) result.push_back(directionOf(track));
  return result;
}

struct Support {
  double score = 0;    // lines that agree, less those expected of random lines
  int candidates = 0;  // degenerate ones
  Eigen::Vector3d d_w = Eigen::Vector3d::Zero();
};

Support supportOf(SlidingWindow& window, const CameraPoses& poses, const EstimatorParams& params,
                  const Eigen::Vector3d& d_w) {
  Support support;
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  // the shared direction is perpendicular to all of them
  int lines = 0;
  for (auto& [id, track] : window.lines) {
    if (track.verdict == LineVerdict::kNone) continue;
    ++lines;
    if (isWitness(track) && angleBetween(directionOf(track), d_w) < kSame_rad) {
      support.score += 1;
      const Eigen::Vector3d d = directionOf(track);
      normals += (Eigen::Matrix3d::Identity() - d * d.transpose()) / (kKnown_rad * kKnown_rad);
    } else if (isCandidate(track) && mayBeParallel(poses, params, track, d_w, params.degeneracy.max_misfit)) {
      support.score += 1;
      ++support.candidates;
      for (const LineSighting& s : track.sightings) {
        const Rays rays = raysOf(poses, s);
        const Eigen::Vector3d cross = rays.start_w.cross(rays.end_w);
        const double sigma = std::max(kLeastSigma_rad, s.sigma_px / poses.camera().meanFocal() / cross.norm());
        normals += cross.normalized() * cross.normalized().transpose() / (sigma * sigma);
      }
    }
  }
  support.score -= 2 * kRandomShare * lines;
  const SymmetricEigen<3> eigen = symmetricEigen(normals);
  // one plane only, or planes that are all the same, do not determine a direction in them
  const bool determined = eigen.values[1] > 0.01 * eigen.values[2];
  support.d_w = determined ? Eigen::Vector3d(eigen.vectors.col(0)) : d_w;
  return support;
}

/// Starts a group with the direction that most lines support, if these are enough.
void startGroup(SlidingWindow& window, const CameraPoses& poses, const EstimatorParams& params, double depth) {
  Support best;
  for (const Eigen::Vector3d& d_w : possibleDirections(window)) {
    const bool is_new = std::all_of(window.directions.begin(), window.directions.end(), [&](const auto& entry) {
      return angleBetween(entry.second.d_w, d_w) > kApart_rad;
    });
    if (!is_new) continue;
    const Support support = supportOf(window, poses, params, d_w);
    if (support.candidates > 0 && support.score > best.score) best = support;
  }
  if (best.score < params.degeneracy.min_group) return;
  const std::uint64_t id = window.next_direction++;
  window.directions[id].d_w = best.d_w;
  joinExisting(window, poses, params, depth);
}

/// Directions that have had no member for a while are dropped.
void dropUnusedDirections(SlidingWindow& window) {
  const FrameId newest = window.frames.back().id;
  for (const auto& [id, track] : window.lines)
    if (isMember(track)) window.directions.at(track.group).last_used = newest;
  for (auto it = window.directions.begin(); it != window.directions.end();)
    it = it->second.last_used + kForget < newest ? window.directions.erase(it) : std::next(it);
}

}  // namespace

double directionMisfit(const CameraPoses& poses, const EstimatorParams& params, const LineTrack& track,
                       const Eigen::Vector3d& d_w) {
  double sum = 0;
  for (const LineSighting& s : track.sightings) {
    const Rays rays = raysOf(poses, s);
    const double sine = rays.start_w.cross(rays.end_w).norm();
    const double sigma = std::max(kLeastSigma_rad, planeSigma(poses, params.factors, s, d_w));
    const double r = rays.start_w.cross(rays.end_w).dot(d_w) / std::max(sine, 1e-6) / sigma;
    sum += r * r;
  }
  return track.sightings.empty() ? 0 : std::sqrt(sum / static_cast<double>(track.sightings.size()));
}

void groupParallelLines(SlidingWindow& window, const EstimatorParams& params) {
  const double depth = medianDepth(window);
  const CameraPoses poses(window);
  updateMembers(window, poses, params, depth);
  joinExisting(window, poses, params, depth);
  startGroup(window, poses, params, depth);
  dropUnusedDirections(window);
}

}  // namespace lintel
