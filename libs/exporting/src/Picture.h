// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "Drawing.h"

namespace lintel {

/// A point of the drawing as seen in a view: pixels, and the distance from the viewer [m] (larger = behind).
struct SeenPoint {
  Eigen::Vector2d px;
  double depth_m = 0;
};

struct SeenStroke {
  SeenPoint start, end;
};

/// How a view maps the world to its panel: none for what is not in front of it.
struct View {
  std::string title;
  std::function<std::optional<SeenStroke>(const Eigen::Vector3d& start_w, const Eigen::Vector3d& end_w)> stroke;
  std::function<std::optional<SeenPoint>(const Eigen::Vector3d& p_w)> point;
  double near_m = 0, far_m = 1;    ///< strokes fade from near to far
  std::optional<double> px_per_m;  ///< for a scale bar; none in perspective
};

/// Parallel projection into `size`, looking against `towards_viewer`, with `right` to the right; fitted to `box`.
View parallelView(const std::string& title, const Eigen::AlignedBox3d& box, const Eigen::Vector3d& right,
                  const Eigen::Vector3d& towards_viewer, const cv::Size& size);

/// Perspective view of a camera (without its distortion) at the body pose `T_w_b`, fitted to `size`.
View cameraView(const std::string& title, const Rig& rig, const Pose& T_w_b, double far_m, const cv::Size& size);

/// Draws everything of `drawing` that the view sees into `panel` (CV_8UC3, BGR), far first.
void drawView(const Drawing& drawing, const View& view, cv::Mat panel);

/// Anti-aliased text with its baseline at `at`.
void drawText(cv::Mat& image, const std::string& text, const cv::Point& at, double size = 0.5,
              const Rgb& colour = {60, 60, 60});

}  // namespace lintel
