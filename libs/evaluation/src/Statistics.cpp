// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/Statistics.h"

#include <algorithm>
#include <cmath>

namespace lintel {

ErrorStatistics statisticsOf(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double sum = 0, sum_squares = 0;
  for (const double e : errors) {
    sum += e;
    sum_squares += e * e;
  }
  const std::size_t n = errors.size();
  const auto count = static_cast<double>(n);
  const auto quantile = [&](double q) { return errors[std::min(n - 1, static_cast<std::size_t>(q * count))]; };
  const double median = 0.5 * (errors[(n - 1) / 2] + errors[n / 2]);
  return {n,
          std::sqrt(sum_squares / count),
          sum / count,
          median,
          errors.back(),
          quantile(0.05),
          quantile(0.25),
          quantile(0.75),
          quantile(0.95)};
}

}  // namespace lintel
