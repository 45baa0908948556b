// SPDX-License-Identifier: BSD-3-Clause
#include "VehicleParts.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lintel {
namespace {

constexpr int kSquare_px = 16;        ///< less than the distance between points
constexpr int kRim_px = 12;           ///< from the squares of its outermost corners to the edge of a part
constexpr int kBetweenParts_px = 40;  ///< between parts, also part of them: corners are at least 25 px apart

// Pixels of any image: multiples of the error of optical flow.
constexpr float kTurn_px = 2;           ///< a turn that counts moves a point so far at least
constexpr float kStayed_px = 0.4f;      ///< points that move less stay
constexpr float kMoved_px = 1;          ///< points that move more do not
constexpr float kTurnedEnough_px = 12;  ///< in each direction: a point of the scene would be elsewhere

constexpr float kTurnedNear_px = 8;  ///< in any, near a part that is known
constexpr int kNearPart_px = 40;     ///< from there

constexpr float kLineWeight = 0.3f;  ///< of its turn: in one direction translation compensates more often

constexpr float kLikeTurn =
    0.5f;  ///< of the turn: how far from it a point of the scene is that says that the camera turned
constexpr int kLeastTurning = 5;    ///< such points in a step, else the gyroscope may be wrong
constexpr float kMostMoved = 0.1f;  ///< of the turns in a part's square: points of the scene that pass beside the part
constexpr float kSquareFade = 0.95f;  ///< of what a square has seen, a point: about the last 20 count

}  // namespace

VehicleParts::VehicleParts(const Camera& camera)
    : image_(camera.width, camera.height),
      grid_(camera.width / kSquare_px + 1, camera.height / kSquare_px + 1),
      squares_(static_cast<std::size_t>(grid_.area())) {}

VehicleParts::Square& VehicleParts::squareAt(const cv::Point2f& px) {
  const int x = std::clamp(static_cast<int>(px.x) / kSquare_px, 0, grid_.width - 1),
            y = std::clamp(static_cast<int>(px.y) / kSquare_px, 0, grid_.height - 1);
  return squares_[static_cast<std::size_t>(y * grid_.width + x)];
}

bool VehicleParts::isNearPart(const cv::Point2f& px) const {
  if (area_.empty()) return false;
  const cv::Rect around(static_cast<int>(px.x) - kNearPart_px, static_cast<int>(px.y) - kNearPart_px, 2 * kNearPart_px,
                        2 * kNearPart_px);
  return cv::countNonZero(area_(around & cv::Rect({0, 0}, image_))) > 0;
}

bool VehicleParts::isPart(const Square& square, const cv::Point2f& px) const {
  const float stayed = square.stayed_ahead + square.stayed_back;
  if (square.moved > kMostMoved * stayed) return false;
  return std::min(square.stayed_ahead, square.stayed_back) >= kTurnedEnough_px ||
         (stayed >= kTurnedNear_px && isNearPart(px));
}

double VehicleParts::share() const {
  return area_.empty() ? 0.0 : static_cast<double>(cv::countNonZero(area_)) / area_.total();
}

bool VehicleParts::observe(const std::vector<FollowedPoint>& points) {
  const auto turnOf = [](const FollowedPoint& p) { return p.turned - p.from; };
  const auto turns = [&](const FollowedPoint& p) {
    const double turn_px = cv::norm(turnOf(p));
    return turn_px >= kTurn_px && turn_px < image_.width;  // else out of view
  };
  const auto turning = std::count_if(points.begin(), points.end(), [&](const FollowedPoint& p) {
    return turns(p) && cv::norm(p.to - p.turned) <= kLikeTurn * cv::norm(turnOf(p));
  });
  if (turning < kLeastTurning) return false;
  bool found = false;
  for (const FollowedPoint& p : points) {
    if (!turns(p)) continue;
    const double moved_px = cv::norm(p.to - p.from);
    if (moved_px > kStayed_px && moved_px < kMoved_px) continue;
    const cv::Point2f turn = turnOf(p);
    Square& square = squareAt(p.from);
    if (square.stayed_ahead == 0) square.direction = turn;
    for (float* sum : {&square.stayed_ahead, &square.stayed_back, &square.moved}) *sum *= kSquareFade;
    const float turn_px = (p.on_line ? kLineWeight : 1.0f) * static_cast<float>(cv::norm(turn));
    if (moved_px >= kMoved_px)
      square.moved += turn_px;
    else
      (turn.dot(square.direction) > 0 ? square.stayed_ahead : square.stayed_back) += turn_px;
    if (!square.is_part && isPart(square, p.from)) square.is_part = found = true;
  }
  if (found) draw();
  return found;
}

void VehicleParts::draw() {
  area_.create(image_, CV_8U);
  area_.setTo(0);
  for (int y = 0; y < grid_.height; ++y)
    for (int x = 0; x < grid_.width; ++x) {
      if (!squares_[static_cast<std::size_t>(y * grid_.width + x)].is_part) continue;
      const cv::Rect square(x * kSquare_px, y * kSquare_px, kSquare_px, kSquare_px);
      area_(square & cv::Rect({0, 0}, image_)).setTo(255);
    }
  const auto square = [](int side_px) { return cv::getStructuringElement(cv::MORPH_RECT, {side_px, side_px}); };
  cv::morphologyEx(area_, area_, cv::MORPH_CLOSE, square(kBetweenParts_px));
  cv::dilate(area_, area_, square(2 * kRim_px + 1));
}

}  // namespace lintel
