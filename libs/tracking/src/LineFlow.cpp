// SPDX-License-Identifier: BSD-3-Clause
#include "LineFlow.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "PatchFlow.h"
#include "lintel/core/Quantiles.h"

namespace lintel {
namespace {

// Limits of the image itself: noise, blur, and how exactly a patch or an edge is found. They do not scale with the
// camera.
constexpr double kLineTexture = 1e-3;  ///< a patch on a plain edge has nearly none along it, and is used
constexpr double kLineSettled_px =
    0.03;  ///< a smaller step ends optical flow: a tenth of the error it is taken to have
constexpr double kFitTolerance_px = 1.5;  ///< of a sample from the line: five times the error of optical flow
constexpr double kSureDepth_px = 1.5;     ///< a line whose depth predicts it less exactly is expected to move as before
constexpr double kTolerance_px = 2;       ///< a line may always be this far from where it is expected
constexpr double kTimesTypical = 4;       ///< and this many times as far as the other lines of the frame are

// Angles, in pixels at the reference focal length: motion and neighbourhoods.
constexpr double kSpacing_px = 15;       ///< between samples, when the line is neither short nor long
constexpr double kNear_px = 20;          ///< points nearer than this have the same weight
constexpr double kMaxDeviation_px = 40;  ///< flow further than this from the guess is an error

Eigen::Vector2d toEigen(const cv::Point2f& p) { return {p.x, p.y}; }
cv::Point2f toPoint(const Eigen::Vector2d& p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

/// Lays the guessed ends on the fitted line, moved along it by what the samples moved. A patch on a plain edge slides
/// along it, so that the median of all is more accurate than the ends' own patches.
ImageLine carryEnds(const ImageLine& guess, const RobustLine& fit, const std::vector<Eigen::Vector2d>& guessed,
                    const std::vector<Eigen::Vector2d>& found) {
  Eigen::Vector2d d = fit.line.direction();
  if (d.dot(guess.end - guess.start) < 0) d = -d;
  std::vector<double> along;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (fit.inlier[i]) along.push_back(d.dot(found[i] - guessed[i]));
  const double shift = upperMedian(along);
  const auto lay = [&](const Eigen::Vector2d& end) -> Eigen::Vector2d {
    return fit.line.start + d * (d.dot(end - fit.line.start) + shift);
  };
  return {lay(guess.start), lay(guess.end), guess.axis};
}

}  // namespace

NearbyMotion motionNear(const cv::Point2f& px, const std::vector<PointFlow>& points, float near_px) {
  NearbyMotion sum;
  float residuals = 0, changes = 0;
  for (const PointFlow& point : points) {
    const cv::Point2f away = point.px - point.residual - px;  // compared where both are predicted to be
    const float weight = 1.0f / ((away.dot(away) + near_px * near_px) * (away.dot(away) + near_px * near_px));
    sum.residual += weight * point.residual;
    residuals += weight;
    if (!point.change) continue;
    sum.change += weight * *point.change;
    changes += weight;
  }
  if (residuals > 0) sum.residual *= 1.0f / residuals;
  if (changes > 0) sum.change *= 1.0f / changes;
  return sum;
}

Eigen::Vector2d normalMotion(const ImageLine& turned, const ImageLine& line) {
  const Eigen::Vector2d n = turned.normal(), m = line.normal();
  const double along = std::max(n.dot(m), 0.1);
  return {m.dot(line.start - turned.start) / along, m.dot(line.start - turned.end) / along};
}

CarriedDepth LineFlow::carriedDepth(const LineDepth& depth, const ImageLine& line, const ImageLine& turned,
                                    const Eigen::Quaterniond& R_c1_c0, const Eigen::Vector3d& t_c1) const {
  if (!camera_.camera().wide()) return carry(depth, line, turned, R_c1_c0, t_c1, camera_.focal());
  const Eigen::Matrix3d R_c0_l0 = LineCamera::R_c_a(line.axis), R_l1_c1 = LineCamera::R_c_a(turned.axis).transpose();
  const Eigen::Quaterniond R(Eigen::Matrix3d(R_l1_c1 * R_c1_c0.toRotationMatrix() * R_c0_l0));
  return carry(depth, line, turned, R, R_l1_c1 * t_c1, camera_.focal());
}

LineFlow::Samples LineFlow::sample(const std::vector<CarriedLine>& lines, const GyroPrediction& gyro,
                                   const PointMotion& points) const {
  Samples samples;
  const auto near_px = static_cast<float>(camera_.scaled(kNear_px));
  const double spacing_px = camera_.scaled(kSpacing_px);
  const bool wide = camera_.camera().wide();
  for (const CarriedLine& carried : lines) {
    samples.first.push_back(samples.from.size());
    const ImageLine turned = camera_.turned(carried.line, gyro.R_c1_c0());
    const auto turnedAt = [&](double share) {
      return gyro.turnedPixel(camera_.camera(), camera_.rayOf(carried.line.at(share), carried.line.axis));
    };
    const NearbyMotion near_start = motionNear(turnedAt(0.1), points.flow, near_px),
                       near_end = motionNear(turnedAt(0.9), points.flow, near_px);
    // motion in the image as one of undistorted pixels
    const auto undistorted = [&](const cv::Point2f& motion, double share) -> Eigen::Vector2d {
      if (!wide) return toEigen(motion);
      return camera_.imageJacobian(turned.at(share), turned.axis).inverse() * toEigen(motion);
    };
    Eigen::Vector2d at_start = undistorted(near_start.residual, 0.1), at_end = undistorted(near_end.residual, 0.9);
    if (carried.motion) {  // across the line its own motion is known better than that of the points nearby
      const Eigen::Vector2d n = turned.normal();
      at_start += n * (carried.motion->x() + n.dot(undistorted(near_start.change, 0.1) - at_start));
      at_end += n * (carried.motion->y() + n.dot(undistorted(near_end.change, 0.9) - at_end));
    }
    std::optional<CarriedDepth> depth;
    if (carried.depth && carried.depth->epoch == points.step.epoch()) {
      depth = carriedDepth(*carried.depth, carried.line, turned, gyro.R_c1_c0(), points.step.t_c1());
      if (depth->sigma_px.maxCoeff() < kSureDepth_px) {
        at_start = depth->line.start - turned.start;
        at_end = depth->line.end - turned.end;
      }
    }
    samples.depths.push_back(depth);
    samples.turned.push_back(turned);
    samples.guessed.push_back({turned.start + at_start, turned.end + at_end, turned.axis});
    const int count =
        std::clamp(static_cast<int>(carried.line.length() / spacing_px), params_.min_samples, params_.max_samples);
    for (int i = 0; i < count; ++i) {
      const double share = (i + 0.5) / count;
      const Eigen::Vector2d from = camera_.toImage(carried.line.at(share), carried.line.axis);
      const Eigen::Vector2d motion = (1 - share) * at_start + share * at_end;
      samples.from.emplace_back(static_cast<float>(from.x()), static_cast<float>(from.y()));
      samples.guess.push_back(wide ? toPoint(camera_.toImage(turned.at(share) + motion, turned.axis))
                                   : turnedAt(share) + toPoint(motion));
    }
  }
  samples.first.push_back(samples.from.size());
  return samples;
}

PredictedLine LineFlow::fit(const Samples& samples, std::size_t index, double jump_px,
                            const std::vector<cv::Point2f>& to, const std::vector<unsigned char>& found) const {
  const ImageLine& guess = samples.guessed[index];
  std::vector<Eigen::Vector2d> guessed_u, found_u;
  guessed_u.reserve(samples.first[index + 1] - samples.first[index]);
  found_u.reserve(samples.first[index + 1] - samples.first[index]);
  for (std::size_t i = samples.first[index]; i < samples.first[index + 1]; ++i) {
    const Eigen::Vector2d px = toEigen(to[i]);
    if (!found[i] || !camera_.uses(px, 1) || camera_.mask().covers(toEigen(samples.from[i])) ||
        cv::norm(to[i] - samples.guess[i]) > camera_.scaled(kMaxDeviation_px))
      continue;
    guessed_u.push_back(camera_.fromImage(toEigen(samples.guess[i]), guess.axis));
    found_u.push_back(camera_.fromImage(px, guess.axis));
  }
  PredictedLine result{guess, samples.turned[index], guess, jump_px, 0, samples.depths[index], false};
  const auto robust = fitRobustLine(found_u, kFitTolerance_px);
  if (!robust) return result;
  const ImageLine carried = carryEnds(guess, *robust, guessed_u, found_u);
  // Among parallel stripes flow may converge to a neighbour, so that jumps against the line's former motion are
  // rejected.
  if (normalMotion(guess, carried).cwiseAbs().maxCoeff() > jump_px) return result;
  result.line = carried;
  result.by_flow = true;
  return result;
}

std::vector<PredictedLine> LineFlow::follow(const std::vector<CarriedLine>& lines, const ImagePyramid& pyramid,
                                            const GyroPrediction& gyro, const PointMotion& points,
                                            const Reach& reach) const {
  const Samples samples = sample(lines, gyro, points);
  std::vector<cv::Point2f> to = samples.guess;
  const PatchFlowParams flow{reach.window_px, reach.levels, params_.max_iterations, kLineSettled_px, kLineTexture};
  const std::vector<unsigned char> found = followPatches(pyramid.previous(), pyramid.current(), samples.from, flow, to);
  std::vector<PredictedLine> followed;
  for (std::size_t i = 0; i < lines.size(); ++i)
    followed.push_back(fit(samples, i, lines[i].motion ? reach.jump_px : camera_.scaled(kMaxDeviation_px), to, found));
  return followed;
}

double LineFlow::typicalDeviation(const std::vector<CarriedLine>& lines, const std::vector<PredictedLine>& followed) {
  std::vector<double> deviations;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].motion)
      deviations.push_back(followed[i].by_flow
                               ? normalMotion(followed[i].expected, followed[i].line).cwiseAbs().maxCoeff()
                               : followed[i].limit_px);
  return deviations.empty() ? 0.0 : upperMedian(deviations);
}

std::vector<std::optional<PredictedLine>> LineFlow::predict(const std::vector<CarriedLine>& lines,
                                                            const ImagePyramid& pyramid, const GyroPrediction& gyro,
                                                            const PointMotion& points) const {
  std::vector<std::optional<PredictedLine>> predicted(lines.size());
  if (lines.empty()) return predicted;
  std::vector<PredictedLine> followed =
      follow(lines, pyramid, gyro, points, {params_.window_px, params_.flow_levels, params_.max_jump_px});

  // A jerk of the camera displaces all lines, a wrong edge just one: the limit for each follows from what the lines of
  // this frame have in common.
  const double typical_px = typicalDeviation(lines, followed);
  const double limit_px = std::min(params_.max_jump_px, kTolerance_px + kTimesTypical * typical_px);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].motion) continue;
    followed[i].limit_px = limit_px;
    if (followed[i].by_flow && normalMotion(followed[i].expected, followed[i].line).cwiseAbs().maxCoeff() > limit_px)
      followed[i].by_flow = false;
  }
  // The few that were not found are looked for again from further away: jerks and motion blur.
  std::vector<CarriedLine> again;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!followed[i].by_flow) {
      again.push_back(lines[i]);
      index.push_back(i);
    }
  if (!again.empty()) {
    const Reach further{std::max(params_.window_px, pyramid.windowPx()), pyramid.levels(), 1.5 * limit_px};
    const std::vector<PredictedLine> second = follow(again, pyramid, gyro, points, further);
    for (std::size_t k = 0; k < index.size(); ++k) followed[index[k]] = second[k];
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    PredictedLine& result = followed[i];
    if (!result.line.start.allFinite() || !result.line.end.allFinite()) continue;
    const auto clipped = camera_.clip(result.line, params_.border_px);
    if (!clipped) continue;
    result.line = *clipped;
    result.limit_px = lines[i].motion ? limit_px : camera_.scaled(kMaxDeviation_px);
    result.typical_px = typical_px;
    predicted[i] = result;
  }
  return predicted;
}

}  // namespace lintel
