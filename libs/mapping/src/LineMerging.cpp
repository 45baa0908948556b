// SPDX-License-Identifier: BSD-3-Clause
#include "LineMerging.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "LineExtent.h"
#include "SpatialIndex.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

namespace {

constexpr double kCell_m = 0.3;
constexpr double kApart = 200;  // squared standard deviations between two estimates that hardly ever come together

struct Candidate {
  double score = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const Candidate& o) const { return std::tie(score, a, b) < std::tie(o.score, o.a, o.b); }
};

/// How far apart two lines are in space, squared, in standard deviations: their positions and directions across `a`
/// where that was seen.
double apartness(const LineEstimate& a, const LineEstimate& b) {
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
  return difference.dot(covariance.ldlt().solve(difference));
}

class LineMerger {
 public:
  LineMerger(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params, double drift_px,
             std::vector<LineRecord>& lines)
      : cameras_(cameras),
        fit_(fit),
        params_(params),
        drift_px_(drift_px),
        lines_(lines),
        roots_(lines.size()),
        segments_(lines.size()) {
    std::iota(roots_.begin(), roots_.end(), std::size_t{0});
    for (std::size_t i = 0; i < lines.size(); ++i) segments_[i] = drawn(lines[i]);
  }

  int run() {
    int merged = 0;
    const std::vector<Candidate> all = candidates();
    for (const Candidate& candidate : all) merged += tryMerge(rootOf(candidate.a), rootOf(candidate.b), 0);
    if (drift_px_ > 0) {
      findRivals(all);
      for (const Candidate& candidate : all) merged += tryMerge(rootOf(candidate.a), rootOf(candidate.b), drift_px_);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (roots_[i] != i) continue;
      if (kept != i) lines_[kept] = std::move(lines_[i]);
      ++kept;
    }
    lines_.resize(kept);
    return merged;
  }

 private:
  static constexpr double kCoverage = 0.2;

  Segment3 drawn(const LineRecord& line) const {
    if (!line.known) return {};
    const auto stretch = seenStretch(cameras_, line, kCoverage);
    return stretch ? segmentOf(cameras_, line, *stretch) : Segment3{};
  }

  std::size_t rootOf(std::size_t i) const {
    while (roots_[i] != i) i = roots_[i];
    return i;
  }

  std::vector<Candidate> candidates() const {
    SpatialIndex index(kCell_m);
    constexpr int kMostSamples = 2000;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double length = segments_[i].length();
      if (length <= 0) continue;
      const int n = std::min(kMostSamples, 1 + static_cast<int>(2 * length / kCell_m));
      for (int k = 0; k <= n; ++k)
        index.add(i, segments_[i].start + (segments_[i].end - segments_[i].start) * (static_cast<double>(k) / n));
    }
    std::vector<Candidate> result;
    for (const auto& [a, b] : index.pairs()) {
      Candidate candidate{0, a, b};
      if (near(a, b, candidate.score)) result.push_back(candidate);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  /// The cheap conditions on two segments; `score`: less is more alike.
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

  /// Whether some image shows them as two.
  bool seenApart(const LineRecord& a, const LineRecord& b) const {
    int apart = 0, together = 0;
    for (auto i = a.views.begin(), j = b.views.begin(); i != a.views.end() && j != b.views.end();) {
      if (i->keyframe != j->keyframe) {
        i->keyframe < j->keyframe ? ++i : ++j;
        continue;
      }
      for (auto k = j; k != b.views.end() && k->keyframe == i->keyframe; ++k) {
        const double px = separation({i->start_px, i->end_px}, {k->start_px, k->end_px});
        if (px >= 0) ++(px > params_.min_separation_px ? apart : together);
      }
      ++i;
    }
    return apart > 0 && 2 * apart > together;
  }

  /// For every line the candidates that are left after merging without drift.
  void findRivals(const std::vector<Candidate>& candidates) {
    rivals_.assign(lines_.size(), {});
    for (const Candidate& candidate : candidates) {
      const std::size_t a = rootOf(candidate.a), b = rootOf(candidate.b);
      if (a != b) rivals_[a].push_back(b), rivals_[b].push_back(a);
    }
  }

  /// Whether of all lines only `b` can be meant by `a`: others nearly as close would have to be the same as `b`.
  bool isUnmistakable(std::size_t a, std::size_t b, double score) const {
    constexpr double kRatio = 2;
    return std::all_of(rivals_[a].begin(), rivals_[a].end(), [&](std::size_t rival) {
      const std::size_t c = rootOf(rival);
      double other = 0;
      return c == a || c == b || !near(a, c, other) || other > kRatio * score || !seenApart(lines_[b], lines_[c]);
    });
  }

  /// Tracks keep the brighter side on one side: start and end of what is the same edge follow each other.
  bool runTheSameWay(std::size_t a, std::size_t b) const {
    return segments_[a].direction().dot(segments_[b].direction()) > 0;
  }

  static bool shareKeyframes(const LineRecord& a, const LineRecord& b) {
    for (auto i = a.views.begin(), j = b.views.begin(); i != a.views.end() && j != b.views.end();) {
      if (i->keyframe == j->keyframe) return true;
      i->keyframe < j->keyframe ? ++i : ++j;
    }
    return false;
  }

  bool tryMerge(std::size_t a, std::size_t b, double drift_px) {
    if (a == b) return false;
    if (b < a) std::swap(a, b);
    const LineRecord &la = lines_[a], &lb = lines_[b];
    double score = 0;
    if (!near(a, b, score) || seenApart(la, lb)) return false;
    if (drift_px == 0 && apartness(la.estimate, lb.estimate) > kApart) return false;
    if (drift_px > 0 && (shareKeyframes(la, lb) || !runTheSameWay(a, b) || !isUnmistakable(a, b, score) ||
                         !isUnmistakable(b, a, score)))
      return false;
    LineRecord joint = la;
    joint.id = std::min(la.id, lb.id);
    joint.views.clear();
    std::merge(la.views.begin(), la.views.end(), lb.views.begin(), lb.views.end(), std::back_inserter(joint.views),
               [](const LineView& x, const LineView& y) { return x.keyframe < y.keyframe; });
    if (lb.views.size() > la.views.size()) joint.estimate = lb.estimate;
    if (!lb.tie) joint.tie.reset();  // one that knows itself is enough
    joint.parallel = la.parallel || lb.parallel;
    LineFitParams fit = fit_;
    fit.max_error_px += drift_px;
    if (!fitLine(cameras_, fit, joint) || !explains(joint, la, lb, drift_px)) return false;
    lines_[a] = std::move(joint);
    segments_[a] = drawn(lines_[a]);
    lines_[b] = {};
    roots_[b] = a;
    return true;
  }

  /// Whether one line does for both: hardly any view is lost and errors stay small.
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
    const double alone = (a.error_px * static_cast<double>(before_a) + b.error_px * static_cast<double>(before_b)) /
                         std::max<double>(1, static_cast<double>(before_a + before_b));
    // a line at a depth in between may nearly do for two: little may be lost against what they have alone
    return joint.error_px <= std::max(std::min(params_.max_error_px, 1.3 * alone + 0.3), 1.1 * alone) + 0.5 * drift_px;
  }

  const KeyframeCameras& cameras_;
  const LineFitParams& fit_;
  const MergeParams& params_;
  double drift_px_;
  std::vector<LineRecord>& lines_;
  std::vector<std::size_t> roots_;
  std::vector<Segment3> segments_;
  std::vector<std::vector<std::size_t>> rivals_;
};

}  // namespace

int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params, double drift_px,
               std::vector<LineRecord>& lines) {
  return LineMerger(cameras, fit, params, drift_px, lines).run();
}

}  // namespace lintel
