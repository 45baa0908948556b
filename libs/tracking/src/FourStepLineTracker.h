// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "LineDetector.h"
#include "LineFlow.h"
#include "LineMatcher.h"
#include "LineMerger.h"
#include "LineTracker.h"

namespace lintel {

/// Mode `four_steps`, the tracker of [Lim2021] as it is described there: in every frame lines are 1. detected, 2.
/// matched to those of the frame before by LBD descriptors, 3. predicted from the frame before by optical flow, and 4.
/// merged. Of a match and the prediction of the same line the one with the higher matching score is kept; a line that
/// was not matched, or is cut, is replaced by its prediction. Nothing lays lines on the edge afterwards, and a line has
/// neither depth nor motion of its own: what mode `flow` adds to this is what the two differ in.
///
/// The paper does not define the score. Here it is the share of bits in which the descriptors agree, times the share of
/// the line's former length that is left.
class FourStepLineTracker : public LineTracker {
 public:
  FourStepLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params);

  void process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
               FrontEndStatistics& statistics) override;
  const std::vector<LineObservation>& lines() const override { return observations_; }

 private:
  struct Track {
    TrackId id = 0;
    ImageLine line;
    cv::Mat descriptor;  ///< a row
    int length = 1;
    int undetected = 0;  ///< frames since it was last a detection
  };
  /// Where a line may be in the current frame.
  struct Place {
    ImageLine line;
    cv::Mat descriptor;
  };

  /// Per track; empty when it left the image or was not found.
  std::vector<std::optional<ImageLine>> predict(const ImagePyramid& pyramid, const GyroPrediction& gyro,
                                                const PointMotion& points, LineStatistics& statistics) const;
  /// Descriptors of lines and places of the tracks that are predicted.
  std::vector<Place> describe(const ImagePyramid& pyramid, const std::vector<ImageLine>& detected,
                              const std::vector<std::optional<ImageLine>>& predicted,
                              std::vector<std::optional<Place>>& places) const;
  std::vector<std::optional<std::size_t>> match(const std::vector<Place>& detected, const GyroPrediction& gyro) const;
  double score(const Track& track, const Place& place) const;
  /// Step 4 for the lines of the frame before; marks in `taken` the detections that continue one.
  std::vector<Track> merge(const std::vector<Place>& detected, const std::vector<std::optional<std::size_t>>& matches,
                           const std::vector<std::optional<Place>>& predicted, std::vector<char>& taken,
                           LineStatistics& statistics) const;
  void addNew(const std::vector<Place>& detected, const std::vector<char>& taken, std::vector<Track>& tracks,
              LineStatistics& statistics);

  LineTrackerParams params_;
  LineCamera camera_;
  LineDetector detector_;
  LineMatcher matcher_;
  LineFlow flow_;
  LineMerger merger_;
  std::vector<Track> tracks_;  ///< of the frame before, ascending id
  std::vector<LineObservation> observations_;
  TrackId next_id_ = 1;
};

}  // namespace lintel
