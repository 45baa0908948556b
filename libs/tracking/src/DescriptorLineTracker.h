// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "LineDetector.h"
#include "LineTracker.h"

namespace lintel {

/// Matches segments of two frames by LBD descriptors, gated by geometry.
class LineMatcher {
 public:
  LineMatcher(const LineCamera& camera, const LineTrackerParams& params);
  ~LineMatcher();

  /// One descriptor (a row of bytes) per line.
  cv::Mat describe(const cv::Mat& image, const std::vector<ImageLine>& lines) const;

  /// For every line of `to` the one of `from` it continues, each used once. `expected` are the lines of `from` where
  /// they should be seen now.
  std::vector<std::optional<std::size_t>> match(const std::vector<ImageLine>& expected, const cv::Mat& from_descriptors,
                                                const std::vector<ImageLine>& to, const cv::Mat& to_descriptors) const;

 private:
  struct Engine;
  const LineCamera& camera_;
  LineTrackerParams params_;
  std::unique_ptr<Engine> engine_;
};

/// Mode `descriptor`: lines are detected in every frame and matched to those of the frame before by LBD descriptors.
/// The baseline that optical flow is compared with.
class DescriptorLineTracker : public LineTracker {
 public:
  DescriptorLineTracker(const Rig& rig, const LineTrackerParams& params);

  void process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
               FrontEndStatistics& statistics) override;
  const std::vector<LineObservation>& lines() const override { return observations_; }

 private:
  struct Track {
    TrackId id = 0;
    ImageLine line;
    int length = 1;
  };

  std::vector<ImageLine> detect(const ImagePyramid& pyramid, LineStatistics& statistics);

  LineTrackerParams params_;
  LineCamera camera_;
  LineDetector detector_;
  LineMatcher matcher_;
  std::vector<Track> tracks_;  ///< of the frame before
  cv::Mat descriptors_;
  std::vector<LineObservation> observations_;
  TrackId next_id_ = 1;
};

}  // namespace lintel
