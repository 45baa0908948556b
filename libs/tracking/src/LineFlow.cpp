// SPDX-License-Identifier: BSD-3-Clause
#include "LineFlow.h"

#include <algorithm>
#include <cmath>

#include "PatchFlow.h"
#include "Prediction.h"
#include "RobustLine.h"

namespace lintel {
namespace {

constexpr double kMinTexture = 1e-3;  ///< a patch on a plain edge has nearly none along it, and is welcome
constexpr double kSettled_px = 0.03;  ///< of optical flow
constexpr double kSpacing_px = 15;    ///< between samples, when the line is neither short nor long
constexpr double kFitTolerance_px = 1.5;
constexpr float kNear_px = 20;          ///< points nearer than this weigh alike
constexpr double kMaxSurprise_px = 40;  ///< flow further than this from the guess is a mistake
constexpr double kSureDepth_px = 1.5;   ///< a line whose depth says less is expected to move as before
constexpr double kCalm_px = 2;          ///< a line may always be this far from where it is expected
constexpr double kTimesTypical = 4;     ///< and this many times as far as the other lines of the frame are

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d toEigen(const cv::Point2f& p) { return {p.x, p.y}; }

/// Lays the guessed ends on the fitted line, moved along it by what the samples moved. A patch on a plain edge slides
/// along it, so that the median of all says more than the ends' own patches.
ImageLine carryEnds(const ImageLine& guess, const RobustLine& fit, const std::vector<Eigen::Vector2d>& guessed,
                    const std::vector<Eigen::Vector2d>& found) {
  Eigen::Vector2d d = fit.line.direction();
  if (d.dot(guess.end - guess.start) < 0) d = -d;
  std::vector<double> along;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (fit.inlier[i]) along.push_back(d.dot(found[i] - guessed[i]));
  const double shift = median(along);
  const auto lay = [&](const Eigen::Vector2d& end) -> Eigen::Vector2d {
    return fit.line.start + d * (d.dot(end - fit.line.start) + shift);
  };
  return {lay(guess.start), lay(guess.end)};
}

}  // namespace

NearbyMotion motionNear(const cv::Point2f& px, const std::vector<PointFlow>& points) {
  NearbyMotion sum;
  float residuals = 0, changes = 0;
  for (const PointFlow& point : points) {
    const cv::Point2f away = point.px - point.residual - px;  // compared where both are predicted to be
    const float weight = 1.0f / ((away.dot(away) + kNear_px * kNear_px) * (away.dot(away) + kNear_px * kNear_px));
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

ImageLine LineFlow::turnedLine(const ImageLine& line, const GyroPrediction& gyro) const {
  // Ends may lie outside the image, where the lens model folds back: they stay in undistorted pixels.
  const auto turned = [&](const Eigen::Vector2d& u) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = gyro.R_c1_c0() * (u / camera_.focal()).homogeneous();
    return camera_.focal() * ray.head<2>() / std::max(ray.z(), 0.1);
  };
  return {turned(line.start), turned(line.end)};
}

LineFlow::Samples LineFlow::sample(const std::vector<CarriedLine>& lines, const GyroPrediction& gyro,
                                   const PointMotion& points) const {
  Samples samples;
  for (const CarriedLine& carried : lines) {
    samples.first.push_back(samples.from.size());
    const ImageLine turned = turnedLine(carried.line, gyro);
    const auto turnedAt = [&](double share) {
      return turnedPixel(camera_.camera(), gyro.R_c1_c0(), carried.line.at(share) / camera_.focal());
    };
    const NearbyMotion near_start = motionNear(turnedAt(0.1), points.flow),
                       near_end = motionNear(turnedAt(0.9), points.flow);
    Eigen::Vector2d at_start = toEigen(near_start.residual), at_end = toEigen(near_end.residual);
    if (carried.motion) {  // across the line its own motion is known better than that of the points nearby
      const Eigen::Vector2d n = turned.normal();
      at_start += n * (carried.motion->x() + n.dot(toEigen(near_start.change) - at_start));
      at_end += n * (carried.motion->y() + n.dot(toEigen(near_end.change) - at_end));
    }
    std::optional<CarriedDepth> depth;
    if (carried.depth && carried.depth->epoch == points.step.epoch()) {
      depth = carry(*carried.depth, carried.line, turned, gyro.R_c1_c0(), points.step.t_c1(), camera_.focal());
      if (depth->sigma_px.maxCoeff() < kSureDepth_px) {
        at_start = depth->line.start - turned.start;
        at_end = depth->line.end - turned.end;
      }
    }
    samples.depths.push_back(depth);
    samples.turned.push_back(turned);
    samples.guessed.push_back({turned.start + at_start, turned.end + at_end});
    const int count =
        std::clamp(static_cast<int>(carried.line.length() / kSpacing_px), params_.min_samples, params_.max_samples);
    for (int i = 0; i < count; ++i) {
      const double share = (i + 0.5) / count;
      const Eigen::Vector2d from = camera_.toImage(carried.line.at(share));
      const Eigen::Vector2d motion = (1 - share) * at_start + share * at_end;
      samples.from.emplace_back(static_cast<float>(from.x()), static_cast<float>(from.y()));
      samples.guess.push_back(turnedAt(share) +
                              cv::Point2f(static_cast<float>(motion.x()), static_cast<float>(motion.y())));
    }
  }
  samples.first.push_back(samples.from.size());
  return samples;
}

PredictedLine LineFlow::fit(const Samples& samples, std::size_t index, double jump_px,
                            const std::vector<cv::Point2f>& to, const std::vector<unsigned char>& found) const {
  std::vector<Eigen::Vector2d> guessed_u, found_u;
  for (std::size_t i = samples.first[index]; i < samples.first[index + 1]; ++i) {
    const Eigen::Vector2d px = toEigen(to[i]);
    if (!found[i] || !camera_.camera().contains(px, 1) || cv::norm(to[i] - samples.guess[i]) > kMaxSurprise_px)
      continue;
    guessed_u.push_back(camera_.fromImage(toEigen(samples.guess[i])));
    found_u.push_back(camera_.fromImage(px));
  }
  const ImageLine& guess = samples.guessed[index];
  PredictedLine result{guess, samples.turned[index], guess, jump_px, 0, samples.depths[index], false};
  const auto robust = fitRobustLine(found_u, kFitTolerance_px);
  if (!robust) return result;
  const ImageLine carried = carryEnds(guess, *robust, guessed_u, found_u);
  // Among parallel stripes flow may lock onto a neighbour. A line with a history does not jump.
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
  const PatchFlowParams flow{reach.window_px, reach.levels, params_.max_iterations, kSettled_px, kMinTexture};
  const std::vector<unsigned char> found = followPatches(pyramid.previous(), pyramid.current(), samples.from, flow, to);
  std::vector<PredictedLine> followed;
  for (std::size_t i = 0; i < lines.size(); ++i)
    followed.push_back(fit(samples, i, lines[i].motion ? reach.jump_px : kMaxSurprise_px, to, found));
  return followed;
}

double LineFlow::typicalSurprise(const std::vector<CarriedLine>& lines, const std::vector<PredictedLine>& followed) {
  std::vector<double> surprises;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].motion)
      surprises.push_back(followed[i].by_flow
                              ? normalMotion(followed[i].expected, followed[i].line).cwiseAbs().maxCoeff()
                              : followed[i].limit_px);
  return surprises.empty() ? 0.0 : median(std::move(surprises));
}

std::vector<std::optional<PredictedLine>> LineFlow::predict(const std::vector<CarriedLine>& lines,
                                                            const ImagePyramid& pyramid, const GyroPrediction& gyro,
                                                            const PointMotion& points) const {
  std::vector<std::optional<PredictedLine>> predicted(lines.size());
  if (lines.empty()) return predicted;
  std::vector<PredictedLine> followed =
      follow(lines, pyramid, gyro, points, {params_.window_px, params_.flow_levels, params_.max_jump_px});

  // A camera that is jerked surprises all lines, another edge just one: what the lines of this frame have in common
  // says how far each may be off.
  const double typical_px = typicalSurprise(lines, followed);
  const double limit_px = std::min(params_.max_jump_px, kCalm_px + kTimesTypical * typical_px);
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
    result.limit_px = lines[i].motion ? limit_px : kMaxSurprise_px;
    result.typical_px = typical_px;
    predicted[i] = result;
  }
  return predicted;
}

}  // namespace lintel
