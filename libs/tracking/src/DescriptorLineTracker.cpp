// SPDX-License-Identifier: BSD-3-Clause
#include "DescriptorLineTracker.h"

#include <algorithm>

namespace lintel {

DescriptorLineTracker::DescriptorLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params)
    : camera_(rig.camera, mask), detector_(camera_, params), matcher_(camera_, params) {}

void DescriptorLineTracker::process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion&,
                                    FrontEndStatistics& statistics) {
  observations_.clear();
  StageTimer timer(statistics, "lines_descriptor");
  const std::vector<ImageLine> detected = detector_.detectLong(pyramid);
  statistics.lines.detections += static_cast<std::int64_t>(detected.size());
  const cv::Mat descriptors = matcher_.describe(pyramid.image(), detected);
  std::vector<ImageLine> expected;
  for (const Track& track : tracks_) expected.push_back(camera_.turned(track.line, gyro.R_c1_c0()));
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
    observations_.push_back(
        lineObservation(camera_, track.id, track.line, LineDetector::kSigma_px, track.length, true));
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
