// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "GyroPrediction.h"
#include "ImageLine.h"
#include "ImagePyramid.h"
#include "LineDepth.h"
#include "PointTracker.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// A line of the frame before. `motion`: how far its start and end moved along its normal in the last step, beyond what
/// the camera's rotation explains [px]; empty for a new line. The line's next step is predicted as its last
/// one plus the change of motion of the points nearby.
struct CarriedLine {
  ImageLine line;
  std::optional<Eigen::Vector2d> motion;
  std::optional<LineDepth> depth;  ///< when known, better than `motion`
};

/// A line carried into the current frame.
struct PredictedLine {
  ImageLine line;
  ImageLine turned;                   ///< where the line would be after the rotation only
  ImageLine expected;                 ///< where its own motion and that of the points nearby bring it
  double limit_px = 0;                ///< further from `expected` it is another edge; see LineFlow::predict
  double typical_px = 0;              ///< how far this frame's lines are from where they were expected
  std::optional<CarriedDepth> depth;  ///< what `expected` relies on
  bool by_flow = false;               ///< false: optical flow failed; predicted by the gyroscope and the points nearby
};

/// Carries lines from one frame to the next: several points along each are followed by KLT, starting from the
/// prediction by gyro and nearby tracked points, and a line is fitted to them in undistorted coordinates [Lim2021, line
/// tracking].
class LineFlow {
 public:
  LineFlow(const LineCamera& camera, const LineTrackerParams& params) : camera_(camera), params_(params) {}

  /// One result per line; empty when it left the image.
  std::vector<std::optional<PredictedLine>> predict(const std::vector<CarriedLine>& lines, const ImagePyramid& pyramid,
                                                    const GyroPrediction& gyro, const PointMotion& points) const;

 private:
  struct Samples {
    std::vector<std::size_t> first;          ///< of each line; one more at the end
    std::vector<cv::Point2f> from, guess;    ///< image pixels
    std::vector<ImageLine> turned, guessed;  ///< per line: by the rotation only, and with the expected motion
    std::vector<std::optional<CarriedDepth>> depths;
  };
  /// Search range of optical flow.
  struct Reach {
    int window_px, levels;
    double jump_px;  ///< largest distance from where a line with a history is expected
  };
  std::vector<PredictedLine> follow(const std::vector<CarriedLine>& lines, const ImagePyramid& pyramid,
                                    const GyroPrediction& gyro, const PointMotion& points, const Reach& reach) const;
  static double typicalDeviation(const std::vector<CarriedLine>& lines, const std::vector<PredictedLine>& followed);
  Samples sample(const std::vector<CarriedLine>& lines, const GyroPrediction& gyro, const PointMotion& points) const;
  /// carry() between the lines' own cameras.
  CarriedDepth carriedDepth(const LineDepth& depth, const ImageLine& line, const ImageLine& turned,
                            const Eigen::Quaterniond& R_c1_c0, const Eigen::Vector3d& t_c1) const;

  PredictedLine fit(const Samples& samples, std::size_t index, double jump_px, const std::vector<cv::Point2f>& to,
                    const std::vector<unsigned char>& found) const;

  const LineCamera& camera_;
  LineTrackerParams params_;
};

/// Motion along the normal of `turned` that brings its ends onto the infinite `line` (start, end) [px].
Eigen::Vector2d normalMotion(const ImageLine& turned, const ImageLine& line);

/// How the tracked points around `px` moved beyond the rotation, nearer ones with more weight; zero without any. Points
/// nearer than `near_px` have the same weight.
struct NearbyMotion {
  cv::Point2f residual{0, 0};  ///< mean of PointFlow::residual
  cv::Point2f change{0, 0};    ///< mean of PointFlow::change
};
NearbyMotion motionNear(const cv::Point2f& px, const std::vector<PointFlow>& points, float near_px);

}  // namespace lintel
