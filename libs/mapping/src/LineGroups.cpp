// SPDX-License-Identifier: BSD-3-Clause
#include "LineGroups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr std::size_t kMostGroups = 12,
                      kMostCandidates = 400;  // the longest lines: the search is quadratic

/// Length counts, but not without limit: one long beam is no group.
double weightOf(const MapLine& line) { return std::min(line.segment_w.length(), 3.0); }

class GroupFinder {
 public:
  GroupFinder(const GroupParams& params, std::vector<MapLine>& lines) : params_(params), lines_(lines) {
    for (MapLine& line : lines_) {
      line.group = -1;
      directions_.push_back(line.segment_w.length() > 0 ? line.segment_w.direction() : Eigen::Vector3d::UnitX());
      total_ += weightOf(line);
    }
    order_.resize(lines_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return weightOf(lines_[a]) > weightOf(lines_[b]); });
  }

  std::vector<MapGroup> run() {
    std::vector<MapGroup> groups;
    while (groups.size() < kMostGroups) {
      Eigen::Vector3d axis = heaviestAxis();
      if (axis.isZero()) break;
      for (int i = 0; i < 5; ++i) axis = meanOfMembers(axis);
      MapGroup group;
      group.direction_w = axis;
      if (!claim(static_cast<int>(groups.size()), group)) break;
      groups.push_back(group);
    }
    return groups;
  }

 private:
  bool isMember(std::size_t i, const Eigen::Vector3d& axis) const {
    return lines_[i].group < 0 && lineAngle(directions_[i], axis) <= params_.max_angle_rad;
  }

  Eigen::Vector3d heaviestAxis() const {
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double most = 0;
    std::size_t candidates = 0;
    for (const std::size_t c : order_) {
      if (lines_[c].group >= 0) continue;
      if (++candidates > kMostCandidates) break;
      double weight = 0;
      for (std::size_t i = 0; i < lines_.size(); ++i)
        if (isMember(i, directions_[c])) weight += weightOf(lines_[i]);
      if (weight > most) most = weight, best = directions_[c];
    }
    return best;
  }

  Eigen::Vector3d meanOfMembers(const Eigen::Vector3d& axis) const {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (isMember(i, axis)) scatter += weightOf(lines_[i]) * directions_[i] * directions_[i].transpose();
    if (scatter.isZero()) return axis;
    Eigen::Vector3d mean = symmetricEigen(scatter).vectors.col(2);
    Eigen::Index largest;
    mean.cwiseAbs().maxCoeff(&largest);
    if (mean[largest] < 0) mean = -mean;  // the sign means nothing; this one is always the same
    return mean;
  }

  bool claim(int id, MapGroup& group) {
    std::vector<std::size_t> members;
    double weight = 0, squares = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!isMember(i, group.direction_w)) continue;
      members.push_back(i);
      weight += weightOf(lines_[i]);
      squares += weightOf(lines_[i]) * std::pow(lineAngle(directions_[i], group.direction_w), 2);
    }
    if (static_cast<int>(members.size()) < params_.min_lines || weight < params_.min_share * total_) return false;
    for (const std::size_t i : members) lines_[i].group = id;
    group.spread_rad = std::sqrt(squares / weight);
    return true;
  }

  const GroupParams& params_;
  std::vector<MapLine>& lines_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<std::size_t> order_;
  double total_ = 0;
};

void nameGroups(std::vector<MapGroup>& groups) {
  constexpr double kUpright = 0.09;  // 5 degrees
  int horizontal = 0, slanted = 0, vertical = 0;
  for (MapGroup& group : groups) {
    const double from_up = lineAngle(group.direction_w, Eigen::Vector3d::UnitZ());
    if (from_up < kUpright) {
      group.name = ++vertical == 1 ? "vertical" : "vertical " + std::to_string(vertical);
    } else if (from_up > M_PI / 2 - kUpright) {
      group.name = "horizontal " + std::to_string(++horizontal);
    } else {
      group.name = "slanted " + std::to_string(++slanted);
    }
  }
}

}  // namespace

double sigmaOf(const MapGroup& group) {
  constexpr double kLeast_rad = 0.005;  // edges of buildings are not more parallel than that
  return std::max(kLeast_rad, group.spread_rad);
}

std::vector<bool> certainGroups(const LineMap& map) {
  constexpr double kLeastShare = 0.10;  // of the map's length: smaller groups also arise among random lines
  std::vector<double> lengths(map.groups.size(), 0.0);
  double total = 0;
  for (const MapLine& line : map.lines) {
    total += line.segment_w.length();
    if (line.group >= 0) lengths[static_cast<std::size_t>(line.group)] += line.segment_w.length();
  }
  std::vector<bool> certain;
  certain.reserve(lengths.size());
  for (const double length : lengths) certain.push_back(length >= kLeastShare * total);
  return certain;
}

std::vector<MapGroup> findGroups(const GroupParams& params, std::vector<MapLine>& lines) {
  std::vector<MapGroup> groups = GroupFinder(params, lines).run();
  nameGroups(groups);
  return groups;
}

}  // namespace lintel
