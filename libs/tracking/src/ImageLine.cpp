// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLine.h"

#include <algorithm>
#include <cmath>

namespace lintel {

LineCamera::LineCamera(const PinholeRadtan& camera) : camera_(camera), focal_(camera.meanFocal()), max_radius_(0) {
  for (const double x : {0.0, camera.width - 1.0})
    for (const double y : {0.0, camera.height - 1.0})
      max_radius_ = std::max(max_radius_, 1.02 * fromImage({x, y}).norm());
}

Eigen::Matrix2d LineCamera::imageJacobian(const Eigen::Vector2d& u) const {
  Eigen::Matrix2d J = camera_.distortJacobian(u / focal_) / focal_;
  J.row(0) *= camera_.fx;
  J.row(1) *= camera_.fy;
  return J;
}

bool LineCamera::sees(const Eigen::Vector2d& u, double border_px) const {
  return mayBeSeen(u) && camera_.contains(toImage(u), border_px);
}

std::optional<ImageLine> LineCamera::clip(const ImageLine& line, double border_px) const {
  constexpr int kSteps = 16;
  const auto seen = [&](double share) { return sees(line.at(share), border_px); };
  int first = 0, last = kSteps;
  while (first <= kSteps && !seen(static_cast<double>(first) / kSteps)) ++first;
  if (first > kSteps) return std::nullopt;
  while (!seen(static_cast<double>(last) / kSteps)) --last;
  // The border lies between a seen and an unseen step.
  const auto bisect = [&](double in, double out) {
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (in + out);
      (seen(middle) ? in : out) = middle;
    }
    return in;
  };
  const double s0 =
      first == 0 ? 0.0 : bisect(static_cast<double>(first) / kSteps, static_cast<double>(first - 1) / kSteps);
  const double s1 =
      last == kSteps ? 1.0 : bisect(static_cast<double>(last) / kSteps, static_cast<double>(last + 1) / kSteps);
  return ImageLine{line.at(s0), line.at(s1)};
}

LineRelation relate(const ImageLine& line, const ImageLine& other) {
  const Eigen::Vector2d d = line.direction(), n = line.normal(), e = other.direction();
  const double s0 = d.dot(other.start - line.start), s1 = d.dot(other.end - line.start);
  LineRelation relation;
  relation.angle_rad = std::abs(std::atan2(d.x() * e.y() - d.y() * e.x(), d.dot(e)));
  relation.distance_px = std::max(std::abs(n.dot(other.start - line.start)), std::abs(n.dot(other.end - line.start)));
  relation.overlap_px = std::min(line.length(), std::max(s0, s1)) - std::max(0.0, std::min(s0, s1));
  return relation;
}

}  // namespace lintel
