// SPDX-License-Identifier: BSD-3-Clause
#include "LineDepth.h"

#include <algorithm>
#include <cmath>

namespace lintel {
namespace {

constexpr double kDepthDrift = 0.008;  ///< relative growth of a depth's uncertainty per step: the translation's errors
constexpr double kAssumedSigma = 1;    ///< of an assumed inverse depth, relative: unknown

InverseDepth interpolate(const LineDepth& depth, double share) {
  return {(1 - share) * depth.start.w + share * depth.end.w,
          (1 - share) * (1 - share) * depth.start.variance + share * share * depth.end.variance};
}

}  // namespace

LineDepth assumedDepth(const StepTranslation& step) {
  const double w = step.typicalInverseDepth();
  const InverseDepth assumed{w, kAssumedSigma * kAssumedSigma * w * w};
  return {assumed, assumed, step.epoch()};
}

CarriedDepth carry(const LineDepth& depth, const ImageLine& line, const ImageLine& turned,
                   const Eigen::Quaterniond& R_c1_c0, const Eigen::Vector3d& t_c1, double focal_px) {
  CarriedDepth carried;
  carried.depth.epoch = depth.epoch;
  const Eigen::Vector2d n = turned.normal();
  const auto end = [&](const InverseDepth& from, const Eigen::Vector2d& u0, const Eigen::Vector2d& u1, InverseDepth& to,
                       double& sigma_px) -> Eigen::Vector2d {
    const double z = std::max((R_c1_c0 * (u0 / focal_px).homogeneous()).z(), 0.1);
    to = {carriedInverseDepth(from.w / z, t_c1.z()), from.variance / (z * z)};
    to.variance += kDepthDrift * kDepthDrift * to.w * to.w;
    const Eigen::Vector2d e = focal_px * parallaxDirection(u1 / focal_px, t_c1);
    sigma_px = std::abs(n.dot(e)) * std::sqrt(to.variance);
    return u1 + to.w * e;
  };
  carried.line.start = end(depth.start, line.start, turned.start, carried.depth.start, carried.sigma_px.x());
  carried.line.end = end(depth.end, line.end, turned.end, carried.depth.end, carried.sigma_px.y());
  return carried;
}

LineDepth observe(const CarriedDepth& carried, const ImageLine& turned, const ImageLine& seen,
                  const Eigen::Vector3d& t_c1, double focal_px, double noise_px) {
  const Eigen::Vector2d n = seen.normal();
  const auto update = [&](InverseDepth depth, const Eigen::Vector2d& expected, const Eigen::Vector2d& from) {
    const double q = focal_px * n.dot(parallaxDirection(from / focal_px, t_c1));
    const double gain = depth.variance * q / (q * q * depth.variance + noise_px * noise_px);
    depth.w += gain * n.dot(seen.start - expected);
    depth.variance *= 1 - gain * q;
    return depth;
  };
  const LineDepth updated{update(carried.depth.start, carried.line.start, turned.start),
                          update(carried.depth.end, carried.line.end, turned.end), carried.depth.epoch};
  return alongLine(updated, carried.line, seen);
}

LineDepth alongLine(const LineDepth& depth, const ImageLine& from, const ImageLine& to) {
  const Eigen::Vector2d d = to.direction();
  const double a = d.dot(from.start - to.start), b = d.dot(from.end - to.start);
  const double span = std::max(b - a, 1.0);
  return {interpolate(depth, -a / span), interpolate(depth, (to.length() - a) / span), depth.epoch};
}

}  // namespace lintel
