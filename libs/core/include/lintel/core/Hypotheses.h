// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <utility>

namespace lintel {

// Two explanations of a measurement, each with its own mean and standard deviation, of which one is true.

/// The probability from which an explanation is taken as the true one.
constexpr double kSureShare = 0.8;

/// Density of a normal distribution of mean 0.
inline double normalDensity(double x, double sigma) {
  constexpr double kRootOfTwoPi = 2.5066282746310002;
  return std::exp(-0.5 * x * x / (sigma * sigma)) / (kRootOfTwoPi * sigma);
}

/// The likelier one of `a`, which has the probability `share_a`, and `b`, and how far it is off in both cases together,
/// root mean square.
inline std::pair<double, double> likelierAndSigma(double share_a, double a, double sigma_a, double b, double sigma_b) {
  if (share_a < 0.5) return likelierAndSigma(1 - share_a, b, sigma_b, a, sigma_a);
  return {a, std::sqrt(share_a * sigma_a * sigma_a + (1 - share_a) * (sigma_b * sigma_b + (a - b) * (a - b)))};
}

}  // namespace lintel
