// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/LineSpacing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "LineGroups.h"
#include "SpatialIndex.h"
#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

namespace {

constexpr double kParallel_rad = 0.26;  // 15 degrees
constexpr double kMuchBetter = 3;       // times the evidence: such a line suppresses others within twice the width
constexpr double kBeside = 0.5;         // share of a line that runs beside others
constexpr int kMostSamples = 2000;      // of a line, however long

class LineSpacer {
 public:
  LineSpacer(const SpacingParams& params, const LineMap& map) : params_(params), lines_(map.lines) {
    std::map<std::uint64_t, Eigen::Vector3d> cameras;
    for (const MapKeyframe& k : map.keyframes) cameras[k.id] = (k.T_w_b * map.rig.T_b_c).p;
    for (const MapLine& line : lines_) {
      widths_.push_back(widthOf(line, cameras));
      evidence_.push_back(static_cast<double>(line.observations.size()) * line.segment_w.length());
    }
  }

  /// Whether each line stays.
  std::vector<bool> kept() const {
    const auto beside = neighbours();
    std::vector<std::size_t> order(lines_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return evidence_[a] > evidence_[b]; });
    std::vector<bool> kept(lines_.size(), false);
    for (const std::size_t i : order) kept[i] = !runsBeside(i, beside[i], kept);
    return kept;
  }

 private:
  /// Within how far of a line weaker ones are left out [m].
  double widthOf(const MapLine& line, const std::map<std::uint64_t, Eigen::Vector3d>& cameras) const {
    std::vector<double> distances;
    for (const MapLineObservation& seen : line.observations)
      if (const auto it = cameras.find(seen.keyframe_id); it != cameras.end())
        distances.push_back(distanceToSegment(it->second, line.segment_w));
    if (distances.empty()) return params_.min_m;
    return std::min(params_.min_m, params_.min_relative * upperMedian(distances));
  }

  std::vector<std::vector<std::size_t>> neighbours() const {
    const double cell_m = 2.5 * params_.min_m;  // above twice the width, and what lies between samples
    SpatialIndex index(cell_m);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Segment3& s = lines_[i].segment_w;
      const double steps = std::min<double>(kMostSamples, 1 + std::floor(2 * s.length() / cell_m));
      for (int k = 0; k <= static_cast<int>(steps); ++k) index.add(i, s.start + (s.end - s.start) * (k / steps));
    }
    std::vector<std::vector<std::size_t>> result(lines_.size());
    index.eachPair([&](std::size_t a, std::size_t b) {
      if (lineAngle(lines_[a].segment_w.direction(), lines_[b].segment_w.direction()) > kParallel_rad) return;
      result[a].push_back(b);
      result[b].push_back(a);
    });
    return result;
  }

  /// Whether most of a line lies beside lines that stay.
  bool runsBeside(std::size_t i, const std::vector<std::size_t>& neighbours, const std::vector<bool>& kept) const {
    const Segment3& s = lines_[i].segment_w;
    std::vector<std::pair<double, double>> stretches;
    for (const std::size_t j : neighbours)
      if (kept[j])
        addStretch(s, lines_[j].segment_w, evidence_[j] >= kMuchBetter * evidence_[i] ? 2 * widths_[i] : widths_[i],
                   stretches);
    std::sort(stretches.begin(), stretches.end());
    double covered = 0, end = 0;
    for (const auto& [from, to] : stretches) {
      covered += std::max(0.0, to - std::max(from, end));
      end = std::max(end, to);
    }
    return covered > kBeside * s.length();
  }

  /// Adds the stretch of `s` [m from its start] that lies beside `other`, closer than `width_m` in its middle.
  static void addStretch(const Segment3& s, const Segment3& other, double width_m,
                         std::vector<std::pair<double, double>>& stretches) {
    const Eigen::Vector3d d = s.direction();
    double from = d.dot(other.start - s.start), to = d.dot(other.end - s.start);
    if (from > to) std::swap(from, to);
    from = std::max(from, 0.0), to = std::min(to, s.length());
    if (from >= to) return;
    const Eigen::Vector3d middle = s.start + 0.5 * (from + to) * d, along = other.direction();
    if ((middle - other.start).cross(along).norm() < width_m) stretches.emplace_back(from, to);
  }

  const SpacingParams& params_;
  const std::vector<MapLine>& lines_;
  std::vector<double> widths_, evidence_;
};

}  // namespace

int spaceLines(const MapParams& params, LineMap& map) {
  if (!(params.spacing.min_m > 0)) return 0;
  const std::vector<bool> kept = LineSpacer(params.spacing, map).kept();
  std::size_t at = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    if (at != i) map.lines[at] = std::move(map.lines[i]);
    ++at;
  }
  const auto left_out = static_cast<int>(map.lines.size() - at);
  map.lines.resize(at);
  if (left_out > 0) map.groups = findGroups(params.groups, map.lines);
  return left_out;
}

}  // namespace lintel
