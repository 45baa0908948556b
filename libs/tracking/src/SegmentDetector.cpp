// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/SegmentDetector.h"

#include <algorithm>
#include <opencv2/ximgproc/edge_drawing.hpp>

#include "EdgeAppearance.h"
#include "EdgeRefiner.h"
#include "LineMerger.h"

namespace lintel {

namespace {

constexpr int kAnchorThreshold = 4;                ///< by how much an anchor's gradient exceeds its neighbours'
constexpr int kLeastPiece_px = 8;                  ///< of the image searched: less is noise
constexpr double kSearch_px = 2.5, kGrow_px = 16;  ///< see EdgeRefiner::refine
constexpr double kBorder_px = 4, kLeastSupport = 0.7;

PyramidParams twoLevels() {
  PyramidParams params;
  params.levels = 2;
  return params;
}

}  // namespace

struct SegmentDetector::Impl {
  Impl(const Rig& rig, const SegmentParams& segment_params)
      : params(segment_params), camera(rig.camera, ImageMask(rig)), refiner(camera), merger(camera, line_params) {
    detector = cv::ximgproc::createEdgeDrawing();
    cv::ximgproc::EdgeDrawing::Params& p = detector->params;
    p.EdgeDetectionOperator = cv::ximgproc::EdgeDrawing::SOBEL;
    p.GradientThresholdValue = params.gradient_threshold;
    p.AnchorThresholdValue = kAnchorThreshold;
  }

  /// Segments that OpenCV finds on a level of the pyramid, in pixels of full resolution.
  std::vector<cv::Vec4f> segmentsOf(int level) {
    const cv::Mat image = pyramid.image(level).clone();  // the pyramid's levels are views with a border around them
    detector->params.MinLineLength =
        std::max(kLeastPiece_px, static_cast<int>(camera.scaled(params.min_length_px)) >> (level + 1));
    std::vector<cv::Vec4f> segments;
    detector->detectEdges(image);
    detector->detectLines(segments);
    for (cv::Vec4f& segment : segments) segment *= static_cast<float>(1 << level);
    return segments;
  }

  /// The edge under a detected segment, if it is long enough.
  std::optional<RefinedLine> edgeUnder(const cv::Vec4f& s) const {
    const auto oriented = refiner.orient(pyramid.image(), camera.lineFromImage({s[0], s[1]}, {s[2], s[3]}));
    if (!oriented) return std::nullopt;
    auto refined = refiner.refine(pyramid, *oriented, kSearch_px, camera.scaled(kGrow_px));
    if (!refined || refined->support < kLeastSupport) return std::nullopt;
    const auto clipped = camera.clip(refined->line, kBorder_px);
    if (!clipped || clipped->length() < camera.scaled(params.min_length_px)) return std::nullopt;
    refined->line = *clipped;
    return refined;
  }

  SegmentParams params;
  LineTrackerParams line_params;
  LineCamera camera;
  EdgeRefiner refiner;
  LineMerger merger;
  ImagePyramid pyramid{twoLevels(), LineTrackerParams().window_px};
  cv::Ptr<cv::ximgproc::EdgeDrawing> detector;
};

SegmentDetector::SegmentDetector(const Rig& rig, const SegmentParams& params) {
  checkRanges(params, "densification.segments.");
  impl_ = std::make_unique<Impl>(rig, params);
}
SegmentDetector::~SegmentDetector() = default;
SegmentDetector::SegmentDetector(SegmentDetector&&) noexcept = default;

std::vector<EdgeSegment> SegmentDetector::detect(const GrayImage& image) {
  Impl& d = *impl_;
  d.pyramid.push(image);
  std::vector<RefinedLine> found;
  for (const int level : {0, 1})
    for (const cv::Vec4f& segment : d.segmentsOf(level))
      if (auto edge = d.edgeUnder(segment)) found.push_back(std::move(*edge));
  std::stable_sort(found.begin(), found.end(),
                   [](const RefinedLine& a, const RefinedLine& b) { return a.line.length() > b.line.length(); });
  std::vector<RefinedLine> kept;
  for (const RefinedLine& edge : found)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const RefinedLine& other) { return d.merger.duplicates(other.line, edge.line); }))
      kept.push_back(edge);
  std::vector<EdgeSegment> segments;
  for (const RefinedLine& edge : kept) {
    const SideLevels sides = sideLevels(d.camera, d.pyramid.image(), edge.line).value_or(SideLevels());
    segments.push_back({d.camera.toImage(edge.line.start, edge.line.axis).cast<float>(),
                        d.camera.toImage(edge.line.end, edge.line.axis).cast<float>(),
                        static_cast<float>(edge.sigma_px), sides.dark, sides.bright});
  }
  return segments;
}

}  // namespace lintel
