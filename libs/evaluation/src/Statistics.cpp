// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/Statistics.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/Quantiles.h"

namespace lintel {

ErrorStatistics statisticsOf(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());  // small values first: their sum loses least
  double sum = 0, sum_squares = 0;
  for (const double e : errors) {
    sum += e;
    sum_squares += e * e;
  }
  const std::size_t n = errors.size();
  const auto count = static_cast<double>(n);
  const double largest = errors.back();
  return {n,
          std::sqrt(sum_squares / count),
          sum / count,
          median(errors),
          largest,
          upperQuantile(errors, 0.05),
          upperQuantile(errors, 0.25),
          upperQuantile(errors, 0.75),
          upperQuantile(errors, 0.95)};
}

}  // namespace lintel
