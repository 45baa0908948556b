// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "EdgeAppearance.h"
#include "EdgeRefiner.h"
#include "LineDetector.h"
#include "LineFlow.h"
#include "LineMerger.h"
#include "LineSteps.h"
#include "LineTracker.h"

namespace lintel {

/// Mode `flow`: predict by optical flow, merge with detections when there are any, lay the result on the image's edges.
class FlowLineTracker : public LineTracker {
 public:
  FlowLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params);

  void process(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
               FrontEndStatistics& statistics) override;
  std::vector<FollowedPoint> followed() const override { return followed_; }
  const std::vector<LineObservation>& lines() const override { return observations_; }

 private:
  struct Track {
    TrackId id = 0;  ///< 0: not published yet
    ImageLine line;
    ImageLine turned;                     ///< its last place, turned into this frame
    ImageLine expected;                   ///< and where its motion brings it
    double limit_px = 0;                  ///< largest distance from there
    double typical_px = 0;                ///< see PredictedLine
    std::optional<CarriedDepth> carried;  ///< its depth, where `expected` relies on it
    std::optional<LineDepth> depth;
    Eigen::Vector2d drift{0, 0};  ///< of its ends from where its depth brings them, summed up with exponential decay
    std::optional<Eigen::Vector2d> motion;  ///< of its ends beyond the rotation, see CarriedLine
    std::optional<SideLevels> sides;        ///< when last seen
    double sigma_px = 1;
    int length = 0;      ///< frames in which it was published
    int sightings = 1;   ///< frames in which the detector saw it
    int undetected = 0;  ///< frames since the detector last saw it
    bool by_flow = true;
    bool detected = true;
  };

  void predict(const ImagePyramid& pyramid, const GyroPrediction& gyro, const PointMotion& points,
               LineStatistics& statistics);
  std::vector<ImageLine> mergeDetections(const ImagePyramid& pyramid, FrontEndStatistics& statistics);
  void refine(const ImagePyramid& pyramid, const StepTranslation& step, LineStatistics& statistics);
  bool moveTo(const ImagePyramid& pyramid, const ImageLine& line, const StepTranslation& step, Track& track) const;
  void extend(const ImagePyramid& pyramid, const ImageLine& united, Track& track) const;
  void dropDuplicates(LineStatistics& statistics);
  void addNew(const ImagePyramid& pyramid, const std::vector<ImageLine>& fresh);
  void publish(LineStatistics& statistics);
  void end(const Track& track, std::int64_t& reason, LineStatistics& statistics) const;

  LineTrackerParams params_;
  LineCamera camera_;
  LineDetector detector_;
  LineFlow flow_;
  LineMerger merger_;
  LineSteps steps_;
  EdgeRefiner refiner_;
  std::vector<Track> tracks_;  ///< by age: ascending id, then those without one
  std::vector<LineObservation> observations_;
  std::vector<FollowedPoint> followed_;
  TrackId next_id_ = 1;
  int frames_since_detection_ = 0;
};

}  // namespace lintel
