// SPDX-License-Identifier: BSD-3-Clause
#include "LineMatcher.h"

#include <algorithm>
#include <cmath>
#include <opencv2/line_descriptor.hpp>

namespace lintel {
namespace {

constexpr double kGateAngle_rad = 0.2;   ///< 11 degrees: what perspective turns in a frame
constexpr double kGateDistance_px = 60;  ///< between their lines, at the reference focal length: parallax of a frame
constexpr double kMinOverlap = 0.3;      ///< of the shorter one

cv::line_descriptor::KeyLine keyLine(const LineCamera& camera, const ImageLine& line, const cv::Size& size, int index) {
  const Eigen::Vector2d a = camera.toImage(line.start, line.axis), b = camera.toImage(line.end, line.axis);
  cv::line_descriptor::KeyLine key;
  key.startPointX = key.sPointInOctaveX = static_cast<float>(a.x());
  key.startPointY = key.sPointInOctaveY = static_cast<float>(a.y());
  key.endPointX = key.ePointInOctaveX = static_cast<float>(b.x());
  key.endPointY = key.ePointInOctaveY = static_cast<float>(b.y());
  key.lineLength = static_cast<float>((b - a).norm());
  key.angle = static_cast<float>(std::atan2(b.y() - a.y(), b.x() - a.x()));
  key.octave = 0;
  key.class_id = index;  // the descriptor's row; -1 would crash OpenCV
  key.numOfPixels = std::max(static_cast<int>(key.lineLength), 1);
  key.pt = {0.5f * (key.startPointX + key.endPointX), 0.5f * (key.startPointY + key.endPointY)};
  key.response = key.lineLength / static_cast<float>(std::max(size.width, size.height));
  key.size = static_cast<float>(std::abs((b.x() - a.x()) * (b.y() - a.y())));
  return key;
}

struct Match {
  std::size_t from, to;
  int distance;
};

}  // namespace

struct LineMatcher::Engine {
  cv::Ptr<cv::line_descriptor::BinaryDescriptor> descriptor =
      cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor();
};

LineMatcher::LineMatcher(const LineCamera& camera, const LineTrackerParams& params)
    : camera_(camera), params_(params), engine_(std::make_unique<Engine>()) {}

LineMatcher::~LineMatcher() = default;

cv::Mat LineMatcher::describe(const cv::Mat& image, const std::vector<ImageLine>& lines) const {
  cv::Mat descriptors;
  if (lines.empty()) return descriptors;
  std::vector<cv::line_descriptor::KeyLine> keys;
  for (std::size_t i = 0; i < lines.size(); ++i)
    keys.push_back(keyLine(camera_, lines[i], image.size(), static_cast<int>(i)));
  engine_->descriptor->compute(image, keys, descriptors);
  return descriptors;
}

std::vector<std::optional<std::size_t>> LineMatcher::match(const std::vector<ImageLine>& expected,
                                                           const cv::Mat& from_descriptors,
                                                           const std::vector<ImageLine>& to,
                                                           const cv::Mat& to_descriptors) const {
  std::vector<Match> pairs;
  for (std::size_t f = 0; f < expected.size(); ++f)
    for (std::size_t t = 0; t < to.size(); ++t) {
      const auto relation = camera_.relateNear(expected[f], to[t], camera_.scaled(kGateDistance_px));
      if (!relation || relation->angle_rad > kGateAngle_rad ||
          relation->overlap_px < kMinOverlap * std::min(expected[f].length(), to[t].length()))
        continue;
      const int bits = distance(from_descriptors.row(static_cast<int>(f)), to_descriptors.row(static_cast<int>(t)));
      if (bits <= params_.descriptor_distance) pairs.push_back({f, t, bits});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Match& a, const Match& b) { return a.distance < b.distance; });
  std::vector<std::optional<std::size_t>> matches(to.size());
  std::vector<char> used(expected.size(), 0);
  for (const Match& pair : pairs) {
    if (used[pair.from] || matches[pair.to]) continue;
    used[pair.from] = 1;
    matches[pair.to] = pair.from;
  }
  return matches;
}

int LineMatcher::distance(const cv::Mat& descriptor, const cv::Mat& other) {
  return static_cast<int>(cv::norm(descriptor, other, cv::NORM_HAMMING));
}

}  // namespace lintel
