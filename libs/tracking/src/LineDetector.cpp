// SPDX-License-Identifier: BSD-3-Clause
#include "LineDetector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>

namespace lintel {
namespace {

constexpr double kJoinAngle_rad = 0.035;  ///< 2 degrees: how exactly a piece of 30 px is known
constexpr double kJoinDistance_px = 2.0;  ///< of the image: detections at half resolution are good to one pixel
constexpr double kJoinGap_px = 15;        ///< between pieces of one edge, at the reference focal length
constexpr double kPiece = 0.3;            ///< of a new line's least length: shorter pieces are not joined
constexpr int kAnchorThreshold = 4;       ///< of edge_drawing: by how much an anchor's gradient exceeds its neighbours'
constexpr int kLeastPiece_px = 8;         ///< of edge_drawing, at half resolution: less is noise

// Of lsd [Gioi2012], whose parameters OpenCV leaves at a scale of 0.8 (two and a half times slower) with a second
// pass.
constexpr double kLsdScale = 0.5;       ///< of the image, smoothed before by a Gaussian of kLsdSigma / kLsdScale px
constexpr double kLsdSigma = 0.6;       ///< [Gioi2012]
constexpr double kLsdQuantisation = 2;  ///< error of a gradient, in grey levels: 2 for 256 of them [Gioi2012]
constexpr double kLsdAngle_deg = 22.5;  ///< of gradients of one segment [Gioi2012]

/// Joins `other` to `line` when both are pieces of one edge.
bool join(const LineCamera& camera, ImageLine& line, const ImageLine& elsewhere, double gap_px) {
  const auto relation = camera.relateNear(line, elsewhere, kJoinDistance_px);
  if (!relation || relation->angle_rad > kJoinAngle_rad || relation->overlap_px < -gap_px) return false;
  const ImageLine other = camera.seenFrom(line.axis, elsewhere);
  const Eigen::Vector2d d = line.direction();
  if (d.dot(other.start - line.start) < 0) line.start = other.start;
  if (d.dot(other.end - line.end) > 0) line.end = other.end;
  line = camera.centred(line);
  return true;
}

void sortLongestFirst(std::vector<ImageLine>& lines) {
  std::stable_sort(lines.begin(), lines.end(),
                   [](const ImageLine& a, const ImageLine& b) { return a.length() > b.length(); });
}

std::vector<ImageLine> joined(const LineCamera& camera, std::vector<ImageLine> pieces, double gap_px) {
  sortLongestFirst(pieces);
  std::vector<ImageLine> lines;
  for (const ImageLine& piece : pieces)
    if (std::none_of(lines.begin(), lines.end(), [&](ImageLine& line) { return join(camera, line, piece, gap_px); }))
      lines.push_back(piece);
  sortLongestFirst(lines);
  return lines;
}

}  // namespace

struct LineDetector::Engine {
  cv::Ptr<cv::ximgproc::EdgeDrawing> edge_drawing;
  cv::Ptr<cv::LineSegmentDetector> lsd;
};

LineDetector::LineDetector(const LineCamera& camera, const LineTrackerParams& params)
    : camera_(camera), params_(params), refiner_(camera), engine_(std::make_unique<Engine>()) {
  if (params_.detector == "lsd") {
    // Without the refinement that splits segments which are not dense: pieces would be joined again.
    engine_->lsd =
        cv::createLineSegmentDetector(cv::LSD_REFINE_NONE, kLsdScale, kLsdSigma, kLsdQuantisation, kLsdAngle_deg);
  } else {
    engine_->edge_drawing = cv::ximgproc::createEdgeDrawing();
    cv::ximgproc::EdgeDrawing::Params& p = engine_->edge_drawing->params;
    p.EdgeDetectionOperator = cv::ximgproc::EdgeDrawing::SOBEL;
    p.GradientThresholdValue = params_.gradient_threshold;
    p.AnchorThresholdValue = kAnchorThreshold;
    p.MinLineLength =
        std::max(kLeastPiece_px, static_cast<int>(kPiece * params_.min_length_px));  // pieces are joined later
  }
}

LineDetector::~LineDetector() = default;

std::vector<cv::Vec4f> LineDetector::detectRaw(const ImagePyramid& pyramid) {
  std::vector<cv::Vec4f> segments;
  if (engine_->lsd) {
    engine_->lsd->detect(pyramid.image().clone(),
                         segments);  // the pyramid's levels are views with a border around them
    return segments;
  }
  // The second level of the pyramid is already smoothed and costs a quarter.
  const int level = std::min(1, pyramid.levels() - 1);
  engine_->edge_drawing->detectEdges(pyramid.image(level).clone());
  engine_->edge_drawing->detectLines(segments);
  for (cv::Vec4f& segment : segments) segment *= static_cast<float>(1 << level);
  return segments;
}

std::vector<ImageLine> LineDetector::detect(const ImagePyramid& pyramid) {
  std::vector<ImageLine> pieces;
  for (const cv::Vec4f& s : detectRaw(pyramid)) {
    if (std::hypot(s[2] - s[0], s[3] - s[1]) < kPiece * params_.min_length_px) continue;
    const ImageLine line = camera_.lineFromImage({s[0], s[1]}, {s[2], s[3]});
    if (const auto oriented = refiner_.orient(pyramid.image(), line)) pieces.push_back(*oriented);
  }
  return joined(camera_, std::move(pieces), camera_.scaled(kJoinGap_px));
}

std::vector<ImageLine> LineDetector::detectLong(const ImagePyramid& pyramid) {
  std::vector<ImageLine> lines;
  for (const ImageLine& line : detect(pyramid)) {
    const auto clipped = camera_.clip(line, params_.border_px);
    if (clipped && clipped->length() >= params_.min_length_px) lines.push_back(*clipped);
    if (static_cast<int>(lines.size()) == params_.max_lines) break;
  }
  return lines;
}

}  // namespace lintel
