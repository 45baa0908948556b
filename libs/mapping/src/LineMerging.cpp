// SPDX-License-Identifier: BSD-3-Clause
#include "LineMerging.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "Evidence.h"
#include "LineExtent.h"
#include "LineViews.h"
#include "MergedRecords.h"
#include "SpatialIndex.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/Segment.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

namespace {

constexpr double kLineCell_m = 0.3;  // lines with places nearer than this are always compared
constexpr double kApart =
    200;  // squared standard deviations between two estimates: farther apart they are not compared
constexpr double kAgreeing = 13.3;  // the same, of four numbers: 1 % of the estimates of one line are farther apart

struct LinePair {
  double score = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const LinePair& o) const { return std::tie(score, a, b) < std::tie(o.score, o.a, o.b); }
};

/// Squared Mahalanobis distance of two lines: of their positions, where `a` was seen, and directions, both across `a`.
double mahalanobis2(const LineEstimate& a, const LineEstimate& b) {
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(a.direction_w);
  const double along = (a.middle_w - b.middle_w).dot(a.direction_w) / b.direction_w.dot(a.direction_w);
  const Eigen::Vector3d nearest = b.middle_w + along * b.direction_w;
  const Eigen::Vector3d same_way = b.direction_w.dot(a.direction_w) < 0 ? -b.direction_w : b.direction_w;
  Eigen::Vector4d difference;
  difference << B.transpose() * (nearest - a.middle_w), B.transpose() * same_way;
  const Eigen::Matrix2d turn = B.transpose() * tangentBasis(b.direction_w);
  Eigen::Matrix4d move;
  move << turn, along * turn, Eigen::Matrix2d::Zero(), turn;
  const Eigen::Matrix4d covariance = a.covariance + move * b.covariance * move.transpose();
  return difference.dot(solveLdlt(covariance, difference));
}

class LineMerger {
 public:
  LineMerger(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params,
             const MergeAllowance& allowance, std::vector<LineRecord>& lines)
      : cameras_(cameras),
        fit_(fit),
        params_(params),
        allowance_(allowance),
        lines_(lines),
        merged_(lines.size()),
        refused_(merged_),
        two_(merged_),
        segments_(lines.size()) {
    for (std::size_t i = 0; i < lines.size(); ++i) segments_[i] = drawn(lines[i]);
  }

  int run() {
    int merged = 0;
    const std::vector<LinePair> all = candidates();
    for (const LinePair& candidate : all)
      merged += tryMerge(merged_.rootOf(candidate.a), merged_.rootOf(candidate.b), 0);
    if (allowance_.drift_px > 0) {
      findRivals(all);
      refused_.clear();
      for (const LinePair& candidate : all)
        merged += tryMerge(merged_.rootOf(candidate.a), merged_.rootOf(candidate.b), allowance_.drift_px);
    }
    merged_.compact(lines_);
    return merged;
  }

 private:
  static constexpr double kCoverage = 0.2;  // share of the views that must see a stretch, as in the map

  Segment3 drawn(const LineRecord& line) const {
    if (!line.known) return {};
    const auto stretch = seenStretch(cameras_, line, kCoverage);
    return stretch ? segmentOf(cameras_, line, *stretch) : Segment3{};
  }

  std::vector<LinePair> candidates() const {
    SpatialIndex index(kLineCell_m);
    constexpr int kMostSamples = 2000;  // of lines with wrong, very large extents
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double length = segments_[i].length();
      if (length <= 0) continue;
      const int n = std::min(kMostSamples, 1 + static_cast<int>(2 * length / kLineCell_m));
      for (int k = 0; k <= n; ++k)
        index.add(i, segments_[i].start + (segments_[i].end - segments_[i].start) * (static_cast<double>(k) / n));
    }
    std::vector<LinePair> result;
    index.eachPair([&](std::size_t a, std::size_t b) {
      LinePair candidate{0, a, b};
      if (near(a, b, candidate.score)) result.push_back(candidate);
    });
    std::sort(result.begin(), result.end());
    return result;
  }

  /// The conditions on two segments that are quick to check; `score`: lower is more alike.
  bool near(std::size_t a, std::size_t b, double& score) const {
    const LineRecord &la = lines_[a], &lb = lines_[b];
    const Segment3 &sa = segments_[a], &sb = segments_[b];
    const double angle = lineAngle(la.estimate.direction_w, lb.estimate.direction_w);
    const double known = 2 * std::hypot(la.estimate.sigmaDirection(), lb.estimate.sigmaDirection());
    if (angle > std::clamp(known, 0.5 * params_.max_angle_rad, 2 * params_.max_angle_rad)) return false;
    const bool a_longer = sa.length() >= sb.length();
    const Segment3 &longer = a_longer ? sa : sb, &shorter = a_longer ? sb : sa;
    const Eigen::Vector3d d = longer.direction();
    const auto across = [&](const Eigen::Vector3d& p) { return (p - longer.start).cross(d).norm(); };
    const double offset = across(shorter.midpoint());
    if (offset > std::max(params_.max_offset_m, params_.max_relative_offset * std::max(la.distance_m, lb.distance_m)))
      return false;
    double u0 = (shorter.start - longer.start).dot(d), u1 = (shorter.end - longer.start).dot(d);
    if (u0 > u1) std::swap(u0, u1);
    const double gap = std::max(u0 - longer.length(), -u1);
    if (gap > std::max(params_.max_gap_m, params_.max_relative_gap * shorter.length())) return false;
    score = offset + angle * shorter.length() + std::max(0.0, gap);
    return true;
  }

  /// Whether images show them as two lines.
  bool areSeenAsTwo(std::size_t a, std::size_t b) const {
    if (const auto known = two_.of(a, b)) return *known;
    const SideBySide seen =
        sideBySide(lines_[a].views, lines_[b].views, &LineView::keyframe, params_.min_separation_px);
    const bool two = seen.apart > 0 && 2 * seen.apart > seen.together;
    two_.set(a, b, two);
    return two;
  }

  /// For every line the candidates that are left after merging without drift.
  void findRivals(const std::vector<LinePair>& candidates) {
    rivals_.assign(lines_.size(), {});
    for (const LinePair& candidate : candidates) {
      const std::size_t a = merged_.rootOf(candidate.a), b = merged_.rootOf(candidate.b);
      if (a != b) rivals_[a].push_back(b), rivals_[b].push_back(a);
    }
    for (std::vector<std::size_t>& rivals : rivals_) {
      std::sort(rivals.begin(), rivals.end());
      rivals.erase(std::unique(rivals.begin(), rivals.end()), rivals.end());
    }
  }

  /// Whether `b` is the only line that `a` can be the same as: other lines nearly as close are the same as `b`.
  bool isUnmistakable(std::size_t a, std::size_t b, double score) const {
    constexpr double kRatio = 2;  // of the scores, as in the ratio test of descriptor matching
    return std::all_of(rivals_[a].begin(), rivals_[a].end(), [&](std::size_t rival) {
      const std::size_t c = merged_.rootOf(rival);
      double other = 0;
      return c == a || c == b || !near(a, c, other) || other > kRatio * score || !areSeenAsTwo(b, c);
    });
  }

  /// The brighter side of a track is always on the same side of its direction, so that two tracks of one edge run the
  /// same way.
  bool runTheSameWay(std::size_t a, std::size_t b) const {
    return segments_[a].direction().dot(segments_[b].direction()) > 0;
  }

  bool tryMerge(std::size_t a, std::size_t b, double drift_px) {
    if (a == b) return false;
    if (b < a) std::swap(a, b);
    if (refused_.isYes(a, b)) return false;
    double score = 0;
    std::optional<LineRecord> joint;
    if (mayBeOne(a, b, drift_px, score)) {
      if (drift_px > 0 && (!isUnmistakable(a, b, score) || !isUnmistakable(b, a, score))) return false;
      joint = jointLine(lines_[a], lines_[b], drift_px);
    }
    if (!joint) {
      refused_.set(a, b, true);
      return false;
    }
    lines_[a] = std::move(*joint);
    segments_[a] = drawn(lines_[a]);
    lines_[b] = {};
    merged_.join(a, b);
    return true;
  }

  /// What can be said without fitting, of these two alone.
  bool mayBeOne(std::size_t a, std::size_t b, double drift_px, double& score) const {
    if (!near(a, b, score) || areSeenAsTwo(a, b)) return false;
    const bool same_way = runTheSameWay(a, b);
    if (!same_way && (drift_px > 0 || !allowance_.contrast)) return false;
    if (drift_px > 0) return !shareKeyframe(lines_[a], lines_[b]);
    return mahalanobis2(lines_[a].estimate, lines_[b].estimate) <= (same_way ? kApart : kAgreeing);
  }

  /// One line of both, if it explains their views.
  std::optional<LineRecord> jointLine(const LineRecord& la, const LineRecord& lb, double drift_px) const {
    LineRecord joint = la;
    joint.id = std::min(la.id, lb.id);
    joint.views = mergedViews(la.views, lb.views);
    if (lb.views.size() > la.views.size()) joint.estimate = lb.estimate;
    if (!lb.tie) joint.tie.reset();  // it is enough that one is known from its views
    joint.parallel = la.parallel || lb.parallel;
    joint.mapped = la.mapped && lb.mapped;
    LineFitParams fit = fit_;
    fit.max_error_px += drift_px;
    if (!fitLine(cameras_, fit, joint) || !explains(joint, la, lb, drift_px)) return std::nullopt;
    return joint;
  }

  /// Whether one line explains the views of both: hardly any becomes an outlier and errors stay small.
  bool explains(const LineRecord& joint, const LineRecord& a, const LineRecord& b, double drift_px) const {
    const std::ptrdiff_t before_a = inliersOf(a), before_b = inliersOf(b);
    // both must be explained, also where one has many more views than the other
    const auto kept = [&](const LineRecord& part) {
      std::ptrdiff_t n = 0;
      for (const LineView& v : part.views)
        n += v.inlier && viewError(cameras_, joint.estimate, v) <= fit_.max_error_px + drift_px;
      return n;
    };
    if (10 * kept(a) < 8 * before_a || 10 * kept(b) < 8 * before_b) return false;
    const double separate = (a.error_px * static_cast<double>(before_a) + b.error_px * static_cast<double>(before_b)) /
                            std::max<double>(1, static_cast<double>(before_a + before_b));
    // a line at a depth in between may nearly fit both: the error may be little larger than that of separate fits
    return joint.error_px <=
           std::max(std::min(params_.max_error_px, 1.3 * separate + 0.3), 1.1 * separate) + 0.5 * drift_px;
  }

  const KeyframeCameras& cameras_;
  const LineFitParams& fit_;
  const MergeParams& params_;
  MergeAllowance allowance_;
  std::vector<LineRecord>& lines_;
  MergedRecords merged_;
  PairAnswers refused_;  ///< whether the two cannot be one
  mutable PairAnswers two_;
  std::vector<Segment3> segments_;
  std::vector<std::vector<std::size_t>> rivals_;
};

}  // namespace

int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params,
               const MergeAllowance& allowance, std::vector<LineRecord>& lines) {
  return LineMerger(cameras, fit, params, allowance, lines).run();
}

}  // namespace lintel
