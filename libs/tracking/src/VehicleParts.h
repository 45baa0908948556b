// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "lintel/geometry/Camera.h"

namespace lintel {

/// A point that was followed from one image to the next, or a place on a line across it [px].
struct FollowedPoint {
  cv::Point2f from, to;
  cv::Point2f turned;    ///< where the camera's rotation alone brings it
  bool on_line = false;  ///< `to` and `turned` are across a line: what happens along it is unknown
};

/// Finds what moves with the camera, as parts of the vehicle or of a person who carries it: what stays where it is in
/// the image when the camera turns one way and back, while other points move as the rotation says. A point of the scene
/// only stays when translation happens to compensate for rotation; in both directions it does not.
class VehicleParts {
 public:
  explicit VehicleParts(const Camera& camera);

  /// Takes a step's points, also those that other checks reject. Returns whether parts were found that were not known.
  bool observe(const std::vector<FollowedPoint>& points);

  /// Of the image's size, not 0 where a part is; empty as long as none is known.
  const cv::Mat& area() const { return area_; }
  /// Of the image that they cover.
  double share() const;

 private:
  /// What was seen in a square of the image: sums of turns in pixels that fade from point to point.
  struct Square {
    cv::Point2f direction;                               ///< of the first turn that a point did not take part in
    float stayed_ahead = 0, stayed_back = 0, moved = 0;  ///< turns in that direction, against it, and taken part in
    bool is_part = false;
  };

  Square& squareAt(const cv::Point2f& px);
  bool isNearPart(const cv::Point2f& px) const;
  bool isPart(const Square& square, const cv::Point2f& px) const;
  void draw();

  cv::Size image_, grid_;
  std::vector<Square> squares_;  ///< row by row
  cv::Mat area_;
};

}  // namespace lintel
