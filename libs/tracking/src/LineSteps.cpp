// SPDX-License-Identifier: BSD-3-Clause
#include "LineSteps.h"

#include <algorithm>
#include <cmath>

namespace lintel {
namespace {

constexpr double kStaysWithin_px = 1.5;   ///< between two detections of one edge, at half resolution
constexpr double kLeastTurn_px = 6;       ///< a turn that counts moves a line so far across itself: four times that
constexpr double kMostAngle_rad = 0.035;  ///< between them: 2 degrees, how exactly a piece of 30 px is known
constexpr double kLeastOverlap = 0.5;     ///< of the shorter one
constexpr double kMovesLikeTurn = 0.4;    ///< of the turn: how far from it a line is that moved with the scene
constexpr double kBetweenPlaces_px = 16;  ///< between places along a line

/// Whether one of `detected` lies on `line`.
bool isAmong(const LineCamera& camera, const ImageLine& line, const std::vector<ImageLine>& detected,
             double distance_px) {
  return std::any_of(detected.begin(), detected.end(), [&](const ImageLine& other) {
    const auto relation = camera.relateNear(line, other, distance_px);
    return relation && relation->angle_rad < kMostAngle_rad &&
           relation->overlap_px > kLeastOverlap * std::min(line.length(), other.length());
  });
}

cv::Point2f pixel(const Eigen::Vector2d& px) { return {static_cast<float>(px.x()), static_cast<float>(px.y())}; }

}  // namespace

void LineSteps::compare(const ImageLine& line, const std::vector<ImageLine>& detected,
                        std::vector<FollowedPoint>& followed) const {
  const ImageLine turned = camera_.turned(line, R_c1_c0_), same = camera_.seenFrom(line.axis, turned);
  const Eigen::Vector2d n = same.normal();
  const double start_px = n.dot(same.start - line.start), end_px = n.dot(same.start - line.end);
  const double turn_px = std::min(std::abs(start_px), std::abs(end_px));
  if (start_px * end_px <= 0 || turn_px < kLeastTurn_px) return;
  const bool stayed = isAmong(camera_, line, detected, kStaysWithin_px),
             moved = isAmong(camera_, turned, detected, kMovesLikeTurn * turn_px);
  if (stayed == moved) return;
  const int places = 1 + static_cast<int>(line.length() / kBetweenPlaces_px);
  for (int k = 0; k < places; ++k) {
    const double share = (k + 0.5) / places;
    const Eigen::Vector2d u = line.at(share), turned_u = u + n * n.dot(same.start - u);
    const cv::Point2f from = pixel(camera_.toImage(u, line.axis)), to = pixel(camera_.toImage(turned_u, line.axis));
    followed.push_back({from, stayed ? from : to, to, true});
  }
}

std::vector<FollowedPoint> LineSteps::followed(const std::vector<ImageLine>& detected) {
  std::vector<FollowedPoint> followed;
  for (const ImageLine& line : before_) compare(line, detected, followed);
  before_ = detected;
  R_c1_c0_.setIdentity();
  return followed;
}

}  // namespace lintel
