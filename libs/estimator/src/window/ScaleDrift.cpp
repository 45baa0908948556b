// SPDX-License-Identifier: BSD-3-Clause
#include "window/ScaleDrift.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

/// Root of the summed squares of the distances from the mean; without the newest, which has just been predicted.
double extentOf(const std::vector<Eigen::Vector3d>& positions) {
  const std::size_t count = positions.empty() ? 0 : positions.size() - 1;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) mean += positions[i] / static_cast<double>(count);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += (positions[i] - mean).squaredNorm();
  return std::sqrt(sum);
}

std::vector<Eigen::Vector3d> positionsOf(const SlidingWindow& window) {
  std::vector<Eigen::Vector3d> positions;
  for (const WindowFrame& frame : window.frames) positions.push_back(frame.T_w_b().p);
  return positions;
}

}  // namespace

void ScaleDrift::start(double sigma) { since_start_ = lately_ = {sigma}; }

void ScaleDrift::beforeSolve(const SlidingWindow& window) { before_ = positionsOf(window); }

void ScaleDrift::afterSolve(const SlidingWindow& window) {
  const double before = extentOf(before_), after = extentOf(positionsOf(window));
  for (Stretch* stretch : {&since_start_, &lately_}) {
    ++stretch->solves;
    if (before > 0 && after > 0) stretch->log_change += std::log(after / before);
  }
}

bool ScaleDrift::leftStart() const {
  constexpr double kMostSigmas = 6;  // fair starts reach four, with images whose errors are alike for all tracks 5.6
  constexpr double kLeast = 0.05;    // less does not pay a new start
  // More pays one even if it may be chance: the poses since the start are wrong by as much.
  constexpr double kMost = 0.1, kLeastSigmas = 2;
  const double sigma = since_start_.sigma, most = std::max(kMost, kLeastSigmas * sigma);
  return std::abs(since_start_.log_change) > std::clamp(kMostSigmas * sigma, kLeast, most);
}

double ScaleDrift::takeUnexplainedChange(double sigma) {
  constexpr double kMostSigmas = 2.5;  // by chance once in eighty
  constexpr int kSolves = 30;          // twice the time that a window reaches
  const double change = std::abs(lately_.log_change);
  if (change > kMostSigmas * std::max(sigma, lately_.sigma)) {
    lately_ = {std::hypot(sigma, change)};
    return change;
  }
  if (lately_.solves > kSolves) lately_ = {sigma};
  return 0;
}

}  // namespace lintel
