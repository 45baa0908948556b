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
  return {n, std::sqrt(sum_squares / count), sum / count, 0.5 * (errors[(n - 1) / 2] + errors[n / 2]), errors.back()};
}

}  // namespace lintel
