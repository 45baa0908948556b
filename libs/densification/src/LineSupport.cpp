// SPDX-License-Identifier: BSD-3-Clause
#include "LineSupport.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr double kBorder_px = 6, kLeastDepth_m = 0.05;
constexpr int kPlaces = 8;                           // along a segment, at which it is seen or not
constexpr double kLeast_px = 14;                     // of a segment in an image
constexpr double kMostTurn = 0.09;                   // between edge and projection [rad]
constexpr float kLeastChange = 15, kChange = 0.75f;  // of the mean of its sides: grey levels, and share of the contrast
constexpr double kLeastOnEdge = 0.3;                 // of an edge's length, beside the segment, to be explained by it

/// Length of the union of intervals, which it sorts.
double unionOf(std::vector<std::pair<double, double>>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double sum = 0, until = -1e300;
  for (const auto& [from, to] : intervals) {
    sum += std::max(0.0, to - std::max(from, until));
    until = std::max(until, to);
  }
  return sum;
}

}  // namespace

SeenSegment seenSegment(const SegmentView& view, const Segment3& segment_w) {
  const Eigen::Vector3d a = view.R_c_w * (segment_w.start - view.p_w_c), b = view.R_c_w * (segment_w.end - view.p_w_c);
  const auto sees = [&](int i) {
    const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(i) / kPlaces);
    return p.norm() > kLeastDepth_m && view.camera->contains(view.camera->project(p), kBorder_px) &&
           view.camera->projects(p);
  };
  int first = -1, last = -1, run = -1;  // the longest run of places within the image
  const bool sees_start = sees(0), sees_end = sees(kPlaces);
  if (sees_start && sees_end) {
    first = 0, last = kPlaces;
  } else {
    for (int i = 0; i <= kPlaces; ++i) {
      if (i == 0 ? !sees_start : i == kPlaces ? !sees_end : !sees(i)) {
        run = -1;
        continue;
      }
      if (run < 0) run = i;
      if (first < 0 || i - run > last - first) first = run, last = i;
    }
  }
  SeenSegment seen;
  if (first < 0 || last == first) return seen;
  const Eigen::Vector3d from = a + (b - a) * (static_cast<double>(first) / kPlaces),
                        to = a + (b - a) * (static_cast<double>(last) / kPlaces);
  const Eigen::Vector3d cross = from.cross(to);
  const double length = std::atan2(cross.norm(), from.dot(to));
  if (length * view.camera->meanFocal() < kLeast_px) return seen;
  seen.normal_c = cross.normalized();
  seen.start_c = from.normalized();
  seen.length_rad = length;
  return seen;
}

bool EdgeLook::maybeSame(const EdgeLook& other) const {
  return std::abs(mean - other.mean) <= std::max(kLeastChange, kChange * std::max(contrast, other.contrast));
}

LineSupport supportOf(const SegmentView& view, const SeenSegment& seen, double tolerance_px, bool taken_too,
                      const EdgeLook* look) {
  LineSupport support;
  support.visible = seen.length_rad > 0;
  if (!support.visible) return support;
  const Eigen::Vector3f h = seen.normal_c.cast<float>(), u = seen.start_c.cast<float>(), w = h.cross(u);
  const auto tolerance = static_cast<float>(tolerance_px / view.camera->meanFocal());
  const auto dot = [](const SegmentView::Columns& columns, const Eigen::Vector3f& x) -> Eigen::ArrayXf {
    return columns.col(0) * x(0) + columns.col(1) * x(1) + columns.col(2) * x(2);
  };
  const Eigen::ArrayXf from_start = dot(view.start, h), from_end = dot(view.end, h);
  std::vector<std::pair<double, double>> intervals;
  for (Eigen::Index i = 0; i < from_start.size(); ++i) {
    if (std::abs(from_start(i)) > tolerance || std::abs(from_end(i)) > tolerance) continue;
    if (std::abs(from_start(i) - from_end(i)) > kMostTurn * view.length(i)) continue;
    const auto k = static_cast<std::size_t>(i);
    if (view.taken[k] && !taken_too) continue;
    if (look && !look->maybeSame(EdgeLook(view.segments[k]))) continue;
    if (view.normal.row(i).matrix().dot(h.transpose()) < 0) continue;
    const auto along = [&](const SegmentView::Columns& rays) {
      const Eigen::Vector3f ray = rays.row(i).matrix();
      return static_cast<double>(std::atan2(ray.dot(w), ray.dot(u)));
    };
    const double from = std::max(0.0, along(view.start)), to = std::min(seen.length_rad, along(view.end));
    if (to - from < kLeastOnEdge * std::min<double>(view.length(i), seen.length_rad)) continue;
    intervals.emplace_back(from, to);
    support.by.push_back(k);
  }
  support.cover = unionOf(intervals) / seen.length_rad;
  return support;
}

double chanceOf(const SegmentView& view, const SeenSegment& seen, double tolerance_px, const EdgeLook& look) {
  double sum = 0;
  int n = 0;
  const Eigen::Vector3d middle = std::cos(0.5 * seen.length_rad) * seen.start_c +
                                 std::sin(0.5 * seen.length_rad) * seen.normal_c.cross(seen.start_c);
  for (const int step : {-5, -4, -3, 3, 4, 5}) {
    // turned about the axis across the middle's ray: moved sideways there
    const double angle = 2 * step * tolerance_px / view.camera->meanFocal();
    const Eigen::AngleAxisd turn(angle, seen.normal_c.cross(middle).normalized());
    SeenSegment beside = seen;
    beside.normal_c = turn * seen.normal_c;
    beside.start_c = turn * seen.start_c;
    sum += supportOf(view, beside, tolerance_px, true, &look).cover;
    ++n;
  }
  return sum / n;
}

double binomialTail(int k, int n, double p) {
  if (k <= 0) return 1;
  if (p <= 0) return 0;
  if (p >= 1) return 1;
  // logarithm of the binomial's term for k, then from term to term (std::lgamma would write a global variable from
  // several threads)
  double log_term = k * std::log(p) + (n - k) * std::log1p(-p);
  for (int j = 1; j <= k; ++j) log_term += std::log(static_cast<double>(n - k + j) / j);
  const double log_odds = std::log(p) - std::log1p(-p);
  double sum = 0;
  for (int i = k; i <= n; ++i) {
    sum += std::exp(log_term);
    log_term += log_odds + std::log(static_cast<double>(n - i) / (i + 1));  // minus infinity behind the last
  }
  return std::min(1.0, sum);
}

}  // namespace lintel
