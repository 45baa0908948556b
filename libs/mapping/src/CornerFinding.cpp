// SPDX-License-Identifier: BSD-3-Clause
#include "CornerFinding.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr double kMeetSigmas = 2;         // between two lines that meet
constexpr double kMostGapSigma_m = 0.02;  // of their gap: less known lines may meet anything
constexpr double kMostMissing_m = 0.15;   // of a line up to its corner, which no image may have shown, and at most
constexpr double kMissingShare = 0.5;     // of its length
constexpr double kMostChi2 = 4;           // of a corner's lines, for each degree of freedom
constexpr double kSamePlace_m = 0.05;     // two meetings of a line that are nearer may be one corner

struct Corner {
  Eigen::Vector3d p_w;
  double sigma_m = 0;
  std::vector<std::size_t> lines;
};

struct Meeting {
  double sigmas = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const Meeting& o) const { return std::tie(sigmas, a, b) < std::tie(o.sigmas, o.a, o.b); }
};

class CornerFinder {
 public:
  explicit CornerFinder(const std::vector<SpatialLine>& lines) : lines_(lines), corners_of_(lines.size()) {}

  std::vector<Corner> run(const std::vector<LineNeighbours>& neighbours) {
    std::vector<Meeting> meetings;
    for (std::size_t a = 0; a < neighbours.size(); ++a)
      for (const std::size_t b : neighbours[a])
        if (Meeting meeting{0, a, b}; a < b && meet(meeting)) meetings.push_back(meeting);
    std::sort(meetings.begin(), meetings.end());
    for (const Meeting& meeting : meetings)
      if (const auto corner = cornerOf({meeting.a, meeting.b}); corner && !joins(meeting, *corner)) keep(*corner);
    return std::move(corners_);
  }

 private:
  static double missing(const SpatialLine& line) { return std::min(kMostMissing_m, kMissingShare * 2 * line.half_m); }

  /// Whether the line was seen there, or nearly.
  static bool reaches(const SpatialLine& line, double along_m) {
    return std::abs(along_m) <= line.half_m + missing(line);
  }
  static bool endsAt(const SpatialLine& line, double along_m) {
    return std::abs(along_m) >= line.half_m - missing(line);
  }

  bool meet(Meeting& meeting) const {
    const SpatialLine &a = lines_[meeting.a], &b = lines_[meeting.b];
    Approach near;
    if (!approachOf(a, b, near) || !reaches(a, near.along_a_m) || !reaches(b, near.along_b_m)) return false;
    if (!endsAt(a, near.along_a_m) && !endsAt(b, near.along_b_m)) return false;
    const double sigma_m =
        std::sqrt(a.varianceAt(near.along_a_m, near.normal_w) + b.varianceAt(near.along_b_m, near.normal_w));
    meeting.sigmas = near.gap_m / sigma_m;
    return sigma_m <= kMostGapSigma_m && meeting.sigmas <= kMeetSigmas;
  }

  /// The place that lies on all of these lines, weighted by their covariances.
  std::optional<Corner> cornerOf(const std::vector<std::size_t>& of) const {
    Corner corner;
    corner.lines = of;
    Approach near;
    if (!approachOf(lines_[of[0]], lines_[of[1]], near)) return std::nullopt;
    corner.p_w = 0.5 * (lines_[of[0]].at(near.along_a_m) + lines_[of[1]].at(near.along_b_m));
    double chi2 = 0;
    for (int pass = 0; pass < 2; ++pass) {  // the second one with the covariances where the first one was
      Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      double squares = 0;
      for (const std::size_t i : of) {
        const SpatialLine& line = lines_[i];
        const double along_m = (corner.p_w - line.middle_w).dot(line.direction_w);
        const Eigen::Matrix3d P = line.across * line.covarianceAt(along_m).inverse().eval() * line.across.transpose();
        const Eigen::Vector3d off = line.middle_w - corner.p_w;
        H += P, b += P * off, squares += off.dot(P * off);
      }
      const Eigen::Vector3d step = solveLdlt<3>(H, b);
      corner.p_w += step;
      chi2 = squares - b.dot(step);
      corner.sigma_m = 1 / std::sqrt(std::max(1e-12, symmetricEigen<3>(H).values[0]));
    }
    if (!corner.p_w.allFinite() || !(chi2 <= kMostChi2 * (2 * static_cast<double>(of.size()) - 3))) return std::nullopt;
    for (const std::size_t i : of)
      if (!reaches(lines_[i], (corner.p_w - lines_[i].middle_w).dot(lines_[i].direction_w))) return std::nullopt;
    return corner;
  }

  /// Whether a corner that is there is the same; it gets the line that it did not have.
  bool joins(const Meeting& meeting, const Corner& corner) {
    std::vector<std::size_t> near = corners_of_[meeting.a];
    near.insert(near.end(), corners_of_[meeting.b].begin(), corners_of_[meeting.b].end());
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::size_t c : near) {
      if (!((corners_[c].p_w - corner.p_w).norm() <= kSamePlace_m)) continue;
      std::vector<std::size_t> all = corners_[c].lines;
      for (const std::size_t i : {meeting.a, meeting.b})
        if (std::find(all.begin(), all.end(), i) == all.end()) all.push_back(i);
      if (all.size() == corners_[c].lines.size()) return true;
      const auto both = cornerOf(all);
      if (!both) continue;
      corners_of_[all.back()].push_back(c);
      corners_[c] = *both;
      return true;
    }
    return false;
  }

  void keep(const Corner& corner) {
    for (const std::size_t i : corner.lines) corners_of_[i].push_back(corners_.size());
    corners_.push_back(corner);
  }

  const std::vector<SpatialLine>& lines_;
  std::vector<Corner> corners_;
  std::vector<std::vector<std::size_t>> corners_of_;
};

}  // namespace

std::vector<MapCorner> findCorners(const LineMap& map, const std::vector<SpatialLine>& lines,
                                   const std::vector<LineNeighbours>& neighbours) {
  std::vector<MapCorner> corners;
  for (const Corner& found : CornerFinder(lines).run(neighbours)) {
    MapCorner corner{found.p_w, found.sigma_m, {}};
    for (const std::size_t i : found.lines) corner.lines.push_back(map.lines[i].id);
    std::sort(corner.lines.begin(), corner.lines.end());
    corners.push_back(std::move(corner));
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const MapCorner& a, const MapCorner& b) { return a.lines < b.lines; });
  return corners;
}

}  // namespace lintel
