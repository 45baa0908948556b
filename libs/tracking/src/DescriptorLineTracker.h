// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "LineDetector.h"
#include "LineMatcher.h"
#include "LineTracker.h"

namespace lintel {

/// Mode `descriptor`: lines are detected in every frame and matched to those of the frame before by LBD descriptors.
/// The baseline that optical flow is compared with.
class DescriptorLineTracker : public LineTracker {
 public:
  DescriptorLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params);

  void process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
               FrontEndStatistics& statistics) override;
  const std::vector<LineObservation>& lines() const override { return observations_; }

 private:
  struct Track {
    TrackId id = 0;
    ImageLine line;
    int length = 1;
  };

  LineCamera camera_;
  LineDetector detector_;
  LineMatcher matcher_;
  std::vector<Track> tracks_;  ///< of the frame before
  cv::Mat descriptors_;
  std::vector<LineObservation> observations_;
  TrackId next_id_ = 1;
};

}  // namespace lintel
