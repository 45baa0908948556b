// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "CornerDetector.h"
#include "DriftCheck.h"
#include "GyroPrediction.h"
#include "ImageMask.h"
#include "ImagePyramid.h"
#include "PatchAnchors.h"
#include "PatchFlow.h"
#include "PointsTurn.h"
#include "StepTranslation.h"
#include "TwoViewMotion.h"
#include "VehicleParts.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/tracking/FrontEndParams.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// Motion of a point that was followed into the current frame, for the prediction of lines.
struct PointFlow {
  cv::Point2f px;                     ///< in the current frame
  cv::Point2f residual;               ///< flow beyond what the rotation explains
  std::optional<cv::Point2f> change;  ///< of the residual against that of the step before; empty for a new point
};

/// Motion of the points and of the camera, for the prediction of lines.
struct PointMotion {
  const std::vector<PointFlow>& flow;  ///< of the points that were followed into the current frame
  const StepTranslation& step;         ///< of the camera
};

/// KLT tracks of corners from frame to frame. A lost point is not detected again under its identity.
class PointTracker {
 public:
  /// Nothing is followed or detected where `mask` covers the image.
  PointTracker(const Rig& rig, const ImageMask& mask, const PointTrackerParams& params);

  /// Follows the points into the pyramid's current frame, corrects `gyro` by their motion, and adds new ones.
  void process(const ImagePyramid& pyramid, GyroPrediction& gyro, FrontEndStatistics& statistics);

  /// Points of the current frame, ascending id.
  const std::vector<PointObservation>& points() const { return points_; }
  /// The last step of all that optical flow followed, also what geometry rejected.
  const std::vector<FollowedPoint>& followed() const { return followed_; }
  PointMotion motion() const { return {flow_, step_}; }

  /// How the camera turned since the frame before, by the points alone; without times.
  const std::optional<CameraTurn>& turn() const { return turn_; }

 private:
  enum class Outcome : char { kTracked, kLost, kNotReturned };
  struct Followed {
    std::vector<cv::Point2f> px;
    std::vector<Outcome> outcome;
  };

  /// Follows the points of `indices` from where `followed` guesses them; those that were not registered to their
  /// patch also back.
  void followFrom(const ImagePyramid& pyramid, const std::vector<std::size_t>& indices, int levels, Followed& followed);
  void followBack(const ImagePyramid& pyramid, const std::vector<std::size_t>& indices, Followed& followed) const;
  Followed follow(const ImagePyramid& pyramid, const GyroPrediction& gyro, PointStatistics& statistics);
  void noteFollowed(const Followed& followed, const GyroPrediction& gyro);
  void startAnchors(const ImagePyramid& pyramid, const Followed& followed);
  void rejectByEpipolarGeometry(Followed& followed, GyroPrediction& gyro, PointStatistics& statistics);
  void rejectCrowded(Followed& followed, PointStatistics& statistics) const;
  void accept(const Followed& followed, const GyroPrediction& gyro, PointStatistics& statistics);
  void rejectDrifting(const GyroPrediction& gyro, PointStatistics& statistics);
  void addNew(const ImagePyramid& pyramid, PointStatistics& statistics);
  std::vector<cv::Point2f> pixels() const;
  PatchFlowParams flowParams(int levels) const;

  bool mayBeAt(const cv::Point2f& px) const;

  Camera camera_;
  ImageMask mask_;
  PointTrackerParams params_;
  CornerDetector detector_;
  DriftCheck drift_;
  PatchAnchors anchors_;
  std::vector<PointObservation> points_;
  std::vector<PointFlow> flow_;
  std::vector<FollowedPoint> followed_;
  StepTranslation step_;
  std::optional<CameraTurn> turn_;
  std::map<TrackId, cv::Point2f> residuals_;  ///< of the last step
  TrackId next_id_ = 1;
  int frames_since_detection_ = 0;
};

}  // namespace lintel
