// SPDX-License-Identifier: BSD-3-Clause
#include "WhiteNoise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lintel {

namespace {

/// White density that the means of `n` samples show by their deviations from the line through their neighbours.
double densityOfMeans(const std::deque<ImuSample>& samples, Eigen::Vector3d ImuSample::*values, std::size_t n,
                      double period_s) {
  std::vector<Eigen::Vector3d> means;
  for (std::size_t i = 0; i + n <= samples.size(); i += n) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = i; k < i + n; ++k) sum += samples[k].*values;
    means.emplace_back(sum / static_cast<double>(n));
  }
  if (means.size() < 3) return std::numeric_limits<double>::infinity();
  double squares = 0;
  for (std::size_t i = 2; i < means.size(); ++i)
    squares += (means[i - 1] - 0.5 * (means[i - 2] + means[i])).squaredNorm();
  constexpr double kSquares = 3 * 1.5;  // three axes; variances 1 + 1/4 + 1/4
  return std::sqrt(squares / (kSquares * static_cast<double>(means.size() - 2)) * static_cast<double>(n) * period_s);
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
