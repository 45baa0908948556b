// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SegmentView.h"

#include <algorithm>

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

ViewTest::ViewTest(const PinholeRadtan& camera, double border_px, double min_depth_m)
    : camera_(camera), border_px_(border_px), min_depth_m_(min_depth_m), max_radius_(0) {
  for (const double x : {0.0, camera.width - 1.0}) {
    for (const double y : {0.0, camera.height - 1.0}) {
      max_radius_ = std::max(max_radius_, camera.normalise({x, y}).norm());
    }
  }
  max_radius_ *= 1.05;
}

std::optional<Eigen::Vector2d> ViewTest::project(const Eigen::Vector3d& p_c) const {
  if (p_c.z() < min_depth_m_) return {};
  const Eigen::Vector2d normalised = p_c.head<2>() / p_c.z();
  if (normalised.norm() > max_radius_) return {};
  const Eigen::Vector2d px = camera_.toPixel(normalised);
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
