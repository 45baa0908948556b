// SPDX-License-Identifier: BSD-3-Clause
#include "window/NoiseScale.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr double kMemory = 50;       // windows: five seconds
constexpr double kFirstWeight = 10;  // of the configured noise, in windows
constexpr double kManyTracks = 20;   // a median of so many counts as a window
constexpr double kLeastScale = 0.2;  // no tracker is better: 0.03 px
constexpr double kMostScale = 20;
constexpr std::size_t kLeastTracks = 5;  // fewer have no median to speak of

/// The median of freedom / chi-square with so many degrees of freedom [Wilson1931].
double medianVariance(double freedom) { return std::pow(1 - 2 / (9 * freedom), -3); }

}  // namespace

NoiseScale::NoiseScale(double freedom) : median_(medianVariance(freedom)), weight_(kFirstWeight) {}

void NoiseScale::add(std::vector<double>& mean_squares) {
  if (mean_squares.size() < kLeastTracks) return;
  const auto middle = mean_squares.begin() + static_cast<std::ptrdiff_t>(mean_squares.size() / 2);
  std::nth_element(mean_squares.begin(), middle, mean_squares.end());
  const double seen = std::log(std::clamp(scale_ * std::sqrt(*middle / median_), kLeastScale, kMostScale));
  const double weight = std::min(1.0, static_cast<double>(mean_squares.size()) / kManyTracks);
  const double kept = 1 - weight / kMemory;
  log_sum_ = kept * log_sum_ + weight * seen;
  weight_ = kept * weight_ + weight;
  scale_ = std::exp(log_sum_ / weight_);
}

}  // namespace lintel
