// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <opencv2/core.hpp>

#include "lintel/core/FrameTracks.h"

namespace lintel {

/// Result of registering a track to its patch.
enum class AnchorVerdict {
  kHeld,    ///< moved to the place that matches its patch
  kUnsure,  ///< no such place, or no patch: it stays at the result of the flow
  kLost,    ///< no such place for some frames: the track has drifted off its point
};

/// Registers points to the patch of their first sighting. Errors of optical flow from frame to frame accumulate: after
/// forty frames a track has drifted by half a pixel. Here the patch of the first sighting is aligned with the current
/// image, by an affine warp, starting from the result of the flow [Baker2004, inverse compositional; Shi1994].
class PatchAnchors {
 public:
  /// `failures`: in a row, before a track is lost.
  explicit PatchAnchors(int failures) : max_failures_(failures) {}

  /// The patch of a track that has none.
  void add(TrackId id, const cv::Mat& image, const cv::Point2f& px);
  bool has(TrackId id) const { return anchors_.count(id) > 0; }

  /// Moves `px` to the place in `image` (8 bit grey) that matches the track's patch, if there is one.
  AnchorVerdict align(TrackId id, const cv::Mat& image, cv::Point2f& px);

  /// Forgets the patches of tracks that are not in `points` (ascending id).
  void keepOnly(const std::vector<PointObservation>& points);

 private:
  static constexpr int kHalf = 6, kSide = 2 * kHalf + 1, kPixels = kSide * kSide;
  static constexpr int kParameters = 6;  ///< shift, and the linear part
  using Patch = Eigen::Matrix<float, kPixels, 1>;

  /// The view of a patch: image = place + A offset.
  struct Warp {
    cv::Point2f place;
    Eigen::Matrix2f A = Eigen::Matrix2f::Identity();
  };

  struct Anchor {
    Patch patch;                                             ///< mean 0, norm 1
    Eigen::Matrix<float, kPixels, kParameters> J;            ///< of the patch, brightness and contrast taken out
    Eigen::Matrix<float, kParameters, kParameters> inverse;  ///< of J' J, damped
    Eigen::Matrix2f A = Eigen::Matrix2f::Identity();         ///< in the last image that agreed
    int failures = 0;
  };

  static bool sample(const cv::Mat& image, const Warp& warp, Patch& patch);
  static bool makeAnchor(const cv::Mat& image, const cv::Point2f& px, Anchor& anchor);
  static bool alignPatch(const Anchor& anchor, const cv::Mat& image, Warp& warp);

  int max_failures_;
  std::map<TrackId, Anchor> anchors_;
};

}  // namespace lintel
