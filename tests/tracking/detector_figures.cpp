// SPDX-License-Identifier: BSD-3-Clause
//
// detector_figures RECORDING [FRAMES]: how much of the true edges that images show do detectors of line segments find,
// in every FRAMES-th image (20) of a rendered recording, and how long do they take? The last row is what the search of
// the keyframes' images uses (SegmentDetector): edge drawing at two scales, fitted to the grey levels.
#include <cstdio>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>
#include <opencv2/ximgproc/fast_line_detector.hpp>
#include <stdexcept>
#include <string>

#include "../ToolMain.h"
#include "TrueEdges.h"
#include "TruePoses.h"
#include "lintel/core/ThreadTime.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/SegmentDetector.h"

namespace lintel {
namespace {

constexpr double kNear_px = 2.5, kTurn_rad = 0.12;  // of a segment from the edge that it is of
constexpr double kLeastSeen_px = 20, kStep_px = 4;
constexpr float kLeastFound_px = 10;

/// Both ends in pixels of the image.
using Segments = std::vector<cv::Vec4f>;
using Detect = std::function<Segments(const GrayImage& image)>;

cv::Mat matOf(const GrayImage& image) {
  return cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data())).clone();
}

/// EDLines of OpenCV, with the thresholds of SegmentDetector.
Segments edgeDrawing(cv::Mat image, int levels) {
  const auto detector = cv::ximgproc::createEdgeDrawing();
  detector->params.EdgeDetectionOperator = cv::ximgproc::EdgeDrawing::SOBEL;
  detector->params.GradientThresholdValue = SegmentParams().gradient_threshold;
  detector->params.AnchorThresholdValue = 4;
  detector->params.MinLineLength = static_cast<int>(kLeastFound_px);
  Segments all;
  for (int level = 0; level < levels; ++level) {
    Segments found;
    if (level > 0) cv::pyrDown(image, image);
    detector->detectEdges(image);
    detector->detectLines(found);
    for (const cv::Vec4f& segment : found) all.push_back(segment * static_cast<float>(1 << level));
  }
  return all;
}

Segments lsd(const cv::Mat& image, double scale) {
  Segments found;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD, scale)->detect(image, found);
  return found;
}

/// Chains of Canny's edges.
Segments fastLines(const cv::Mat& image) {
  Segments found;
  cv::ximgproc::createFastLineDetector(static_cast<int>(kLeastFound_px), 1.414f, 20, 60, 3, false)
      ->detect(image, found);
  return found;
}

/// A detector and what it has found so far.
struct Measured {
  std::string name;
  Detect detect;
  double cpu_ms = 0, seen_px = 0, covered_px = 0;
  std::size_t segments = 0, images = 0, again = 0, repeated = 0;
  std::map<int, bool> last;  ///< edges of the image before: found or not
};

struct Straight {
  Eigen::Vector2d start, along;  ///< undistorted pixels; unit
  double length = 0;
};

std::vector<Straight> straightened(const Segments& segments, const Camera& camera) {
  const auto undistorted = [&](float x, float y) -> Eigen::Vector2d {
    return camera.ray({x, y}).hnormalized() * camera.meanFocal();
  };
  std::vector<Straight> result;
  for (const cv::Vec4f& s : segments) {
    const Eigen::Vector2d start = undistorted(s[0], s[1]), arm = undistorted(s[2], s[3]) - start;
    if (arm.norm() >= kLeastFound_px) result.push_back({start, arm.normalized(), arm.norm()});
  }
  return result;
}

bool isCovered(const Eigen::Vector2d& px, const Eigen::Vector2d& along, const std::vector<Straight>& segments) {
  for (const Straight& s : segments) {
    const Eigen::Vector2d arm = px - s.start;
    const double place = arm.dot(s.along), beside = arm.x() * s.along.y() - arm.y() * s.along.x();
    const double turn = along.x() * s.along.y() - along.y() * s.along.x();
    if (place > -kNear_px && place < s.length + kNear_px && std::abs(beside) < kNear_px && std::abs(turn) < kTurn_rad)
      return true;
  }
  return false;
}

void measure(const Frame& frame, const truth::TrueEdges& truth, Measured& measured) {
  const double start_ms = threadTimeMs();
  const Segments found = measured.detect(*frame.image);
  measured.cpu_ms += threadTimeMs() - start_ms;
  const std::vector<Straight> segments = straightened(found, truth.camera());
  measured.segments += segments.size();
  ++measured.images;
  std::map<int, bool> edges;
  for (const truth::SeenEdge& edge : truth.seenAt(frame.t_ns)) {
    const Eigen::Vector2d arm = edge.end - edge.start, along = arm.normalized();
    double seen = 0, covered = 0;
    for (double s = 0.5 * kStep_px; s < arm.norm(); s += kStep_px) {
      const Eigen::Vector2d px = edge.start + s * along;
      const Eigen::Vector3d ray = (Eigen::Vector3d() << px / truth.camera().meanFocal(), 1).finished();
      if (!truth.camera().contains(truth.camera().project(ray), 4)) continue;
      seen += kStep_px;
      covered += isCovered(px, along, segments) ? kStep_px : 0;
    }
    if (seen < kLeastSeen_px) continue;
    measured.seen_px += seen;
    measured.covered_px += covered;
    const bool here = edges[edge.id] = covered >= 0.5 * seen;
    const auto before = measured.last.find(edge.id);
    if (before == measured.last.end() || !before->second) continue;
    ++measured.again;
    measured.repeated += here;
  }
  measured.last = std::move(edges);
}

int run(int argc, char** argv) {
  if (argc < 2 || argc > 3) throw std::invalid_argument("usage: detector_figures RECORDING [FRAMES]");
  cv::setNumThreads(1);
  const int step = argc > 2 ? std::stoi(argv[2]) : 20;
  const auto recording = openRecording(argv[1]);
  const truth::TruePoses poses(argv[1]);
  const truth::TrueEdges truth(argv[1], recording->rig(), poses);
  SegmentDetector own(recording->rig(), SegmentParams());
  std::vector<Measured> detectors;
  const auto add = [&](const char* name, Detect detect) { detectors.push_back({name, std::move(detect)}); };
  add("LSD, scale 0.5", [](const GrayImage& image) { return lsd(matOf(image), 0.5); });
  add("LSD, scale 0.8", [](const GrayImage& image) { return lsd(matOf(image), 0.8); });
  add("LSD, scale 1", [](const GrayImage& image) { return lsd(matOf(image), 1); });
  add("fast line detector", [](const GrayImage& image) { return fastLines(matOf(image)); });
  add("edge drawing", [](const GrayImage& image) { return edgeDrawing(matOf(image), 1); });
  add("edge drawing, two scales", [](const GrayImage& image) { return edgeDrawing(matOf(image), 2); });
  add("these and the fast lines", [](const GrayImage& image) {
    Segments all = edgeDrawing(matOf(image), 2);
    const Segments more = fastLines(matOf(image));
    all.insert(all.end(), more.begin(), more.end());
    return all;
  });
  add("SegmentDetector", [&own](const GrayImage& image) {
    Segments all;
    for (const EdgeSegment& s : own.detect(image))
      all.emplace_back(s.start_px.x(), s.start_px.y(), s.end_px.x(), s.end_px.y());
    return all;
  });
  for (int i = 0; const auto next = recording->next(); ++i)
    if (i % step == 0)
      for (Measured& detector : detectors) measure(next->frame, truth, detector);
  std::printf("%-26s %8s %9s %8s %8s\n", "", "CPU [ms]", "segments", "covered", "repeated");
  for (const Measured& m : detectors) {
    const auto images = static_cast<double>(m.images);
    std::printf("%-26s %8.1f %9.0f %8.3f %8.3f\n", m.name.c_str(), m.cpu_ms / images,
                static_cast<double>(m.segments) / images, m.covered_px / m.seen_px,
                static_cast<double>(m.repeated) / static_cast<double>(m.again));
  }
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("detector_figures", lintel::run, argc, argv); }
