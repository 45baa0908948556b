// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lintel {

// Quantiles of a sample of n values. All but median() give one of the values, by its rank r (0 the smallest). `values`
// must not be empty and are reordered; `q` is from 0 to 1.

/// The value of a rank, r < n.
template <class T>
T valueOfRank(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// r = floor(q n), at most n - 1: the share q of the values lies below it.
template <class T>
T upperQuantile(std::vector<T>& values, double q) {
  const auto rank = static_cast<std::size_t>(q * static_cast<double>(values.size()));
  return valueOfRank(values, std::min(values.size() - 1, rank));
}

/// r = floor(q (n - 1)).
template <class T>
T lowerQuantile(std::vector<T>& values, double q) {
  return valueOfRank(values, static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

/// r = q (n - 1), rounded to the nearest.
template <class T>
T nearestQuantile(std::vector<T>& values, double q) {
  return valueOfRank(values, static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1))));
}

/// r = floor(n / 2): the middle value, the upper one of two.
template <class T>
T upperMedian(std::vector<T>& values) {
  return valueOfRank(values, values.size() / 2);
}

/// The middle value, the mean of two.
inline double median(std::vector<double>& values) {
  const double upper = upperMedian(values);
  if (values.size() % 2 == 1) return upper;
  return 0.5 *
         (*std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2)) + upper);
}

}  // namespace lintel
