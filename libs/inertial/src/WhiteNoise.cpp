// SPDX-License-Identifier: BSD-3-Clause
#include "WhiteNoise.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace lintel {

namespace {

// Fourth differences: where white noise keeps its size, a walker's steps (2 Hz, means of four samples at 200 Hz) keep
// 0.0005 of theirs, and 0.026 in second differences. kSquares is their variance for samples of unit variance.
constexpr double kDifference[] = {1, -4, 6, -4, 1};
constexpr double kSquares = 70;

/// White density that the means of `n` samples show by their differences.
double densityOfMeans(const std::deque<ImuSample>& samples, Eigen::Vector3d ImuSample::*values, std::size_t n,
                      double period_s) {
  std::vector<Eigen::Vector3d> means;
  for (std::size_t i = 0; i + n <= samples.size(); i += n) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = i; k < i + n; ++k) sum += samples[k].*values;
    means.emplace_back(sum / static_cast<double>(n));
  }
  constexpr std::size_t kTerms = std::size(kDifference);
  if (means.size() < kTerms) return std::numeric_limits<double>::infinity();
  const std::size_t differences = means.size() - kTerms + 1;
  double squares = 0;
  for (std::size_t i = 0; i < differences; ++i) {
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < kTerms; ++k) difference += kDifference[k] * means[i + k];
    squares += difference.squaredNorm();
  }
  const double axes = 3 * static_cast<double>(differences);
  return std::sqrt(squares / (kSquares * axes) * static_cast<double>(n) * period_s);
}

}  // namespace

std::optional<double> whiteDensity(const std::deque<ImuSample>& samples, Eigen::Vector3d ImuSample::*values,
                                   double of_samples, double period_s) {
  const double of_two = densityOfMeans(samples, values, 2, period_s),
               of_four = densityOfMeans(samples, values, 4, period_s);
  const auto [low, high] = std::minmax({of_samples, of_two, of_four});
  if (!(high < kWhiteSpread * low)) return std::nullopt;
  return (of_samples + of_two + of_four) / 3;
}

}  // namespace lintel
