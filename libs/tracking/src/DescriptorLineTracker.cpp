// SPDX-License-Identifier: BSD-3-Clause
#include "DescriptorLineTracker.h"

#include <algorithm>

#include "LineObservations.h"
#include "StageTimer.h"

namespace lintel {
namespace {

constexpr double kDetectorSigma_px = 1.0;

}  // namespace

DescriptorLineTracker::DescriptorLineTracker(const Rig& rig, const LineTrackerParams& params)
    : params_(params), camera_(rig.camera), detector_(camera_, params), matcher_(camera_, params) {}

std::vector<ImageLine> DescriptorLineTracker::detect(const ImagePyramid& pyramid, LineStatistics& statistics) {
  std::vector<ImageLine> detected;
  for (const ImageLine& line : detector_.detect(pyramid)) {
    const auto clipped = camera_.clip(line, params_.border_px);
    if (clipped && clipped->length() >= params_.min_length_px) detected.push_back(*clipped);
    if (static_cast<int>(detected.size()) == params_.max_lines) break;
  }
  statistics.detections += static_cast<std::int64_t>(detected.size());
  return detected;
}

void DescriptorLineTracker::process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion&,
                                    FrontEndStatistics& statistics) {
  observations_.clear();
  StageTimer timer(statistics, "lines_descriptor");
  const std::vector<ImageLine> detected = detect(pyramid, statistics.lines);
  const cv::Mat descriptors = matcher_.describe(pyramid.image(), detected);
  std::vector<ImageLine> expected;
  const auto turned = [&](const Eigen::Vector2d& u) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = gyro.R_c1_c0() * (u / camera_.focal()).homogeneous();
    return camera_.focal() * ray.head<2>() / std::max(ray.z(), 0.1);
  };
  for (const Track& track : tracks_) expected.push_back({turned(track.line.start), turned(track.line.end)});
  const auto matches = matcher_.match(expected, descriptors_, detected, descriptors);

  std::vector<Track> tracks;
  std::vector<char> continued(tracks_.size(), 0);
  for (std::size_t i = 0; i < detected.size(); ++i) {
    Track track;
    if (matches[i]) {
      track = tracks_[*matches[i]];
      continued[*matches[i]] = 1;
      ++track.length;
      ++statistics.lines.tracked;
      ++statistics.lines.tracked_detected;
    } else {
      track.id = next_id_++;
      ++statistics.lines.created;
    }
    track.line = detected[i];
    observations_.push_back(lineObservation(camera_, track.id, track.line, kDetectorSigma_px, track.length, true));
    tracks.push_back(track);
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (!continued[i]) {
      ++statistics.lines.lost_unmatched;
      statistics.lines.lifetimes.add(tracks_[i].length);
    }
  std::sort(observations_.begin(), observations_.end(),
            [](const LineObservation& a, const LineObservation& b) { return a.id < b.id; });
  tracks_ = std::move(tracks);
  descriptors_ = descriptors;
}

}  // namespace lintel
