// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "Picture.h"
#include "Writers.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr int kWidth = 1600, kAboveHeight = 1000, kHalfWidth = kWidth / 2, kBelowHeight = 511, kFootHeight = 50;

/// What the views from outside show: the core of the lines and the path among them, without outliers of either.
Eigen::AlignedBox3d shownBox(const Drawing& drawing) {
  Eigen::AlignedBox3d box = drawing.core, path;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> along;
    for (const DrawnPart& part : drawing.parts) {
      if (part.layer != MapLayer::kTrajectory) continue;
      for (const DrawnSegment& s : part.segments) along.push_back(s.start[axis]);
    }
    if (along.empty()) return box;
    path.min()[axis] = nearestQuantile(along, 0.01), path.max()[axis] = nearestQuantile(along, 0.99);
  }
  return box.extend(path);
}

/// The first pose there is: where the first keyframe, else the first frame, was taken.
const Pose* firstPose(const LineMap& map) {
  const auto usable = [](const Pose& T) {
    return T.p.allFinite() && T.q.coeffs().allFinite() && std::abs(T.q.norm() - 1) < 0.01;
  };
  for (const MapKeyframe& keyframe : map.keyframes) {
    if (usable(keyframe.T_w_b)) return &keyframe.T_w_b;
  }
  for (const auto& [t_ns, T_w_b] : map.trajectory) {
    if (usable(T_w_b)) return &T_w_b;
  }
  return nullptr;
}

/// Frusta further apart than they are deep: closer ones would hide the path.
Drawing withFewerFrusta(const Drawing& drawing) {
  Drawing thinned = drawing;
  for (DrawnPart& part : thinned.parts) {
    if (part.layer != MapLayer::kKeyframes) continue;
    std::vector<DrawnSegment> kept;
    for (std::size_t i = 0; i + kFrustumStrokes <= part.segments.size(); i += kFrustumStrokes) {
      const auto frustum = part.segments.begin() + static_cast<std::ptrdiff_t>(i);
      const bool close =
          !kept.empty() && (kept[kept.size() - kFrustumStrokes].start - frustum->start).norm() < 2 * drawing.frustum_m;
      if (!close) kept.insert(kept.end(), frustum, frustum + kFrustumStrokes);
    }
    part.segments = std::move(kept);
  }
  return thinned;
}

/// The camera's own view without the strokes it stands in the middle of.
Drawing withoutPath(const Drawing& drawing) {
  Drawing lines = drawing;
  const auto is_path = [](const DrawnPart& part) {
    return part.layer == MapLayer::kKeyframes || part.layer == MapLayer::kTrajectory;
  };
  lines.parts.erase(std::remove_if(lines.parts.begin(), lines.parts.end(), is_path), lines.parts.end());
  return lines;
}

void drawFoot(const Drawing& drawing, cv::Mat foot) {
  int x = 14;
  const auto entry = [&](const std::string& text, Rgb colour) {
    cv::line(foot, {x, 26}, {x + 26, 26}, cv::Scalar(colour.b, colour.g, colour.r), 3, cv::LINE_AA);
    drawText(foot, text, {x + 34, 31});
    x += 34 + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, nullptr).width + 28;
  };
  for (const auto& [text, colour] : drawing.legend) entry(text, colour);
  const auto& counts = drawing.summary;
  if (counts.trajectory > 0) entry("trajectory", kTrajectoryColour);
  if (counts.keyframes > 0) entry(std::to_string(counts.keyframes) + " keyframes", kKeyframeColour);
  if (counts.points > 0) entry(std::to_string(counts.points) + " points", kPointColour);
  drawText(foot, std::to_string(counts.lines) + " lines", {kWidth - 130, 31});
}

}  // namespace

OutputFiles pngFiles(const Drawing& whole, const std::string& path) {
  const Drawing drawing = withFewerFrusta(whole);
  cv::Mat image(kAboveHeight + kBelowHeight + kFootHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  const cv::Rect above(0, 0, kWidth, kAboveHeight), left(0, kAboveHeight, kHalfWidth, kBelowHeight),
      right(kHalfWidth, kAboveHeight, kHalfWidth, kBelowHeight),
      foot(0, kAboveHeight + kBelowHeight, kWidth, kFootHeight);
  const Eigen::AlignedBox3d box = shownBox(drawing);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  // The longer side of the floor lies along the picture's.
  const bool turned = box.sizes().y() > box.sizes().x();
  drawView(drawing,
           parallelView(turned ? "from above (x up)" : "from above (x right)", box, turned ? -y : x, z, above.size()),
           image(above));
  drawView(drawing,
           parallelView(turned ? "from the side (along x)" : "from the side (along y)", box, turned ? -y : x,
                        turned ? -x : -y, right.size()),
           image(right));
  if (const Pose* T_w_b = firstPose(*drawing.map)) {
    drawView(withoutPath(drawing),
             cameraView("from the first camera", drawing.map->rig, *T_w_b, drawing.core.diagonal().norm(), left.size()),
             image(left));
  } else {
    drawText(image, "no camera pose", {14, kAboveHeight + 26}, 0.6);
  }
  drawFoot(drawing, image(foot));
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes))
    throw ExportError(path + ": the picture cannot be encoded; is OpenCV built with PNG?");
  return {{path, std::string(bytes.begin(), bytes.end())}};
}

}  // namespace lintel
