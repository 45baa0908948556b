// SPDX-License-Identifier: BSD-3-Clause
#include "Picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr int kSubpixelBits = 4;
constexpr double kNearClip_m = 0.05, kMarginShare = 0.05, kStrongestFade = 0.75;

struct Stroke {
  SeenStroke seen;
  Rgb colour;
  int width_px;
};

/// Clips to the panel with some border (Liang-Barsky), so that far-off ends do not leave OpenCV's integers.
bool clipToPanel(const cv::Size& size, Eigen::Vector2d& a, Eigen::Vector2d& b) {
  double from = 0, to = 1;
  const Eigen::Vector2d d = b - a, low(-20, -20), high(size.width + 20, size.height + 20);
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(d[axis]) < 1e-12) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
      continue;
    }
    const double s = (low[axis] - a[axis]) / d[axis], t = (high[axis] - a[axis]) / d[axis];
    from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
  }
  if (!(from < to)) return false;
  const Eigen::Vector2d origin = a;
  a = origin + from * d, b = origin + to * d;
  return true;
}

cv::Point subpixel(const Eigen::Vector2d& px) {
  return {static_cast<int>(std::lround(px.x() * (1 << kSubpixelBits))),
          static_cast<int>(std::lround(px.y() * (1 << kSubpixelBits)))};
}

cv::Scalar faded(Rgb c, double depth_m, const View& view) {
  const double s =
      kStrongestFade * std::clamp((depth_m - view.near_m) / std::max(view.far_m - view.near_m, 1e-9), 0.0, 1.0);
  const auto mix = [s](int v) { return v + s * (255 - v); };
  return {mix(c.b), mix(c.g), mix(c.r)};
}

int widthOf(const DrawnPart& part) {
  return part.layer == MapLayer::kLines || part.layer == MapLayer::kTrajectory ? 2 : 1;
}

void drawStrokes(const Drawing& drawing, const View& view, cv::Mat& panel) {
  std::vector<Stroke> strokes;
  for (const DrawnPart& part : drawing.parts) {
    for (const DrawnSegment& s : part.segments) {
      auto seen = view.stroke(s.start, s.end);
      if (!seen || !clipToPanel(panel.size(), seen->start.px, seen->end.px)) continue;
      strokes.push_back({*seen, s.colour, widthOf(part)});
    }
  }
  const auto depth = [](const Stroke& s) { return s.seen.start.depth_m + s.seen.end.depth_m; };
  std::stable_sort(strokes.begin(), strokes.end(),
                   [&](const Stroke& a, const Stroke& b) { return depth(a) > depth(b); });
  const bool dense = strokes.size() > 20000;
  for (const Stroke& s : strokes) {
    cv::line(panel, subpixel(s.seen.start.px), subpixel(s.seen.end.px), faded(s.colour, 0.5 * depth(s), view),
             dense ? 1 : s.width_px, cv::LINE_AA, kSubpixelBits);
  }
}

void drawPoints(const Drawing& drawing, const View& view, cv::Mat& panel) {
  for (const DrawnPart& part : drawing.parts) {
    for (const DrawnPoint& p : part.points) {
      const auto seen = view.point(p.p);
      if (!seen ||
          !(seen->px.x() > -5 && seen->px.y() > -5 && seen->px.x() < panel.cols + 5 && seen->px.y() < panel.rows + 5))
        continue;
      cv::circle(panel, subpixel(seen->px), 1 << kSubpixelBits, faded(p.colour, seen->depth_m, view), cv::FILLED,
                 cv::LINE_AA, kSubpixelBits);
    }
  }
}

/// A bar of 1, 2 or 5 times a power of ten, about a sixth of the panel.
void drawScaleBar(double px_per_m, cv::Mat& panel) {
  const double wanted_m = panel.cols / 6.0 / px_per_m, power = std::pow(10, std::floor(std::log10(wanted_m)));
  const double factor = wanted_m / power >= 5 ? 5 : wanted_m / power >= 2 ? 2 : 1, length_m = factor * power;
  const int length_px = static_cast<int>(std::lround(length_m * px_per_m)), x = panel.cols - 20 - length_px,
            y = panel.rows - 18;
  const cv::Scalar ink(60, 60, 60);
  cv::rectangle(panel, cv::Rect(x, y, length_px, 4), ink, cv::FILLED);
  drawText(panel, formatted("%g m", length_m), {x, y - 6});
}

}  // namespace

View parallelView(const std::string& title, const Eigen::AlignedBox3d& box, const Eigen::Vector3d& right,
                  const Eigen::Vector3d& towards_viewer, const cv::Size& size) {
  Eigen::Matrix3d axes;  // rows: to the right, down, away from the viewer
  axes << right.transpose(), -towards_viewer.cross(right).transpose(), -towards_viewer.transpose();
  Eigen::AlignedBox3d seen;
  for (int corner = 0; corner < 8; ++corner)
    seen.extend(axes * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  const Eigen::Vector3d extent = seen.sizes().cwiseMax(1e-3), centre = seen.center();
  const double scale = (1 - 2 * kMarginShare) * std::min(size.width / extent.x(), size.height / extent.y());
  const Eigen::Vector2d middle(0.5 * size.width, 0.5 * size.height);
  const auto point = [=](const Eigen::Vector3d& p_w) {
    const Eigen::Vector3d p = axes * p_w - centre;
    return SeenPoint{middle + scale * p.head<2>(), p.z()};
  };
  View view;
  view.title = title;
  view.point = [=](const Eigen::Vector3d& p_w) -> std::optional<SeenPoint> { return point(p_w); };
  view.stroke = [=](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> std::optional<SeenStroke> {
    return SeenStroke{point(a), point(b)};
  };
  view.near_m = 0, view.far_m = extent.z();  // the half nearer to the viewer in full colour
  view.px_per_m = scale;
  return view;
}

View cameraView(const std::string& title, const Rig& rig, const Pose& T_w_b, double far_m, const cv::Size& size) {
  Camera camera = rig.camera;
  if (!(camera.fx > 0 && camera.fy > 0 && camera.width > 0 && camera.height > 0)) camera = {2, 2, 1, 1, 0.5, 0.5};
  const double scale = std::min(double(size.width) / camera.width, double(size.height) / camera.height);
  const Eigen::Vector2d focal = scale * Eigen::Vector2d(camera.fx, camera.fy);
  const Eigen::Vector2d centre =
      scale * Eigen::Vector2d(camera.cx, camera.cy) +
      0.5 * Eigen::Vector2d(size.width - scale * camera.width, size.height - scale * camera.height);
  const Pose T_c_w = (T_w_b * rig.T_b_c).inverse();
  const auto project = [=](const Eigen::Vector3d& p_c) {
    return SeenPoint{centre + focal.cwiseProduct(p_c.head<2>() / p_c.z()), p_c.z()};
  };
  View view;
  view.title = title;
  view.far_m = far_m;
  view.point = [=](const Eigen::Vector3d& p_w) -> std::optional<SeenPoint> {
    const Eigen::Vector3d p_c = T_c_w * p_w;
    if (p_c.z() < kNearClip_m) return std::nullopt;
    return project(p_c);
  };
  view.stroke = [=](const Eigen::Vector3d& a_w, const Eigen::Vector3d& b_w) -> std::optional<SeenStroke> {
    Eigen::Vector3d a = T_c_w * a_w, b = T_c_w * b_w;
    if (a.z() < kNearClip_m && b.z() < kNearClip_m) return std::nullopt;
    const auto clipped = [](const Eigen::Vector3d& behind, const Eigen::Vector3d& front) -> Eigen::Vector3d {
      return behind + (kNearClip_m - behind.z()) / (front.z() - behind.z()) * (front - behind);
    };
    if (a.z() < kNearClip_m) a = clipped(a, b);
    if (b.z() < kNearClip_m) b = clipped(b, a);
    return SeenStroke{project(a), project(b)};
  };
  return view;
}

void drawView(const Drawing& drawing, const View& view, cv::Mat panel) {
  drawPoints(drawing, view, panel);
  drawStrokes(drawing, view, panel);
  drawText(panel, view.title, {14, 26}, 0.6);
  if (view.px_per_m) drawScaleBar(*view.px_per_m, panel);
  cv::rectangle(panel, cv::Rect(0, 0, panel.cols, panel.rows), cv::Scalar(200, 200, 200));
}

void drawText(cv::Mat& image, const std::string& text, const cv::Point& at, double size, const Rgb& colour) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar(colour.b, colour.g, colour.r), 1,
              cv::LINE_AA);
}

}  // namespace lintel
