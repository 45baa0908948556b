// SPDX-License-Identifier: BSD-3-Clause
#include "LineFlow.h"

#include <algorithm>
#include <cmath>
#include <opencv2/video/tracking.hpp>

#include "Prediction.h"
#include "RobustLine.h"

namespace lintel {
namespace {

constexpr double kMinEigenvalue = 1e-6;  ///< a patch on a plain edge has nearly none along it, and is welcome
constexpr double kSpacing_px = 15;       ///< between samples, when the line is neither short nor long
constexpr double kFitTolerance_px = 1.5;
constexpr double kNear_px = 120;
constexpr double kMaxSurprise_px = 40;  ///< flow further than this from the guess is a mistake

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

cv::Point2f residualNear(const cv::Point2f& px, const std::vector<PointFlow>& points) {
  cv::Point2f sum(0, 0);
  float weights = 0;
  for (const PointFlow& point : points) {
    const cv::Point2f away = point.px - point.residual - px;  // compared where both are predicted to be
    const float squared = away.dot(away);
    if (squared > kNear_px * kNear_px) continue;
    const float weight = 1.0f / (squared + 100.0f);
    sum += weight * point.residual;
    weights += weight;
  }
  return weights > 0 ? sum * (1.0f / weights) : sum;
}

LineFlow::Samples LineFlow::sample(const std::vector<ImageLine>& lines, const GyroPrediction& gyro,
                                   const std::vector<PointFlow>& points) const {
  Samples samples;
  for (const ImageLine& line : lines) {
    samples.first.push_back(samples.from.size());
    const int count =
        std::clamp(static_cast<int>(line.length() / kSpacing_px), params_.min_samples, params_.max_samples);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d u = line.at((i + 0.5) / count);
      const Eigen::Vector2d px = camera_.toImage(u);
      const cv::Point2f turned = turnedPixel(camera_.camera(), gyro.R_c1_c0(), u / camera_.focal());
      samples.from.emplace_back(static_cast<float>(px.x()), static_cast<float>(px.y()));
      samples.residual.push_back(residualNear(turned, points));
      samples.guess.push_back(turned + samples.residual.back());
    }
  }
  samples.first.push_back(samples.from.size());
  return samples;
}

std::vector<std::optional<PredictedLine>> LineFlow::predict(const std::vector<ImageLine>& lines,
                                                            const ImagePyramid& pyramid, const GyroPrediction& gyro,
                                                            const std::vector<PointFlow>& points) const {
  std::vector<std::optional<PredictedLine>> predicted(lines.size());
  if (lines.empty()) return predicted;
  const Samples samples = sample(lines, gyro, points);
  std::vector<cv::Point2f> to = samples.guess;
  std::vector<unsigned char> found;
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, params_.max_iterations, 0.03);
  cv::calcOpticalFlowPyrLK(pyramid.previous(), pyramid.current(), samples.from, to, found, cv::noArray(),
                           cv::Size(params_.window_px, params_.window_px),
                           std::min(params_.flow_levels, pyramid.levels()) - 1, criteria, cv::OPTFLOW_USE_INITIAL_FLOW,
                           kMinEigenvalue);

  for (std::size_t l = 0; l < lines.size(); ++l) {
    // Ends may lie outside the image, where the lens model folds back: they stay in undistorted pixels.
    const auto turnedEnd = [&](const Eigen::Vector2d& u) -> Eigen::Vector2d {
      const Eigen::Vector3d ray = gyro.R_c1_c0() * (u / camera_.focal()).homogeneous();
      return camera_.focal() * ray.head<2>() / std::max(ray.z(), 0.1);
    };
    const auto guessEnd = [&](const Eigen::Vector2d& u, std::size_t nearest) -> Eigen::Vector2d {
      return turnedEnd(u) + toEigen(samples.residual[nearest]);
    };
    const ImageLine guess{guessEnd(lines[l].start, samples.first[l]), guessEnd(lines[l].end, samples.first[l + 1] - 1)};
    std::vector<Eigen::Vector2d> guessed_u, found_u;
    for (std::size_t i = samples.first[l]; i < samples.first[l + 1]; ++i) {
      const Eigen::Vector2d px = toEigen(to[i]);
      if (!found[i] || !camera_.camera().contains(px, 1) || cv::norm(to[i] - samples.guess[i]) > kMaxSurprise_px)
        continue;
      guessed_u.push_back(camera_.fromImage(toEigen(samples.guess[i])));
      found_u.push_back(camera_.fromImage(px));
    }
    PredictedLine result{guess, false};
    if (const auto fit = fitRobustLine(found_u, kFitTolerance_px)) {
      result.line = carryEnds(guess, *fit, guessed_u, found_u);
      result.by_flow = true;
    }
    if (!result.line.start.allFinite() || !result.line.end.allFinite()) continue;
    if (const auto clipped = camera_.clip(result.line, params_.border_px))
      predicted[l] = PredictedLine{*clipped, result.by_flow};
  }
  return predicted;
}

}  // namespace lintel
