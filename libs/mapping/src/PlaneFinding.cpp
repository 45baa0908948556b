// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneFinding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "PlaneNames.h"
#include "PlanePoints.h"
#include "lintel/geometry/Segment.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr double kPlaneSigmas = 2.5, kPlaneMost_m = 0.03;  // between a line's end and the plane it lies in
constexpr double kPlaneFlatness_m = 0.004;                 // of a plane, which is one sigma as well
constexpr double kSeedSigmas = 2;                          // between the two lines that a plane begins with
constexpr double kSeedSigma_m = 0.02;                      // of their gap, at most
constexpr double kDifferentWays_rad = 0.34;                // directions: 20 degrees
constexpr std::size_t kLeastPlaneLines = 3;
constexpr int kPlanePasses = 6;          // of growing; it ends when nothing changes
constexpr double kSameShare = 0.5;       // of its lines that a plane may have in common with one of about
constexpr double kSameNormal_rad = 0.1;  // its normal

struct Plane {
  Eigen::Vector3d normal_w;
  double offset_m = 0, spread_m = 0, length_m = 0;
  std::vector<std::size_t> lines;  // ascending
};

struct Seed {
  double length_m = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const Seed& o) const { return std::tie(o.length_m, a, b) < std::tie(length_m, o.a, o.b); }
};

class PlaneFinder {
 public:
  PlaneFinder(const std::vector<SpatialLine>& lines, const std::vector<LineNeighbours>& neighbours)
      : lines_(lines), neighbours_(neighbours), planes_of_(lines.size()), visited_(lines.size(), 0) {}

  std::vector<Plane> run() {
    for (const Seed& seed : seeds()) {
      if (shareAPlane(seed.a, seed.b)) continue;
      const auto plane = planeFrom(seed);
      if (!plane || isThere(*plane)) continue;
      for (const std::size_t i : plane->lines) planes_of_[i].push_back(planes_.size());
      planes_.push_back(*plane);
    }
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const Plane& a, const Plane& b) { return a.length_m > b.length_m; });
    return std::move(planes_);
  }

 private:
  std::vector<Seed> seeds() const {
    std::vector<Seed> seeds;
    for (std::size_t a = 0; a < lines_.size(); ++a)
      for (const std::size_t b : neighbours_[a]) {
        Approach near;
        if (b <= a || !approachOf(lines_[a], lines_[b], near)) continue;
        const double sigma_m = std::sqrt(lines_[a].varianceAt(near.along_a_m, near.normal_w) +
                                         lines_[b].varianceAt(near.along_b_m, near.normal_w));
        if (sigma_m > kSeedSigma_m || near.gap_m > kSeedSigmas * sigma_m) continue;
        seeds.push_back({std::min(lines_[a].half_m, lines_[b].half_m), a, b});
      }
    std::sort(seeds.begin(), seeds.end());
    return seeds;
  }

  bool shareAPlane(std::size_t a, std::size_t b) const {
    return std::any_of(planes_of_[a].begin(), planes_of_[a].end(), [&](std::size_t p) {
      return std::binary_search(planes_[p].lines.begin(), planes_[p].lines.end(), b);
    });
  }

  bool fits(const Plane& plane, const SpatialLine& line) const {
    for (const double along_m : {-line.half_m, line.half_m}) {
      const double off_m = std::abs(plane.normal_w.dot(line.at(along_m)) - plane.offset_m);
      const double sigma_m = std::sqrt(line.varianceAt(along_m, plane.normal_w) + kPlaneFlatness_m * kPlaneFlatness_m);
      if (!(off_m <= std::min(kPlaneMost_m, kPlaneSigmas * sigma_m))) return false;
    }
    return true;
  }

  /// The lines that fit and are connected with the seed by such lines.
  std::vector<std::size_t> grow(const Plane& plane, const Seed& seed) {
    ++visit_;
    std::vector<std::size_t> members;
    for (const std::size_t i : {seed.a, seed.b}) {
      visited_[i] = visit_;
      if (fits(plane, lines_[i])) members.push_back(i);
    }
    for (std::size_t at = 0; at < members.size(); ++at)
      for (const std::size_t i : neighbours_[members[at]]) {
        if (visited_[i] == visit_) continue;
        visited_[i] = visit_;
        if (fits(plane, lines_[i])) members.push_back(i);
      }
    std::sort(members.begin(), members.end());
    return members;
  }

  /// Least squares of the lines' ends, weighted by their variances across the former plane.
  void fit(Plane& plane) const {
    double sum = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (int pass = 0; pass < 2; ++pass) {
      for (const std::size_t i : plane.lines)
        for (const double along_m : {-lines_[i].half_m, lines_[i].half_m}) {
          const double weight =
              1 / (lines_[i].varianceAt(along_m, plane.normal_w) + kPlaneFlatness_m * kPlaneFlatness_m);
          const Eigen::Vector3d p = lines_[i].at(along_m);
          if (pass == 0) {
            sum += weight, centre += weight * p;
          } else {
            squares += weight * (p - centre) * (p - centre).transpose();
          }
        }
      if (pass == 0) centre /= sum;
    }
    const SymmetricEigen<3> eigen = symmetricEigen<3>(squares);
    const Eigen::Vector3d n = eigen.vectors.col(0);
    plane.normal_w = n.dot(plane.normal_w) < 0 ? Eigen::Vector3d(-n) : n;
    plane.offset_m = plane.normal_w.dot(centre);
  }

  std::optional<Plane> planeFrom(const Seed& seed) {
    const SpatialLine &a = lines_[seed.a], &b = lines_[seed.b];
    Approach near;
    approachOf(a, b, near);
    Plane plane;
    plane.normal_w = near.normal_w;
    plane.offset_m = 0.5 * near.normal_w.dot(a.middle_w + b.middle_w);
    for (int pass = 0; pass < kPlanePasses; ++pass) {
      std::vector<std::size_t> members = grow(plane, seed);
      if (members.size() < kLeastPlaneLines) return std::nullopt;
      const bool same = members == plane.lines;
      plane.lines = std::move(members);
      if (same) break;
      fit(plane);
    }
    return finish(plane) ? std::optional<Plane>(plane) : std::nullopt;
  }

  /// Length and spread; false when lines of one direction have no third across them.
  bool finish(Plane& plane) const {
    double squares = 0;
    bool different = false;
    for (const std::size_t i : plane.lines) {
      plane.length_m += 2 * lines_[i].half_m;
      different |= lineAngle(lines_[i].direction_w, lines_[plane.lines.front()].direction_w) > kDifferentWays_rad;
      for (const double along_m : {-lines_[i].half_m, lines_[i].half_m})
        squares += std::pow(plane.normal_w.dot(lines_[i].at(along_m)) - plane.offset_m, 2);
    }
    plane.spread_m = std::sqrt(squares / (2 * static_cast<double>(plane.lines.size())));
    return different;
  }

  /// Whether most of it is in a plane that was found before.
  bool isThere(const Plane& plane) const {
    std::map<std::size_t, std::size_t> common;
    for (const std::size_t i : plane.lines)
      for (const std::size_t p : planes_of_[i]) ++common[p];
    return std::any_of(common.begin(), common.end(), [&](const auto& entry) {
      return static_cast<double>(entry.second) > kSameShare * static_cast<double>(plane.lines.size()) &&
             lineAngle(plane.normal_w, planes_[entry.first].normal_w) < kSameNormal_rad;
    });
  }

  const std::vector<SpatialLine>& lines_;
  const std::vector<LineNeighbours>& neighbours_;
  std::vector<Plane> planes_;
  std::vector<std::vector<std::size_t>> planes_of_;
  std::vector<std::size_t> visited_;
  std::size_t visit_ = 0;
};

}  // namespace

std::vector<MapPlane> findPlanes(const LineMap& map, const std::vector<SpatialLine>& lines,
                                 const std::vector<LineNeighbours>& neighbours) {
  std::vector<MapPlane> planes;
  PlanePoints points;
  for (const Plane& found : PlaneFinder(lines, neighbours).run()) {
    MapPlane plane;
    plane.normal_w = found.normal_w, plane.offset_m = found.offset_m, plane.spread_m = found.spread_m;
    for (const std::size_t i : found.lines) {
      plane.lines.push_back(map.lines[i].id);
      points.addLine(planes.size(), map.lines[i].segment_w);
    }
    std::sort(plane.lines.begin(), plane.lines.end());
    planes.push_back(std::move(plane));
  }
  points.assign(map, planes);
  namePlanes(map, planes);
  return planes;
}

}  // namespace lintel
