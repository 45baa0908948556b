// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/LineErrors.h"

#include <algorithm>
#include <utility>

#include "EdgeCover.h"
#include "LineMatching.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

struct AlignedLine {
  Segment3 segment;
  const MapLine* line;
};

std::vector<AlignedLine> alignedLines(const std::vector<MapLine>& lines, const Similarity& S_truth_map) {
  std::vector<AlignedLine> result;
  for (const MapLine& line : lines) {
    const Segment3 segment{S_truth_map * line.segment_w.start, S_truth_map * line.segment_w.end};
    if (segment.length() > 1e-6 && segment.start.allFinite() && segment.end.allFinite())
      result.push_back({segment, &line});
  }
  return result;
}

/// Shares of a length, one for each tolerance.
class Shares {
 public:
  explicit Shares(std::vector<double> tolerances_m)
      : tolerances_m_(std::move(tolerances_m)), right_m_(tolerances_m_.size(), 0.0) {}

  /// A piece of `length_m` that is `distance_m` off.
  void add(double length_m, double distance_m) {
    total_m_ += length_m;
    for (std::size_t i = 0; i < right_m_.size(); ++i)
      if (distance_m <= tolerances_m_[i]) right_m_[i] += length_m;
  }
  std::vector<double> result() const {
    std::vector<double> shares;
    for (const double right_m : right_m_) shares.push_back(right_m / total_m_);  // 0 / 0 is NaN: no length
    return shares;
  }

 private:
  std::vector<double> tolerances_m_, right_m_;
  double total_m_ = 0;
};

/// Collects the errors of matched segments.
class ErrorCollector {
 public:
  void add(const Segment3& segment, const Segment3& edge) {
    direction_rad_.push_back(lineAngle(segment.direction(), edge.direction()));
    distance_m_.push_back(0.5 * (distanceToSegment(segment.start, edge) + distanceToSegment(segment.end, edge)));
  }
  SegmentErrors result() const {
    return {direction_rad_.size(), quantile(direction_rad_, 0.5), quantile(direction_rad_, 0.9),
            quantile(distance_m_, 0.5)};
  }

 private:
  static double quantile(std::vector<double> values, double q) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    return upperQuantile(values, q);
  }

  std::vector<double> direction_rad_, distance_m_;
};

void addPrecision(LineErrors& result, const std::vector<AlignedLine>& lines, const std::vector<TrueLine>& truth,
                  const LineErrorParams& params) {
  Shares precision(params.tolerances_m);
  ErrorCollector all, degenerate, well_determined, constrained;
  EdgeCover cover;
  const BoxIndex index = indexOf(truth);
  for (const AlignedLine& line : lines) {
    const LineMatch match = matchLine(line.segment, truth, index, params);
    const double piece_m = line.segment.length() / static_cast<double>(match.distances_m.size());
    for (const double distance_m : match.distances_m) precision.add(piece_m, distance_m);
    if (!match.edge) continue;
    const Segment3& edge = truth[*match.edge].segment_w;
    all.add(line.segment, edge);
    (line.line->degenerate ? degenerate : well_determined).add(line.segment, edge);
    if (line.line->constrained) constrained.add(line.segment, edge);
    cover.add(*match.edge, *line.line, line.segment, edge);
  }
  result.precision = precision.result();
  result.all_matched = all.result();
  result.degenerate_matched = degenerate.result();
  result.well_determined_matched = well_determined.result();
  result.constrained_matched = constrained.result();
  result.duplicates = cover.duplicates();
  result.true_duplicates = cover.trueDuplicates();
}

void addSurfacePrecision(LineErrors& result, const std::vector<AlignedLine>& lines, const LineErrorParams& params,
                         const SurfaceDistanceFunction& surface_distance) {
  Shares precision(params.tolerances_m), inliers(params.tolerances_m);
  for (const AlignedLine& line : lines) {
    const auto pieces = piecesOf(line.segment, params.step_m);
    const double piece_m = line.segment.length() / static_cast<double>(pieces.size());
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : pieces) {
      const double distance_m = surface_distance(p);
      precision.add(piece_m, distance_m);
      nearest_m = std::min(nearest_m, distance_m);
    }
    inliers.add(1, nearest_m);
  }
  result.surface_precision = precision.result();
  result.surface_lines = inliers.result();
  for (const double share : result.surface_precision) result.surface_length_m.push_back(share * result.length_m);
}

void addRecall(LineErrors& result, const std::vector<AlignedLine>& lines, const std::vector<TrueLine>& truth,
               const LineErrorParams& params) {
  constexpr double kBeside_m = 0.2;  // lines farther off cannot matter: above any tolerance
  const auto reach_m = [](const AlignedLine& line) { return 0.5 * line.segment.length() + kBeside_m; };
  std::vector<BoxIndex::Box> boxes;
  boxes.reserve(lines.size());
  for (const AlignedLine& line : lines) boxes.push_back(boxAroundMiddle(line.segment, reach_m(line)));
  const BoxIndex index(boxes);
  Shares recall(params.tolerances_m);
  for (const TrueLine& true_line : truth) {
    const Segment3& edge = true_line.segment_w;
    if (edge.length() < params.observable_length_m || true_line.frames_seen < params.observable_frames) continue;
    result.observable_m += edge.length();
    std::vector<const Segment3*> near;
    for (const std::size_t i : index.touching(boxOf(edge)))
      if (lineAngle(lines[i].segment.direction(), edge.direction()) < params.max_angle_rad &&
          distanceToSegment(lines[i].segment.midpoint(), edge) < reach_m(lines[i]))
        near.push_back(&lines[i].segment);
    const auto pieces = piecesOf(edge, params.step_m);
    for (const Eigen::Vector3d& p : pieces) {
      double distance_m = std::numeric_limits<double>::infinity();
      for (const Segment3* segment : near) distance_m = std::min(distance_m, distanceToSegment(p, *segment));
      recall.add(edge.length() / static_cast<double>(pieces.size()), distance_m);
    }
  }
  result.recall = recall.result();
}

}  // namespace

LineErrors evaluateLines(const std::vector<MapLine>& lines, const Similarity& S_truth_map,
                         const std::vector<TrueLine>& truth, const LineErrorParams& params,
                         const SurfaceDistanceFunction& surface_distance) {
  const std::vector<AlignedLine> aligned = alignedLines(lines, S_truth_map);
  LineErrors result;
  result.tolerances_m = params.tolerances_m;
  result.lines = aligned.size();
  for (const AlignedLine& line : aligned) {
    result.degenerate += line.line->degenerate ? 1 : 0;
    result.constrained += line.line->constrained ? 1 : 0;
    result.length_m += line.segment.length();
  }
  addPrecision(result, aligned, truth, params);
  addRecall(result, aligned, truth, params);
  if (surface_distance) addSurfacePrecision(result, aligned, params, surface_distance);
  return result;
}

}  // namespace lintel
