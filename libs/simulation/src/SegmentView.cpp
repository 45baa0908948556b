// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SegmentView.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr int kSamples = 48;  // a visible run shorter than 1/48 of the segment may be missed
constexpr int kBisections = 40;

Eigen::Vector3d along(const Segment3& s, double u) { return s.start + u * (s.end - s.start); }

/// The border of visibility between `seen` and `unseen`, on the seen side.
double border(const ViewTest& view, const Segment3& segment_c, double seen, double unseen) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (seen + unseen);
    (view.project(along(segment_c, middle)) ? seen : unseen) = middle;
  }
  return seen;
}

}  // namespace

ViewTest::ViewTest(const Camera& camera, double border_px, double min_depth_m)
    : camera_(camera), border_px_(border_px), min_depth_m_(min_depth_m) {
  const double angle = largestAngle(camera);
  least_cosine_ = std::cos(camera.wide() ? std::min(1.05 * angle, 3.14) : std::atan(1.05 * std::tan(angle)));
}

std::optional<Eigen::Vector2d> ViewTest::project(const Eigen::Vector3d& p_c) const {
  const double distance_m = p_c.norm();
  if ((camera_.wide() ? distance_m : p_c.z()) < min_depth_m_ || p_c.z() < least_cosine_ * distance_m) return {};
  const Eigen::Vector2d px = camera_.project(p_c);
  if (!camera_.contains(px, border_px_)) return {};
  return px;
}

std::optional<SegmentView> viewSegment(const ViewTest& view, const Segment3& segment_c) {
  int best_first = 0, best_count = 0, first = 0;
  for (int i = 0; i <= kSamples; ++i) {
    if (!view.project(along(segment_c, static_cast<double>(i) / kSamples))) {
      first = i + 1;
    } else if (i - first + 1 > best_count) {
      best_first = first;
      best_count = i - first + 1;
    }
  }
  if (best_count == 0) return {};
  const int last = best_first + best_count - 1;
  double u0 = static_cast<double>(best_first) / kSamples, u1 = static_cast<double>(last) / kSamples;
  if (best_first > 0) u0 = border(view, segment_c, u0, static_cast<double>(best_first - 1) / kSamples);
  if (last < kSamples) u1 = border(view, segment_c, u1, static_cast<double>(last + 1) / kSamples);
  const Segment3 visible{along(segment_c, u0), along(segment_c, u1)};
  return SegmentView{visible, view.camera().project(visible.start), view.camera().project(visible.end)};
}

}  // namespace lintel
